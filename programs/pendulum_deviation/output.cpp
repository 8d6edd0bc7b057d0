#include <fmt/core.h>
#include <fmt/ostream.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <string>

#include <dynamics/file/atomic_file.hpp>
#include <dynamics/file/csv.hpp>
#include <dynamics/file/printable.hpp>
#include <dynamics/json/deviation.hpp>

#include "request.hpp"

using kreisel::Estimated;

namespace {

const double arcsec = 180 * 3600 / std::acos(-1.0);

std::string optional_number(const std::optional<Estimated<double>>& number) {
  return number ? fmt::format("{:+.12e}", number->value) : "none";
}

void print_terms(const char* title, const std::vector<kreisel::PendulumTerm<double>>& terms) {
  fmt::print("{}\n", title);
  for (const auto& term : terms) {
    const std::string size = term.size == 0 ? "" : fmt::format("{:.1e}", term.size);
    fmt::print("  {:30} {:>8}  {}\n", term.name, size, term.reason);
  }
}

void print_one(const Request& request, const Row& row) {
  const auto [latitude, azimuth, height, rate] = row.site.place.cast<double>();
  const auto body = request.body.cast<double>();
  const auto& answer = row.answer;
  fmt::print("site      latitude {:g} deg, height {:g} m, pendulum axis at azimuth {:g} deg\n",
             latitude, height, azimuth);
  fmt::print("guide     gravity {:.12g} m/s^2 ({}), rotation {:.9g} rad/s\n", row.gravity,
             request.gravity ? "given" : "WGS84 normal gravity", rate);
  fmt::print(
      "pendulum  m = {:g} kg, a = {:g} m, Theta = ({:g}, {:g}, {:g}), Phi = ({:g}, {:g}, {:g}) kg "
      "m^2\n",
      body.mass, body.arm, body.theta_a, body.theta_b, body.theta_c, body.phi_a, body.phi_b,
      body.phi_c);

  const auto equilibrium = [](const char* name, const std::optional<Estimated<double>>& phi) {
    if (!phi) {
      fmt::print("  {:22} none\n", name);
    } else {
      fmt::print("  {:22} {:+.12e} rad = {:+.12e} arcsec   error {:.1e} rad\n", name, phi->value,
                 phi->value * arcsec, phi->error);
    }
  };
  fmt::print("\nequilibrium, from the vertical towards azimuth {:g} deg\n",
             std::fmod(azimuth + 270, 360));
  equilibrium("formula (24)", answer.equilibrium.formula_24);
  equilibrium("linear", answer.equilibrium.linear);
  equilibrium("exact", answer.equilibrium.exact);
  const char* const gradient =
      request.gravity_gradient ? "gradient, taken in" : "gradient, left out";
  fmt::print("  {:22} {:+.3e} rad, of gravity over the body, first order\n", gradient,
             row.gradient.equilibrium);
  fmt::print("  all                   ");
  for (const auto& e : answer.equilibria) {
    fmt::print(" {:+.9g} ({}{})", e.angle, e.degenerate ? "degenerate, " : "",
               e.stable ? "stable" : "unstable");
  }
  fmt::print(" rad\n");

  const auto period = [](const std::string& name, const std::optional<Estimated<double>>& T,
                         const std::optional<Estimated<double>>& change) {
    if (!T) {
      fmt::print("  {:22} none\n", name);
      return;
    }
    const std::string relative = change ? fmt::format("{:+.12e}", change->value) : std::string();
    fmt::print("  {:22} {:.15g} s   {:>20}   error {:.1e} s\n", name, T->value, relative, T->error);
  };
  const auto& p = answer.period;
  // The error of the corrected period T_00 (1 + z) is what (25) leaves out.
  const Estimated<double> corrected{p.simple.value * (1 + p.relative_change_formula_25.value),
                                    p.simple.value * p.relative_change_formula_25.error};
  fmt::print("\nperiod                                      change against simple\n");
  period("simple", p.simple, {});
  period("formula (25)", corrected, p.relative_change_formula_25);
  period("linear", p.linear, {});
  period("exact, small", p.exact_small, p.relative_change_exact);
  period(fmt::format("exact, {:g} rad", static_cast<double>(request.amplitude)), p.at_amplitude,
         {});
  fmt::print("  {:22} {:>21} {:+.3e}, first order\n", gradient, "", row.gradient.period);
  fmt::print(
      "(the error of a formula is its difference from the exact value, that of an exact value its "
      "rounding)\n\n");

  print_terms("terms kept, with their greatest moment in units of m a g'", answer.terms_kept);
  print_terms("terms dropped", answer.terms_dropped);
  fmt::print("\nrun time {:.3g} ms\n", 1e3 * row.run_time_s);
}

/// The object of one site, with its name if it has one.
nlohmann::ordered_json to_json(const Request& request, const Row& row) {
  nlohmann::ordered_json result = nlohmann::ordered_json::object();
  if (!row.site.name.empty()) result["name"] = row.site.name;
  result.update(kreisel::json_of(request, row.site.place, row, row.run_time_s));
  return result;
}

}  // namespace

