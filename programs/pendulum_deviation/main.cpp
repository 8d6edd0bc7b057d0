// The pendulum deviation calculator: the equilibrium of a physical pendulum on the rotating earth,
// the change of its period, and the error of each number.

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>
#include <sys/ioctl.h>
#include <unistd.h>

#include <dynamics/file/atomic_file.hpp>
#include <dynamics/file/printable.hpp>
#include <dynamics/guide/normal_gravity.hpp>

#include "../shared/exit_status.hpp"
#include "../shared/gnuplot.hpp"
#include "../shared/outputs.hpp"
#include "../shared/progress.hpp"
#include "request.hpp"

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// The numbers of an answer that are exact but for rounding, without periods that do not exist.
std::vector<kreisel::Estimated<double>> exact_numbers(
    const kreisel::PendulumAnswer<double>& answer) {
  std::vector<kreisel::Estimated<double>> numbers{answer.equilibrium.exact};
  const auto& period = answer.period;
  for (const auto& number :
       {period.exact_small, period.relative_change_exact, period.at_amplitude}) {
    if (number) numbers.push_back(*number);
  }
  return numbers;
}

/// Throws : kreisel::ComputationFailed if a number of the answer is not finite
void require_finite(const kreisel::PendulumAnswer<double>& answer) {
  for (const auto& number : exact_numbers(answer)) {
    if (!std::isfinite(number.value)) {
      throw kreisel::ComputationFailed("the deviation or the period is not finite");
    }
  }
}

int run(const Request& request) {
  const Clock::time_point start = Clock::now();
  const std::vector<std::filesystem::path> inputs{request.list};
  if (request.csv) outputs::refuse_input("--csv", *request.csv, inputs);
  if (request.plot) outputs::refuse_input("--plot", *request.plot, inputs);
  if (request.plot) gnuplot::require_installed();
  std::optional<kreisel::AtomicFile> table;
  if (request.csv) table.emplace(*request.csv);
  std::vector<Row> rows;
  rows.reserve(request.sites.size());
  {
    Progress progress;
    for (const Site& site : request.sites) {
      if (signals::caught() != 0) break;
      rows.push_back(compute(request, site));
      const std::size_t all = request.sites.size();
      progress.report(static_cast<double>(rows.size()) / static_cast<double>(all),
                      [&] { return fmt::format("{} of {}", rows.size(), all); });
    }
  }
  const double run_time_s = seconds_since(start);
  if (table) {
    write_csv(*table, rows);
    outputs::leave_standard_output_to(*request.csv);
  }
  if (request.json) {
    print_json(request, rows, run_time_s);
  } else {
    print_table(request, rows, run_time_s);
  }
  if (std::fflush(stdout) != 0) throw kreisel::ComputationFailed("standard output: not written");
  if (request.plot && !rows.empty() && signals::caught() == 0) draw(request, rows);
  if (rows.size() < request.sites.size()) {
    fmt::print(stderr,
               "pendulum_deviation: interrupted after {} of {} sites; what was computed is kept\n",
               rows.size(), request.sites.size());
    return exit_status::of_signal();
  }
  if (signals::caught() != 0) return exit_status::of_signal();
  const auto unknown = std::count_if(rows.begin(), rows.end(), [](const Row& row) {
    const auto numbers = exact_numbers(row.answer);
    return std::any_of(numbers.begin(), numbers.end(),
                       [](const auto& number) { return !std::isfinite(number.error); });
  });
  if (unknown == 0) return exit_status::complete;
  fmt::print(stderr, "pendulum_deviation: the error of {} of {} sites has no bound\n", unknown,
             rows.size());
  return exit_status::tolerance_missed;
}

/// Adds the rounding of normal gravity, which is computed in double: u and g' are right to 4
/// epsilon.
void add_rounding_of_normal_gravity(const Request& request, const Site& site,
                                    kreisel::PendulumAnswer<double>& answer) {
  const auto& body = request.body;
  const Real spread = std::abs(body.theta_b - body.theta_a) + std::abs(body.phi_a) +
                      std::abs(body.phi_b) + 2 * std::abs(body.phi_c);
  const Real rate = site.place.rotation_rate;
  constexpr double relative = 4 * std::numeric_limits<double>::epsilon();
  const double centrifugal =
      relative * static_cast<double>(spread * rate * rate / Real(answer.coefficients.weight));
  const double stiffness =
      answer.coefficients.stiffness(answer.equilibrium.exact.value) / answer.coefficients.weight;
  answer.equilibrium.exact.error += centrifugal / stiffness;
  if (auto& change = answer.period.relative_change_exact) change->error += centrifugal;
  for (auto* const period : {&answer.period.exact_small, &answer.period.at_amplitude}) {
    if (*period) (*period)->error += relative * (*period)->value;
  }
}

kreisel::EarthGuide<Real> earth_guide(const Request& request, kreisel::EarthSite<Real> place) {
  if (!request.gravity) return kreisel::normal_gravity(place.cast<double>()).guide.cast<Real>();
  kreisel::EarthGuide<Real> earth = kreisel::earth_guide(place, *request.gravity);
  // A gravimeter measures gravity alone. Its gradient is the ellipsoid's, at any rotation rate.
  place.rotation_rate = kreisel::EarthSite<Real>{}.rotation_rate;
  earth.gravity_gradient =
      kreisel::normal_gravity(place.cast<double>()).guide.gravity_gradient.cast<Real>();
  return earth;
}

GradientEffect effect_of_gradient(const kreisel::PendulumBody<Real>& body,
                                  const kreisel::EarthGuide<Real>& earth) {
  const auto parts =
      kreisel::parts(body, kreisel::pendulum_guide(earth, kreisel::GravityGradient::taken_in));
  const auto& [e, f, h, k] = parts.gravity_gradient;
  return {static_cast<double>(-(f + h) / parts.weight),
          static_cast<double>(-(e + 2 * k) / (2 * parts.weight))};
}

template <class E>
[[noreturn]] void rethrow_with(const std::string& name, const E& error) {
  throw E(name.empty() ? error.what() : kreisel::printable(name, 100) + ": " + error.what());
}

}  // namespace

Row compute(const Request& request, const Site& site) {
  const Clock::time_point start = Clock::now();
  try {
    const kreisel::EarthGuide<Real> earth = earth_guide(request, site.place);
    const auto gradient = request.gravity_gradient ? kreisel::GravityGradient::taken_in
                                                   : kreisel::GravityGradient::left_out;
    const auto guide = kreisel::pendulum_guide(earth, gradient);
    Row row{site, static_cast<double>(earth.effective_gravity.x()),
            kreisel::deviation(request.body, guide, request.amplitude),
            effect_of_gradient(request.body, earth), 0};
    if (!request.gravity) add_rounding_of_normal_gravity(request, site, row.answer);
    require_finite(row.answer);
    row.run_time_s = seconds_since(start);
    return row;
  } catch (const kreisel::InvalidInput& error) {
    rethrow_with(site.name, error);
  } catch (const kreisel::ComputationFailed& error) {
    rethrow_with(site.name, error);
  }
}

int main(int argc, char** argv) {
  signals::watch();
  return exit_status::of("pendulum_deviation", [&] {
    const std::optional<Request> request = read_request(argc, argv);
    return request ? run(*request) : exit_status::complete;
  });
}
