#include "modes.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>

namespace kreisel {

using nlohmann::ordered_json;

namespace {

bool oscillates(const WhirlingMode& mode) {
  return mode.root.imag() > mode.error || mode.harmonic != 0;
}

}  // namespace

double damping_ratio(const std::complex<double>& root) {
  return root.real() != 0 ? -root.real() / std::abs(root) : 0;
}

std::string mostly(const WhirlingMode& mode, const std::vector<std::string>& names, int rates) {
  Eigen::Index most = 0;
  if (mode.shape.head(rates).cwiseAbs().maxCoeff(&most) == 0) {
    mode.shape.cwiseAbs().maxCoeff(&most);
  }
  return names[static_cast<std::size_t>(most)];
}

const char* sense(const WhirlingMode& mode) {
  return oscillates(mode) ? name(mode.whirl.sense) : "";
}

const char* name(Verdict verdict) {
  static constexpr const char* verdicts[] = {"stable", "marginal", "unstable"};
  return verdicts[static_cast<int>(verdict)];
}

const char* kind(const GyroscopicMode& mode, bool has_rotors) {
  static constexpr const char* kinds[] = {"nutation", "precession", "oscillation"};
  const bool oscillates = mode.root.imag() > mode.error;
  return has_rotors && oscillates ? kinds[static_cast<int>(mode.kind())] : "";
}

std::complex<double> shown_root(const Mode& mode) {
  const auto part = [&mode](double x) { return std::abs(x) > mode.error ? x : 0; };
  return {part(mode.root.real()), part(mode.root.imag())};
}

ordered_json json_of(const WhirlingMode& mode, bool has_rotors) {
  const double w = mode.root.imag();
  ordered_json result{{"growth_rate", mode.root.real()},
                      {"frequency", w},
                      {"frequency_hz", w / (2 * std::numbers::pi)},
                      {"damping_ratio", damping_ratio(mode.root)},
                      {"error", mode.error}};
  if (*kind(mode, has_rotors) != '\0') {
    result["kind"] = kind(mode, has_rotors);
    result["spin_growth"] = mode.spin_growth;
  }
  if (!oscillates(mode)) return result;
  result["frequency_against_guide"] = mode.frequency();
  if (mode.harmonic != 0) result["harmonic"] = mode.harmonic;
  if (mode.whirl.sense == Whirl::none) return result;
  result["whirl"] = name(mode.whirl.sense);
  result["circulation"] = mode.whirl.circulation;
  return result;
}

ordered_json roots_json(const LinearMotion& linear) {
  ordered_json roots = ordered_json::array();
  for (const WhirlingMode& mode : linear.modes) {
    roots.push_back(json_of(mode, linear.has_rotors));
    roots.back()["mostly"] = mostly(mode, linear.names, linear.rates);
  }
  return roots;
}

ordered_json json_of(const LinearMotion& linear) {
  ordered_json result = {{"verdict", name(linear.verdict)},
                         {"frame", linear.frame},
                         {"roots", roots_json(linear)},
                         {"left_out", linear.left_out}};
  if (!linear.dependent.empty()) result["dependent"] = linear.dependent;
  if (linear.sample_period > 0) {
    result["sample_period"] = linear.sample_period;
    result["dead_beats"] = linear.dead_beats;
  }
  return result;
}

ordered_json json_of(const SceneSweep& sweep) {
  ordered_json curves = ordered_json::array();
  for (const ModeCurve& curve : sweep.curves) {
    ordered_json modes = ordered_json::array();
    for (const auto& mode : curve) {
      modes.push_back(mode ? json_of(*mode, sweep.has_rotors) : ordered_json());
    }
    curves.push_back(modes);
  }
  ordered_json critical = ordered_json::array();
  for (const CriticalSpeed& one : sweep.critical) {
    critical.push_back({{"speed", one.speed},
                        {"order", one.order},
                        {"curve", one.curve},
                        {"frequency", one.mode.frequency()},
                        {"whirl", name(one.mode.whirl.sense)},
                        {"mode", json_of(one.mode, sweep.has_rotors)}});
  }
  ordered_json limits = ordered_json::array();
  for (const StabilityLimit& one : sweep.limits) {
    limits.push_back({{"speed", one.speed},
                      {"growth", one.begins ? "begins" : "ends"},
                      {"mode", json_of(one.mode, sweep.has_rotors)}});
  }
  ordered_json result{{"body", sweep.body},          {"frame", sweep.frame},
                      {"speeds", sweep.speeds},      {"curves", curves},
                      {"critical_speeds", critical}, {"stability_limits", limits}};
  if (sweep.is_periodic) result["periods"] = sweep.periods;
  return result;
}

}  // namespace kreisel
