#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <dynamics/guide/normal_gravity.hpp>
#include <dynamics/pendulum/pendulum_deviation.hpp>

/// The deviation of a pendulum from the vertical at a site of the earth.

namespace kreisel {

/// The pendulum and its field. Inputs are DoubleDouble, so that decimals count as exact.
struct SitePendulum {
  PendulumBody<DoubleDouble> body;
  std::optional<DoubleDouble> gravity = {};       ///< m/s^2, effective; none: WGS84 at the site
  bool gravity_gradient = false;                  ///< includes the gradient over the body
  DoubleDouble amplitude = DoubleDouble(1) / 10;  ///< rad, of the finite oscillation
};

/// A pendulum by its reduced length, as a rod, or by single numbers, in SI units.
struct PendulumNumbers {
  using Number = std::optional<DoubleDouble>;
  Number reduced_length, rod, mass, arm, theta_a, theta_b, theta_c, phi_a, phi_b, phi_c;

  /// The body of the numbers; without any a reduced length of 0.5 m and a mass of 1 kg.
  ///
  /// Throws : InvalidInput if numbers are missing, exclude each other or belong to no body
  [[nodiscard]] PendulumBody<DoubleDouble> body() const {
    const bool by_number = arm || theta_a || theta_b || theta_c || phi_a || phi_b || phi_c;
    if (int(by_number) + int(rod.has_value()) + int(reduced_length.has_value()) > 1) {
      throw InvalidInput(
          "the pendulum is given twice: give one of reduced length, rod, or arm with theta a, "
          "theta b and theta c");
    }
    PendulumBody<DoubleDouble> result = with_mass(mass.value_or(1));
    check(result);
    return result;
  }

 private:
  [[nodiscard]] PendulumBody<DoubleDouble> with_mass(DoubleDouble m) const {
    const auto length = [](const char* name, DoubleDouble value) {
      if (value > 0) return value;
      throw InvalidInput(std::string(name) + " must be a length above 0 m");
    };
    if (rod) return PendulumBody<DoubleDouble>::thin_rod(length("rod", *rod), m);
    if (!arm && !theta_a && !theta_b && !theta_c && !phi_a && !phi_b && !phi_c) {
      return PendulumBody<DoubleDouble>::from_reduced_length(
          length("reduced length", reduced_length.value_or(0.5)), m);
    }
    if (!arm || !theta_a || !theta_b || !theta_c) {
      throw InvalidInput("a pendulum by numbers needs arm, theta a, theta b and theta c");
    }
    return {m,
            *arm,
            *theta_a,
            *theta_b,
            *theta_c,
            phi_a.value_or(0),
            phi_b.value_or(0),
            phi_c.value_or(0)};
  }
};

/// The effect of the gravity gradient over the body, in first order, whether included or not.
struct GradientEffect {
  double equilibrium;  ///< rad
  double period;       ///< relative change
};

struct SiteDeviation {
  double gravity;  ///< m/s^2, effective
  PendulumAnswer<double> answer;
  GradientEffect gradient;

  /// The numbers that are exact but for rounding, without periods that do not exist.
  [[nodiscard]] std::vector<Estimated<double>> exact_numbers() const {
    std::vector<Estimated<double>> numbers{answer.equilibrium.exact};
    const auto& period = answer.period;
    for (const auto& number :
         {period.exact_small, period.relative_change_exact, period.at_amplitude}) {
      if (number) numbers.push_back(*number);
    }
    return numbers;
  }

  /// True if each exact number has a bound of its error.
  [[nodiscard]] bool is_bounded() const {
    const std::vector<Estimated<double>> numbers = exact_numbers();
    return std::all_of(numbers.begin(), numbers.end(),
                       [](const auto& number) { return std::isfinite(number.error); });
  }
};

namespace detail {

/// Adds the rounding of normal gravity, which is computed in double: u and g' are right to 4
/// epsilon.
inline void add_rounding_of_normal_gravity(const PendulumBody<DoubleDouble>& body,
                                           DoubleDouble rate, PendulumAnswer<double>& answer) {
  const DoubleDouble spread =
      abs(body.theta_b - body.theta_a) + abs(body.phi_a) + abs(body.phi_b) + 2 * abs(body.phi_c);
  constexpr double relative = 4 * std::numeric_limits<double>::epsilon();
  const DoubleDouble weight = answer.coefficients.weight;
  const double centrifugal = relative * static_cast<double>(spread * rate * rate / weight);
  const double stiffness =
      answer.coefficients.stiffness(answer.equilibrium.exact.value) / answer.coefficients.weight;
  answer.equilibrium.exact.error += centrifugal / stiffness;
  if (auto& change = answer.period.relative_change_exact) change->error += centrifugal;
  for (auto* const period : {&answer.period.exact_small, &answer.period.at_amplitude}) {
    if (*period) (*period)->error += relative * (*period)->value;
  }
}

inline EarthGuide<DoubleDouble> guide_at(EarthSite<DoubleDouble> site,
                                         const std::optional<DoubleDouble>& gravity) {
  if (!gravity) return normal_gravity(site.cast<double>()).guide.cast<DoubleDouble>();
  EarthGuide<DoubleDouble> earth = earth_guide(site, *gravity);
  // A gravimeter measures gravity alone. Its gradient is the ellipsoid's, at any rotation rate.
  site.rotation_rate = EarthSite<DoubleDouble>{}.rotation_rate;
  earth.gravity_gradient =
      normal_gravity(site.cast<double>()).guide.gravity_gradient.cast<DoubleDouble>();
  return earth;
}

inline GradientEffect effect_of_gradient(const PendulumBody<DoubleDouble>& body,
                                         const EarthGuide<DoubleDouble>& earth) {
  const auto of_guide = parts(body, pendulum_guide(earth, GravityGradient::taken_in));
  const auto& [e, f, h, k] = of_guide.gravity_gradient;
  return {static_cast<double>(-(f + h) / of_guide.weight),
          static_cast<double>(-(e + 2 * k) / (2 * of_guide.weight))};
}

}  // namespace detail

/// Equilibrium and period of a pendulum at rest on the earth, with errors.
///
/// Frame  : guide axes at the site: x down along effective gravity, z along the azimuth
/// Units  : SI and radian; the site in degrees and m
/// Throws : InvalidInput; ComputationFailed if deviation or period are not finite
/// Source : paper 002 section 5, (24) and (25)
[[nodiscard]] inline SiteDeviation deviation_at(const EarthSite<DoubleDouble>& site,
                                                const SitePendulum& pendulum) {
  const EarthGuide<DoubleDouble> earth = detail::guide_at(site, pendulum.gravity);
  const auto gradient =
      pendulum.gravity_gradient ? GravityGradient::taken_in : GravityGradient::left_out;
  SiteDeviation result{
      static_cast<double>(earth.effective_gravity.x()),
      deviation(pendulum.body, pendulum_guide(earth, gradient), pendulum.amplitude),
      detail::effect_of_gradient(pendulum.body, earth)};
  if (!pendulum.gravity) {
    detail::add_rounding_of_normal_gravity(pendulum.body, site.rotation_rate, result.answer);
  }
  for (const auto& number : result.exact_numbers()) {
    if (!std::isfinite(number.value)) {
      throw ComputationFailed("the deviation or the period is not finite");
    }
  }
  return result;
}

}  // namespace kreisel
