#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <dynamics/file/atomic_file.hpp>
#include <dynamics/pendulum/pendulum_deviation.hpp>

#include "sites.hpp"

/// The checked command line.
struct Request {
  enum class Mode { single, sites, sweep };
  Mode mode = Mode::single;
  std::string swept;  // "latitude", "azimuth", "height" or "rotation-rate"
  std::vector<Site> sites;
  std::filesystem::path list;  // of the sites, if they come from a file

  kreisel::PendulumBody<Real> body;
  std::optional<Real> gravity;  // none: normal gravity
  bool gravity_gradient = false;
  Real amplitude = Real(0.1L);

  bool json = false;
  std::optional<std::filesystem::path> csv;
  std::optional<std::filesystem::path> plot;
};

/// The effect of the gravity gradient over the body, in first order, whether included or not.
struct GradientEffect {
  double equilibrium;  // rad
  double period;       // relative change
};

/// The answer for one site.
struct Row {
  Site site;
  double gravity;
  kreisel::PendulumAnswer<double> answer;
  GradientEffect gradient;
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
