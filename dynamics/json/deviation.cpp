#include "deviation.hpp"

#include <cmath>
#include <optional>
#include <vector>

namespace kreisel {

namespace {

nlohmann::json json_of(const std::optional<Estimated<double>>& number) {
  return number ? nlohmann::json(number->value) : nlohmann::json();
}

nlohmann::json json_error_of(const std::optional<Estimated<double>>& number) {
  return number && std::isfinite(number->error) ? nlohmann::json(number->error) : nlohmann::json();
}

nlohmann::json json_of(const std::vector<PendulumTerm<double>>& terms) {
  nlohmann::json list = nlohmann::json::array();
  for (const auto& t : terms)
    list.push_back({{"term", t.name}, {"reason", t.reason}, {"size", t.size}});
  return list;
}

}  // namespace

nlohmann::ordered_json json_of(const SitePendulum& request, const EarthSite<DoubleDouble>& site,
                               const SiteDeviation& found, double run_time) {
  const auto [latitude, azimuth, height, rate] = site.cast<double>();
  const auto b = request.body.cast<double>();
  const auto& a = found.answer;
  nlohmann::ordered_json result;
  result["input"] = {{"latitude", latitude},
                     {"azimuth", azimuth},
                     {"height", height},
                     {"rotation_rate", rate},
                     {"gravity", found.gravity},
                     {"gravity_model", request.gravity ? "number" : "normal"},
                     {"gravity_gradient", request.gravity_gradient},
                     {"mass", b.mass},
                     {"arm", b.arm},
                     {"theta_a", b.theta_a},
                     {"theta_b", b.theta_b},
                     {"theta_c", b.theta_c},
                     {"phi_a", b.phi_a},
                     {"phi_b", b.phi_b},
                     {"phi_c", b.phi_c},
                     {"amplitude", static_cast<double>(request.amplitude)}};
  result["equilibrium"] = {{"formula_24", json_of(a.equilibrium.formula_24)},
                           {"linear", json_of(a.equilibrium.linear)},
                           {"exact", json_of(a.equilibrium.exact)}};
  result["equilibria"] = nlohmann::ordered_json::array();
  for (const auto& e : a.equilibria) {
    result["equilibria"].push_back({{"angle", e.angle}, {"stable", e.stable}});
  }
  result["period"] = {{"simple", json_of(a.period.simple)},
                      {"relative_change_formula_25", json_of(a.period.relative_change_formula_25)},
                      {"linear", json_of(a.period.linear)},
                      {"exact_small", json_of(a.period.exact_small)},
                      {"relative_change_exact", json_of(a.period.relative_change_exact)},
                      {"at_amplitude", json_of(a.period.at_amplitude)}};
  result["error_estimate"] = {
      {"equilibrium", json_error_of(a.equilibrium.exact)},
      {"period", json_error_of(a.period.exact_small)},
      {"equilibrium_formula_24", json_error_of(a.equilibrium.formula_24)},
      {"equilibrium_linear", json_error_of(a.equilibrium.linear)},
      {"period_simple", json_error_of(a.period.simple)},
      {"period_linear", json_error_of(a.period.linear)},
      {"period_at_amplitude", json_error_of(a.period.at_amplitude)},
      {"relative_change_formula_25", json_error_of(a.period.relative_change_formula_25)},
      {"relative_change_exact", json_error_of(a.period.relative_change_exact)}};
  result["gravity_gradient"] = {{"included", request.gravity_gradient},
                                {"equilibrium", found.gradient.equilibrium},
                                {"relative_change", found.gradient.period}};
  result["run_time_s"] = run_time;
  result["terms_kept"] = json_of(a.terms_kept);
  result["terms_dropped"] = json_of(a.terms_dropped);
  return result;
}

}  // namespace kreisel
