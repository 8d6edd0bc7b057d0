#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include <dynamics/pendulum/pendulum_equilibria.hpp>
#include <dynamics/pendulum/pendulum_period.hpp>
#include <motor/double_double_functions.hpp>

namespace kreisel {

/// A number and a bound of its error.
template <class S = double>
struct Estimated {
  S value;
  S error;
};

/// A part of the equation of motion, kept or dropped, with the reason and its greatest moment
/// relative to m a g' of the weight.
template <class S = double>
struct PendulumTerm {
  std::string name;
  std::string reason;
  S size;
};

/// The effect of the guide's rotation on a pendulum.
///
/// Units  : rad, s; relative changes are T/T_00 - 1
/// Error  : of an exact number, its rounding; of a formula, its difference from the exact number
template <class S = double>
struct PendulumAnswer {
  struct {
    Estimated<S> formula_24;             ///< (24)
    std::optional<Estimated<S>> linear;  ///< -(F + H)/(E + 2K); none if E + 2K = 0
    Estimated<S> exact;                  ///< the stable one nearest 0
  } equilibrium;
  std::vector<Equilibrium<S>> equilibria;
  struct {
    Estimated<S> simple;                                ///< T_00
    Estimated<S> relative_change_formula_25;            ///< z of (25)
    std::optional<Estimated<S>> linear;                 ///< none unless E + 2K > 0
    std::optional<Estimated<S>> exact_small;            ///< none at a bifurcation
    std::optional<Estimated<S>> relative_change_exact;  ///< none at a bifurcation
    std::optional<Estimated<S>> at_amplitude;           ///< on request
  } period;
  std::optional<Estimated<S>> other_turning_point;  ///< counted from phi = 0; on request
  PendulumCoefficients<S> coefficients;
  PendulumParts<S> parts;
  std::vector<PendulumTerm<S>> terms_kept;
  std::vector<PendulumTerm<S>> terms_dropped;
};

namespace detail {

/// All numbers of a PendulumAnswer, computed in one scalar.
template <class S>
struct PendulumNumbers {
  S formula_24, formula_25, simple;
  std::optional<S> linear_equilibrium, linear_period;
  std::vector<Equilibrium<S>> equilibria;
  Equilibrium<S> exact;
  std::optional<S> small, small_change;
  std::optional<FiniteOscillation<S>> finite;
};

template <class S>
[[nodiscard]] PendulumNumbers<S> pendulum_numbers(const PendulumBody<S>& body,
                                                  const PendulumGuide<S>& guide,
                                                  const std::optional<S>& amplitude) {
  const PendulumCoefficients<S> c = coefficients(body, guide);
  const LinearPendulum<S> linear = linearized(body, c);
  PendulumNumbers<S> n;
  n.formula_24 = formula_24(body, guide);
  n.formula_25 = formula_25(body, guide);
  n.simple = simple_period(body, c);
  n.linear_equilibrium = linear.equilibrium();
  n.linear_period = linear.period();
  n.equilibria = kreisel::equilibria(c);
  n.exact = nearest_stable(n.equilibria);
  if (!n.exact.degenerate) {
    n.small = small_period(body, c, n.exact.angle);
    n.small_change = small_period_change(c, n.exact.angle);
  }
  if (amplitude) n.finite = period_at_amplitude(body, c, n.equilibria, n.exact, *amplitude);
  return n;
}

/// The error of a number from a better one: |difference| and half a unit in the last place of the
/// number.
template <class S, class Wide>
[[nodiscard]] Estimated<S> against(const S& value, const Wide& better) {
  using std::abs;
  const Wide half_ulp = abs(Wide(value)) * Wide(std::numeric_limits<S>::epsilon()) / Wide(2);
  const Wide error = abs(Wide(value) - better) + half_ulp;
  // Rounded up, so that the bound remains a bound; + 0 turns -0 into 0.
  return {value + S(0), S(error) * (S(1) + S(2) * std::numeric_limits<S>::epsilon())};
}

template <class S, class Wide>
[[nodiscard]] std::optional<Estimated<S>> against(const std::optional<S>& value,
                                                  const std::optional<Wide>& better) {
  if (!value || !better) return {};
  return against(*value, *better);
}

template <class S>
void list_terms(const PendulumBody<S>& body, const PendulumGuide<S>& guide,
                PendulumAnswer<S>& answer) {
  using std::abs;
  const PendulumParts<S>& p = answer.parts;
  const auto kept = [&](std::string name, std::string reason, const S& moment) {
    answer.terms_kept.push_back({std::move(name), std::move(reason), abs(moment) / p.weight});
  };
  const auto dropped = [&](std::string name, std::string reason) {
    answer.terms_dropped.push_back({std::move(name), std::move(reason), S(0)});
  };
  // A number of (23): kept if it is not 0, else dropped, with the reason.
  const auto part = [&](const char* name, const S& moment, const char* origin,
                        const std::string& why_zero) {
    if (moment != S(0)) {
      kept(name, origin, moment);
    } else {
      dropped(name, why_zero);
    }
  };

  kept("E: weight", "m a g' sin(phi)", p.weight);
  if (guide.effective_gravity.y() == S(0) && guide.effective_gravity.z() == S(0)) {
    dropped("E, F: tilt", "the x axis lies along the effective gravity");
  } else {
    part("E: tilt", p.tilt.e, "effective gravity off the x axis", "g'_y^2 + g'_z^2 underflows");
    part("F: tilt", p.tilt.f, "effective gravity off the x axis", "g'_y = 0");
  }

  // The reason why  (Theta_B - Theta_A) first + Phi_C second  is 0.
  const auto why_zero_in_plane = [&](const S& first, const char* first_zero, const S& second,
                                     const char* second_zero) {
    const char* theta = body.theta_a == body.theta_b ? "Theta_A = Theta_B" : first_zero;
    const char* phi = body.phi_c == S(0) ? "Phi_C = 0" : second_zero;
    if ((body.theta_a != body.theta_b && first != S(0)) || (body.phi_c != S(0) && second != S(0))) {
      return std::string("Theta_B - Theta_A and Phi_C cancel");
    }
    return std::string(theta) + " and " + phi;
  };
  const char* no_phi_ab = body.phi_a == S(0) && body.phi_b == S(0) ? "Phi_A = Phi_B = 0" : nullptr;

  const Vector3<S>& u = guide.angular_velocity;
  if (u == Vector3<S>::Zero()) {
    dropped("E, F, H, K: centrifugal", "the guide does not rotate");
  } else {
    const char* ab = no_phi_ab != nullptr ? no_phi_ab : "u_z u_x and u_z u_y vanish, or cancel";
    const S squares = (u.x() - u.y()) * (u.x() + u.y());
    const S product = u.x() * u.y();
    part("E: centrifugal", p.centrifugal.e, "-Phi_A u_z u_y - Phi_B u_z u_x", ab);
    part("F: centrifugal", p.centrifugal.f, "-Phi_A u_z u_x + Phi_B u_z u_y", ab);
    part("H: centrifugal", p.centrifugal.h, "(Theta_B - Theta_A) u_x u_y - Phi_C (u_x^2 - u_y^2)",
         why_zero_in_plane(product, "u_x u_y = 0", squares, "u_x^2 = u_y^2"));
    part("K: centrifugal", p.centrifugal.k,
         "(Theta_A - Theta_B) (u_x^2 - u_y^2)/2 - 2 Phi_C u_x u_y",
         why_zero_in_plane(squares, "u_x^2 = u_y^2", product, "u_x u_y = 0"));
  }
  if (!guide.gravity_gradient) {
    dropped("E, F, H, K: gravity gradient",
            "not requested: gravity taken as uniform over the body");
  } else {
    const Matrix3<S>& G = *guide.gravity_gradient;
    const char* ab = no_phi_ab != nullptr ? no_phi_ab : "G_xz and G_yz vanish, or cancel";
    const S squares = G(1, 1) - G(0, 0);
    const PendulumTerms<S>& g = p.gravity_gradient;
    part("E: gravity gradient", g.e, "G_xz Phi_B + G_yz Phi_A", ab);
    part("F: gravity gradient", g.f, "G_xz Phi_A - G_yz Phi_B", ab);
    part("H: gravity gradient", g.h, "-G_xy (Theta_B - Theta_A) - (G_yy - G_xx) Phi_C",
         why_zero_in_plane(G(0, 1), "G_xy = 0", squares, "G_xx = G_yy"));
    part("K: gravity gradient", g.k, "2 G_xy Phi_C - (G_yy - G_xx) (Theta_B - Theta_A)/2",
         why_zero_in_plane(squares, "G_xx = G_yy", G(0, 1), "G_xy = 0"));
  }
  dropped("E, F, right side: Euler", "the guide turns steadily, du/dt = 0");
  dropped("f: damping", "equilibria and periods are those of the undamped pendulum");
  dropped("Coriolis", "has no moment about the axis of a body that turns about it");
}

}  // namespace detail

/// Equilibrium and period of a pendulum on a steadily moving guide, with error estimates.
///
/// Everything is computed twice, in S and in DoubleDouble, from the same inputs. The result is the
/// number in S; its error is |difference| + half a unit in its last place. Inputs in DoubleDouble
/// (decimals read by finite_number()) count as exact: the estimate then includes their rounding to
/// S. Inputs in S count as exact too.
///
/// Source : paper 002 section 5
/// Error  : true error <= estimate in all reference cases; measured ratios in
///          tests/dynamics/pendulum/pendulum_deviation.cpp
/// Cost   : 8 us without, 17 us with amplitude 0.1, 90 us with amplitude 3 (2.5 GHz Xeon)
/// Throws : InvalidInput: a body that check() refuses, a guide with angular acceleration or without
///          gravity, a number that is not finite, |amplitude| > pi; ComputationFailed as
///          equilibria() and period_at_amplitude()
template <class S = double, class T>
[[nodiscard]] PendulumAnswer<S> deviation(
    const PendulumBody<T>& body, const PendulumGuide<T>& guide,
    const std::type_identity_t<std::optional<T>>& amplitude = {}) {
  using Wide = DoubleDouble;
  static_assert(std::numeric_limits<Wide>::digits >= std::numeric_limits<S>::digits + 8,
                "deviation() estimates errors by numbers with at least 8 bits more than S");
  check(body);
  if (!guide.angular_velocity.allFinite() || !guide.effective_gravity.allFinite() ||
      (guide.gravity_gradient && !guide.gravity_gradient->allFinite())) {
    throw InvalidInput(
        "guide: angular_velocity, effective_gravity and gravity_gradient must be finite");
  }
  if (!(guide.angular_acceleration == Vector3<T>::Zero())) {
    throw InvalidInput(
        "guide: angular_acceleration must be 0: a pendulum has equilibria only on a steady guide");
  }
  if (guide.effective_gravity == Vector3<T>::Zero()) {
    throw InvalidInput("guide: effective_gravity must not be 0");
  }

  const PendulumBody<S> body_s = body.template cast<S>();
  const PendulumGuide<S> guide_s = guide.template cast<S>();
  std::optional<S> amplitude_s;
  std::optional<Wide> amplitude_wide;
  if (amplitude) {
    amplitude_s = S(*amplitude);
    amplitude_wide = Wide(*amplitude);
  }
  const auto n = detail::pendulum_numbers(body_s, guide_s, amplitude_s);
  const auto better = detail::pendulum_numbers(body.template cast<Wide>(),
                                               guide.template cast<Wide>(), amplitude_wide);

  PendulumAnswer<S> answer;
  const Wide phi_0 = better.exact.angle;
  answer.equilibrium.exact = detail::against(n.exact.angle, phi_0);
  answer.equilibrium.formula_24 = detail::against(n.formula_24, phi_0);
  answer.equilibrium.linear = detail::against(n.linear_equilibrium, std::optional<Wide>(phi_0));
  answer.equilibria = n.equilibria;
  answer.period.exact_small = detail::against(n.small, better.small);
  answer.period.relative_change_exact = detail::against(n.small_change, better.small_change);
  answer.period.linear = detail::against(n.linear_period, better.small);
  const auto or_unknown = [](const S& value, const std::optional<Wide>& known) {
    const Estimated<S> unknown{value, std::numeric_limits<S>::infinity()};
    return known ? detail::against(value, *known) : unknown;
  };
  answer.period.simple = or_unknown(n.simple, better.small);
  answer.period.relative_change_formula_25 = or_unknown(n.formula_25, better.small_change);
  if (n.finite) {
    Estimated<S> period = detail::against(n.finite->period, better.finite->period);
    period.error += n.finite->quadrature_error;
    answer.period.at_amplitude = period;
    answer.other_turning_point = detail::against(S(n.exact.angle + n.finite->other_turning_point),
                                                 Wide(phi_0 + better.finite->other_turning_point));
  }
  answer.parts = parts(body_s, guide_s);
  answer.coefficients = coefficients(answer.parts);
  detail::list_terms(body_s, guide_s, answer);
  return answer;
}

}  // namespace kreisel
