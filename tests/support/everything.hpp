#pragma once

#include <vector>

#include <dynamics/inertia.hpp>
#include <dynamics/law/momentum.hpp>
#include <dynamics/law/relative.hpp>
#include <dynamics/law/vector_form.hpp>
#include <motor/displacement.hpp>
#include <motor/frame.hpp>
#include <motor/motor.hpp>
#include <motor/rate.hpp>
#include <motor/screw.hpp>
#include <motor/tensor.hpp>

namespace kreisel::test {

/// Numbers of order 1 that every scalar represents exactly.
template <class S>
struct Inputs {
  Motor<S> a{{S(1.5), S(-0.75), S(0.25)}, {S(0.5), S(2), S(-1.25)}};
  Motor<S> b{{S(-0.5), S(1), S(2.25)}, {S(1.75), S(-0.25), S(0.75)}};
  Motor<S> c{{S(0.25), S(-1.5), S(0.5)}, {S(-2), S(0.5), S(1)}};
  Vector3<S> p{S(0.75), S(-0.5), S(1.25)};
  Eigen::Quaternion<S> q{S(2), S(-1), S(0.5), S(1.5)};
  Matrix3<S> theta = (Matrix3<S>() << S(2.5), S(0.25), S(-0.125), S(0.25), S(3), S(0.5), S(-0.125),
                      S(0.5), S(2.75))
                         .finished();
};

/// Calls every public function of motor/ and of the inertia and laws once, and passes each
/// resulting number to take(). Constructs nothing that allocates memory.
template <class S, class Take>
void everything(const Inputs<S>& in, const Take& take) {
  const auto vector = [&](const Vector3<S>& v) {
    for (int i = 0; i < 3; ++i) take(v[i]);
  };
  const auto matrix = [&](const Matrix3<S>& m) {
    for (int i = 0; i < 9; ++i) take(m(i % 3, i / 3));
  };
  const auto motor = [&](const Motor<S>& m) {
    vector(m.resultant);
    vector(m.moment);
  };
  const auto pose = [&](const Pose<S>& X) {
    matrix(X.rotation);
    vector(X.translation);
  };
  const auto tensor = [&](const MotorTensor<S>& T) {
    matrix(T.rr);
    matrix(T.rm);
    matrix(T.mr);
    matrix(T.mm);
  };
  const auto inertia = [&](const Inertia<S>& T) {
    take(T.mass);
    vector(T.first_moment);
    matrix(T.tensor.matrix());
  };
  const auto& [a, b, c, p, q, theta] = in;

  // motor, screw
  Motor<S> d = a;
  d += b;
  d -= c;
  motor(d + a - b);
  motor(-(S(3) * a) / S(2) + b * S(2));
  motor(a.reduced_at(p));
  motor(cross(a, b));
  take(reciprocal(a, b));
  take(S(a == b ? 1 : 0));
  matrix(skew(p));
  vector(opening(a));
  vector(length(a));
  vector(axis_point(a));
  take(pitch(a));
  const Screw<S> s = screw(a);
  vector(s.direction);
  vector(s.point);
  take(s.intensity);
  take(s.pitch);
  motor(kreisel::motor(s));

  // tensor
  const MotorTensor<S> T = dyad(a, b) + S(2) * MotorTensor<S>::identity() - dyad(b, c);
  tensor(T);
  motor(T * c);
  tensor(transpose(T));
  tensor(cross(c, T));
  tensor(cross(T, c));

  // displacement
  const Pose<S> X = Pose<S>::from(q, p);
  pose(X);
  vector(X.point(p));
  pose(X.inverse());
  pose(X * X);
  motor(X * a);
  tensor(X * T);
  for (const S& angle : {S(0), S(0.0009765625), S(0.5), S(1.25), S(1.75)}) {
    const Pose<S> Y = exp(angle * a);
    pose(Y);
    motor(log(Y));
    take(quaternion(Y.rotation).w());
  }

  // frame, rate
  using Relative = Velocity<Body, Guide, Body, S>;
  using Guiding = Velocity<Guide, Inertial, Body, S>;
  const Relative V_rel{a};
  const Guiding F{b};
  const auto V = V_rel + F;
  motor(untagged(V - F));
  const Displacement<Guide, Body, S> X_GB{X};
  motor((X_GB * -V).value);
  vector((X_GB.inverse() * X_GB).point(p));
  take(power(Force<Body, S>{c}, V));
  const Rate<Body, Relative> starV{c};
  const auto ringV = seen_from<Guide>(starV, -V_rel, V_rel);
  const auto dotV = seen_from<Inertial>(ringV, -F, V_rel);
  const Rate<Guide, Guiding> ringF{d};
  const auto starF = seen_from<Body>(ringF, V_rel, F);
  const auto dotF = seen_from<Inertial>(ringF, -F, F);
  motor((dotV + dotF).value);
  motor((X_GB * (starF - starF)).value);
  motor(plain_rate(ringF, V_rel, F).value);
  motor(true_rate(plain_rate(dotV, V, V_rel), V, V_rel).value);
  motor(true_rate(plain_rate(starV)).value);

  // inertia
  const auto about_centre = InertiaTensor<Body, S>::about_centre(S(2), p, theta);
  const auto about_origin = InertiaTensor<Body, S>::about_origin(S(0.25), p, theta);
  inertia((about_centre + about_origin - about_origin).value);
  inertia(-about_centre.value);
  const InertiaTensor<Body, S>& J = about_centre;
  check(J.value, Mass::zero_allowed, "body");
  tensor(J.value.motor_tensor());
  matrix(offset_product(p, opening(a)).matrix());
  motor((J * V).value);
  motor((J * dotV).value);
  inertia((X_GB * J).value);
  inertia(rate(J, V_rel).value);
  motor(solve(J.value, c));

  // law
  const auto parts = [&](const ForceParts<Body, S>& all) {
    motor(all.relative.value);
    motor(all.guide.value);
    motor(all.coriolis.value);
    motor(all.total().value);
  };
  parts(equation_of_motion(J, V_rel, F, starV, starF));
  parts(equation_of_motion(J, V_rel, F, starV, ringF));
  parts(equation_of_motion(J, V_rel, F, starV, dotF));
  parts(equation_of_motion(J, V_rel, F, ringV, starF));
  parts(equation_of_motion(J, V_rel, F, ringV, ringF));
  parts(equation_of_motion(J, V_rel, F, ringV, dotF));
  parts(equation_of_motion(J, V_rel, F, dotV, starF));
  parts(equation_of_motion(J, V_rel, F, dotV, ringF));
  parts(equation_of_motion(J, V_rel, F, dotV, dotF));
  const Force<Body, S> P{c};
  motor(relative_acceleration<Body>(J, P, V_rel, F, ringF).value);
  motor(relative_acceleration<Guide>(J, P, V_rel, F, starF).value);
  motor(relative_acceleration<Inertial>(J, P, V_rel, F, dotF).value);
  const auto dH = momentum_rate(J, V_rel, V_rel, ringV);
  const auto dH_f = momentum_rate(J, V_rel, F, ringF);
  motor(momentum_balance(F, J * V_rel, dH, J * F, dH_f).value);
  parts(vector_form_18(J, V_rel, F, starV, starF));
  parts(vector_form_19(J, V_rel, F, starV, ringF));
  motor(vector_form_20(V_rel, F, J * V_rel, plain_rate(dH, V_rel, J * V_rel), J * F,
                       plain_rate(dH_f, V_rel, J * F))
            .value);
  vector(particle_force(S(2), p, opening(a), opening(b), c, d));
  using Own = Velocity<Guide, Inertial, Guide, S>;
  motor(carried_body_force(InertiaTensor<Guide, S>{J.value}, Own{b}, Rate<Guide, Own>{c}).value);
  vector(euler_torque(J.value.tensor, opening(a), opening(b)));
}

}  // namespace kreisel::test
