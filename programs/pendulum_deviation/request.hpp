#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <dynamics/file/atomic_file.hpp>
#include <dynamics/pendulum/site_deviation.hpp>

#include "sites.hpp"

/// The checked command line.
struct Request : kreisel::SitePendulum {
  enum class Mode { single, sites, sweep };
  Mode mode = Mode::single;
  std::string swept;  // "latitude", "azimuth", "height" or "rotation-rate"
  std::vector<Site> sites;
  std::filesystem::path list;  // of the sites, if they come from a file

  bool json = false;
  std::optional<std::filesystem::path> csv;
  std::optional<std::filesystem::path> plot;
};

/// The answer for one site.
struct Row : kreisel::SiteDeviation {
  Site site;
  double run_time_s;
};

/// Reads the command line. None if it printed the help instead.
///
/// Throws : InvalidInput
[[nodiscard]] std::optional<Request> read_request(int argc, char** argv);

/// Throws : InvalidInput, ComputationFailed, with the site's name in front
[[nodiscard]] Row compute(const Request& request, const Site& site);

/// Prints a full answer for one site, or one line per site.
void print_table(const Request& request, const std::vector<Row>& rows, double run_time_s);

void print_json(const Request& request, const std::vector<Row>& rows, double run_time_s);

void write_csv(kreisel::AtomicFile& file, const std::vector<Row>& rows);

/// Draws deviation and change of period over the swept quantity or the latitude, by gnuplot.
///
/// Throws : ComputationFailed if gnuplot is missing or fails
void draw(const Request& request, const std::vector<Row>& rows);
