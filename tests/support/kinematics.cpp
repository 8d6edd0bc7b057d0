#include <Eigen/Geometry>
#include <boost/multiprecision/cpp_bin_float.hpp>

#include <vector>

#include <motor/frame.hpp>
#include <motor/motor.hpp>

#include <support/jet.hpp>
#include <support/kinematics.hpp>
#include <support/sample.hpp>

namespace kreisel::test {

namespace {

using J50 = Jet<Digits50>;
using JetVector = Vector3<J50>;
using JetMatrix = Matrix3<J50>;

struct JetPose {
  JetMatrix R;
  JetVector o;
};

struct JetMotor {
  JetVector r, m;
};

J50 at(const Wave& f, const Digits50& t) {
  const J50 time{t, 1, 0};
  return f.c0 + f.c1 * time + f.c2 * time * time + f.A * sin(f.w * time + f.p);
}

JetPose pose(const Motion& motion, const Digits50& t) {
  const J50 cz = cos(at(motion.yaw, t)), sz = sin(at(motion.yaw, t));
  const J50 cy = cos(at(motion.pitch, t)), sy = sin(at(motion.pitch, t));
  const J50 cx = cos(at(motion.roll, t)), sx = sin(at(motion.roll, t));
  JetMatrix Rz, Ry, Rx;
  Rz << cz, -sz, 0, sz, cz, 0, 0, 0, 1;
  Ry << cy, 0, sy, 0, 1, 0, -sy, 0, cy;
  Rx << 1, 0, 0, 0, cx, -sx, 0, sx, cx;
  return {Rz * Ry * Rx, {at(motion.x, t), at(motion.y, t), at(motion.z, t)}};
}

/// The velocity motor of the posed frame relative to its base, written in the latter.
/// (rate R) R^t p is w x p. The point at its origin moves with (rate o) - w x o.
JetMotor velocity(const JetPose& X) {
  const JetMatrix spin = rate(X.R) * X.R.transpose();
  const JetVector w(spin(2, 1), spin(0, 2), spin(1, 0));
  return {w, rate(X.o) - w.cross(X.o)};
}

/// From the frame that X poses into its base frame, and back.
JetMotor outwards(const JetPose& X, const JetMotor& a) {
  const JetVector r = X.R * a.r;
  return {r, X.R * a.m - r.cross(X.o)};
}
JetMotor inwards(const JetPose& X, const JetMotor& a) {
  return {X.R.transpose() * a.r, X.R.transpose() * (a.m + a.r.cross(X.o))};
}

/// All derivatives of a motor given in guide coordinates.
Differentiated differentiate(const JetMotor& in_guide, const JetPose& G, const JetPose& B) {
  const JetMotor in_body = inwards(B, in_guide);
  const JetMotor in_inertial = outwards(G, in_guide);
  const auto still = [](const JetPose& X) {
    return JetPose{value(X.R).template cast<J50>(), value(X.o).template cast<J50>()};
  };
  const auto numbers = [](const JetMotor& a) { return Motor<Digits50>{value(a.r), value(a.m)}; };
  const auto slope = [](const JetMotor& a) { return JetMotor{rate(a.r), rate(a.m)}; };

  Differentiated a;
  a.value = numbers(in_body);
  a.T.body = numbers(slope(in_body));
  a.T.guide = numbers(inwards(still(B), slope(in_guide)));
  a.T.inertial = numbers(inwards(still(B), inwards(still(G), slope(in_inertial))));

  // The two vectors at O': on body axes those of in_body, rotated to the others' axes.
  const auto plain = [&](const JetMatrix& R) {
    const Matrix3<Digits50> back = value(R).transpose();
    return Motor<Digits50>{back * first(JetVector(R * in_body.r)),
                           back * first(JetVector(R * in_body.m))};
  };
  a.P.body = numbers(slope(in_body));
  a.P.guide = plain(B.R);
  a.P.inertial = plain(G.R * B.R);
  return a;
}

}  // namespace

Wave Wave::still(const Digits50& t) const { return {at(*this, t).value}; }

Motion Motion::still(const Digits50& t) const {
  return {yaw.still(t), pitch.still(t), roll.still(t), x.still(t), y.still(t), z.still(t)};
}

Truth truth(const Motion& guide, const Motion& relative, const Digits50& t,
            const std::vector<PointMass>& masses) {
  const JetPose G = pose(guide, t);
  const JetPose B = pose(relative, t);
  const JetMotor F = inwards(G, velocity(G));
  const JetMotor V_rel = velocity(B);

  Truth truth;
  truth.X_GB = {value(B.R), value(B.o)};
  truth.X_IG = {value(G.R), value(G.o)};
  truth.V_rel = differentiate(V_rel, G, B);
  truth.F = differentiate(F, G, B);
  truth.r_G = value(B.o);
  truth.F_G = {value(F.r), value(F.m)};
  truth.dF_G = {first(F.r), first(F.m)};

  JetMotor J{JetVector::Zero(), JetVector::Zero()};
  JetMotor J_f = J;
  const Vector3<Digits50> o = value(JetVector(G.R * B.o + G.o));
  for (const auto& [mass, place] : masses) {
    const J50 m = Digits50(mass);
    const JetVector p = B.R * place.cast<J50>() + B.o;  // in the guide
    const JetVector momentum = m * rate(p);
    const JetVector carried = m * (F.m + F.r.cross(p));
    J = {J.r + momentum, J.m + p.cross(momentum)};
    J_f = {J_f.r + carried, J_f.m + p.cross(carried)};

    const JetVector q = G.R * p + G.o;  // in the inertial frame
    const Vector3<Digits50> P = Digits50(mass) * second(q);
    truth.force.resultant += P;
    truth.force.moment += (value(q) - o).cross(P);
  }
  const Matrix3<Digits50> to_body = value(JetMatrix(G.R * B.R)).transpose();
  truth.force = {to_body * truth.force.resultant, to_body * truth.force.moment};
  truth.J = differentiate(J, G, B);
  truth.J_f = differentiate(J_f, G, B);
  return truth;
}

Motion motion(Sample& sample) {
  const double speed = sample.magnitude(-1, 1);
  const auto wave = [&](double size) -> Wave {
    if (sample.once_in(6)) return {Digits50(size * sample.uniform(-1, 1))};
    return {size * sample.uniform(-1, 1),
            size * speed * sample.uniform(-1, 1),
            size * speed * speed * sample.uniform(-1, 1),
            size * sample.uniform(-1, 1),
            speed * sample.uniform(0, 2),
            sample.uniform(0, 6)};
  };
  if (sample.once_in(12)) return {};
  Motion motion;
  const double distance = sample.magnitude(-1, 1);
  motion.yaw = wave(1);
  motion.pitch = wave(1);
  motion.roll = wave(1);
  motion.x = wave(distance);
  motion.y = wave(distance);
  motion.z = wave(distance);
  return motion;
}

Truth truth(Sample& sample, const std::vector<PointMass>& masses) {
  const Motion guide = motion(sample);
  const Motion relative = motion(sample);
  return truth(guide, relative, Digits50(0), masses);
}

}  // namespace kreisel::test