void print_table(const Request& request, const std::vector<Row>& rows, double run_time_s) {
  if (request.mode == Request::Mode::single) {
    if (!rows.empty()) print_one(request, rows.front());
    return;
  }
  const int names = request.mode == Request::Mode::sites ? 27 : 0;
  fmt::print("{:{}}{:>9} {:>8} {:>7} {:>12} {:>20} {:>20} {:>18} {:>20} {:>8}\n", "", names,
             "latitude", "height", "azimuth", "gravity", "deviation [rad]", "[arcsec]",
             "period [s]", "relative change", "error");
  for (const Row& row : rows) {
    const auto [latitude, azimuth, height, rate] = row.site.place.cast<double>();
    const auto& equilibrium = row.answer.equilibrium.exact;
    const auto& period = row.answer.period;
    fmt::print(
        "{:{}}{:>9.4f} {:>8.1f} {:>7.5g} {:>12.9f} {:>+20.12e} {:>+20.12e} {:>18} {:>20} "
        "{:>8.1e}\n",
        kreisel::printable(row.site.name), names, latitude, height, azimuth, row.gravity,
        equilibrium.value, equilibrium.value * arcsec,
        period.exact_small ? fmt::format("{:.15f}", period.exact_small->value) : "none",
        optional_number(period.relative_change_exact), equilibrium.error);
  }
  fmt::print("{} sites in {:.3g} ms; error in rad, of the deviation\n", rows.size(),
             1e3 * run_time_s);
}

void print_json(const Request& request, const std::vector<Row>& rows, double run_time_s) {
  nlohmann::ordered_json result;
  if (request.mode == Request::Mode::single) {
    if (!rows.empty()) result = to_json(request, rows.front());
  } else {
    if (request.mode == Request::Mode::sweep) result["swept"] = request.swept;
    result["sites"] = nlohmann::ordered_json::array();
    for (const Row& row : rows) result["sites"].push_back(to_json(request, row));
    result["run_time_s"] = run_time_s;
  }
  // A name may be invalid UTF-8.
  using Names = nlohmann::ordered_json::error_handler_t;
  fmt::print("{}\n", result.dump(2, ' ', false, Names::replace));
}

void write_csv(kreisel::AtomicFile& file, const std::vector<Row>& rows) {
  std::ostream& out = file.stream();
  const auto value = [](const std::optional<Estimated<double>>& number) {
    return number ? fmt::format("{:.16e}", number->value) : std::string();
  };
  const auto error = [](const std::optional<Estimated<double>>& number) {
    return number ? fmt::format("{:.1e}", number->error) : std::string();
  };
  out << "name,latitude,height,azimuth,rotation_rate,gravity,equilibrium_formula_24,equilibrium_"
         "linear,"
         "equilibrium_exact,equilibrium_error,period_simple,relative_change_formula_25,period_"
         "linear,"
         "period_exact_small,period_error,relative_change_exact,period_at_amplitude\n";
  for (const Row& row : rows) {
    const auto [latitude, azimuth, height, rate] = row.site.place.cast<double>();
    const auto& a = row.answer;
    fmt::print(out, "{},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{},{},{},{},{},{},{},{},{},{},{}\n",
               kreisel::csv_field(row.site.name), latitude, height, azimuth, rate, row.gravity,
               value(a.equilibrium.formula_24), value(a.equilibrium.linear),
               value(a.equilibrium.exact), error(a.equilibrium.exact), value(a.period.simple),
               value(a.period.relative_change_formula_25), value(a.period.linear),
               value(a.period.exact_small), error(a.period.exact_small),
               value(a.period.relative_change_exact), value(a.period.at_amplitude));
  }
  file.commit();
}
