#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <dynamics/file/atomic_file.hpp>
#include <dynamics/pendulum/pendulum_deviation.hpp>

#include "sites.hpp"

/// What the command line asks for, checked.
struct Request {
  enum class Mode { single, sites, sweep };
  Mode mode = Mode::single;
  std::string swept;  // "latitude", "azimuth", "height" or "rotation-rate"
  std::vector<Site> sites;
  std::filesystem::path list;  // of the sites, where they are read from a file

  kreisel::PendulumBody<Real> body;
  std::optional<Real> gravity;  // none: normal gravity
  bool gravity_gradient = false;
  Real amplitude = Real(0.1L);

  bool json = false;
  std::optional<std::filesystem::path> csv;
  std::optional<std::filesystem::path> plot;
};

/// What the gradient of gravitation over the body does, in first order; taken in or not.
struct GradientEffect {
  double equilibrium;  // rad
  double period;       // relative change
};

/// One site's answer.
struct Row {
  Site site;
  double gravity;
  kreisel::PendulumAnswer<double> answer;
  GradientEffect gradient;
  double run_time_s;
};

/// Reads the command line. None when it asked for help, which is then printed.
///
/// Throws : InvalidInput
[[nodiscard]] std::optional<Request> read_request(int argc, char** argv);

/// Throws : InvalidInput, ComputationFailed, with the site's name in front
[[nodiscard]] Row compute(const Request& request, const Site& site);

/// A whole answer for a person, or a line per site.
void print_table(const Request& request, const std::vector<Row>& rows, double run_time_s);

void print_json(const Request& request, const std::vector<Row>& rows, double run_time_s);

void write_csv(kreisel::AtomicFile& file, const std::vector<Row>& rows);

/// Deviation and change of period over the swept quantity, or the sites' latitude, by gnuplot.
///
/// Throws : ComputationFailed when gnuplot is missing or fails
void draw(const Request& request, const std::vector<Row>& rows);
