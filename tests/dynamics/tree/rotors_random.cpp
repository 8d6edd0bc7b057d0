#include <Eigen/Dense>
#include <boost/test/unit_test.hpp>
#include <unsupported/Eigen/AutoDiff>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <dynamics/tree/joint/list.hpp>
#include <dynamics/tree/rotor_matrices.hpp>

#include <support/random_tree.hpp>
#include <support/sample.hpp>
#include <support/worst.hpp>

/// Random trees with rotors against the same trees with ordinary bodies in their place. A free
/// rotor is a revolute joint without force, a driven one has its torque as joint force, a regulated
/// one has a constant rate.

using namespace kreisel;

namespace {

struct FrozenGuide {
  FrameMotion<Guide, Inertial> motion;
  [[nodiscard]] FrameMotion<Guide, Inertial> operator()(double) const { return motion; }
};

/// Weight as a user's load, which a rotor may have.
struct Attraction {
  static constexpr bool ignores_spin = true;
  UniformGravity<Inertial> field;

  [[nodiscard]] Force<Body> operator()(const LoadContext<>& s) const { return field(s); }
  [[nodiscard]] double potential(const LoadContext<>& s) const { return field.potential(s); }
};

struct RandomRotors {
  std::vector<BodyDescription> with;
  std::vector<BodyDescription> without;
  FrozenGuide guide;
  Gravity gravity;
  Eigen::VectorXd y;
  Eigen::VectorXd extra;

  explicit RandomRotors(std::uint64_t seed) {
    test::Sample sample(seed);
    const auto vec = [&](double size) { return Vector3<double>(size * sample.direction()); };
    const int carriers = static_cast<int>(sample.uniform(0, 5));
    const int rotors = 1 + static_cast<int>(sample.uniform(0, 4));
    int left = rotors;
    int made = 0;
    int rates = 0;
    int coordinates = 0;
    std::vector<int> balls;
    for (int i = 0; i < carriers + rotors; ++i) {
      const bool rotor = made == carriers || (left > 0 && sample.once_in(2));
      BodyDescription b;
      b.name = (rotor ? "rotor " : "body ") + std::to_string(rotor ? left : made);
      if (made > 0 && !sample.once_in(6)) {
        b.parent = "body " + std::to_string(static_cast<int>(sample.uniform(0, made)));
      }
      b.joint.kind = rotor ? JointKind::revolute : test::random_kind(sample);
      b.joint.axis = vec(sample.uniform(0.5, 2));
      b.joint.second_axis = b.joint.axis.unitOrthogonal();
      b.joint.position = vec(sample.uniform(0, 1));
      b.joint.pitch = sample.uniform(-0.5, 0.5);
      b.joint.orientation = Eigen::Quaterniond(sample.uniform(0.2, 1), sample.uniform(-1, 1),
                                               sample.uniform(-1, 1), sample.uniform(-1, 1));
      const double mass = sample.uniform(0.3, 3);
      if (rotor) {
        const Vector3<double> e =
            b.joint.orientation.normalized().conjugate() * b.joint.axis.normalized();
        const double about = sample.uniform(0.01, 0.1);
        const double across = about * sample.uniform(0.5, 3);
        const Matrix3<double> tensor =
            across * Matrix3<double>::Identity() + (about - across) * e * e.transpose();
        b.inertia = InertiaTensor<Body>::about_centre(
            mass, sample.once_in(3) ? 0 * e : Vector3<double>(sample.uniform(-0.3, 0.3) * e),
            tensor);
      } else {
        const Vector3<double> thirds(sample.uniform(0.02, 0.2), sample.uniform(0.02, 0.2),
                                     sample.uniform(0.02, 0.2));
        b.inertia = InertiaTensor<Body>::about_centre(
            mass, vec(sample.uniform(0, 0.5)),
            Vector3<double>(thirds.y() + thirds.z(), thirds.x() + thirds.z(),
                            thirds.x() + thirds.y())
                .asDiagonal());
        if (sample.once_in(8)) b.rule = JointRule::held;
        if (b.joint.kind == JointKind::revolute && sample.once_in(6)) {
          b.rule = JointRule::driven;
        }
        if (sample.once_in(3)) {
          b.loads.emplace_back(ConstantLoad<Body>{.force = vec(3), .torque = vec(2)});
        }
      }
      if (sample.once_in(4)) b.loads.emplace_back(Attraction{{vec(5)}});
      const JointType& type = joint_type(b.joint.kind);
      if (!rotor && sample.once_in(2)) {
        b.forces.resize(static_cast<std::size_t>(type.rate_count()));
        for (JointForce& f : b.forces) {
          f = {.damping = sample.uniform(0, 2), .constant = sample.uniform(-2, 2)};
        }
      }
      if (type.has_attitude()) balls.push_back(coordinates + 3);
      rates += type.rate_count();
      coordinates += type.coordinate_count();
      BodyDescription plain = b;
      if (rotor) {
        const auto mode = static_cast<RotorMode>(static_cast<int>(sample.uniform(0, 3)));
        b.rotor = Rotor{.mode = mode};
        if (mode != RotorMode::free) {
          b.forces = {{.damping = sample.uniform(0, 0.1), .constant = sample.uniform(-1, 1)}};
        }
        plain.forces = b.forces;
        if (mode == RotorMode::torque) {
          b.rotor->torque = sample.uniform(-2, 2);
          plain.forces[0].constant += b.rotor->torque;
        }
        if (mode == RotorMode::regulated) plain.rule = JointRule::driven;
        --left;
      } else {
        ++made;
      }
      with.push_back(b);
      without.push_back(plain);
    }
    if (!sample.once_in(6)) {
      guide.motion.X.value = {sample.rotation(), vec(3)};
      guide.motion.V.value = {vec(sample.uniform(0, 3)), vec(5)};
      guide.motion.dV.value = {vec(sample.uniform(0, 3)), vec(5)};
    }
    if (sample.once_in(2)) gravity = UniformGravity<Inertial>{vec(9.8)};
    y.resize(coordinates + rates);
    extra.resize(rates);
    for (double& x : y) x = sample.uniform(-2, 2);
    for (double& x : extra) x = sample.uniform(-3, 3);
    for (const int ball : balls) y[ball] = sample.uniform(0.5, 2);
    int v = coordinates;
    for (const BodyDescription& b : with) {
      if (b.rotor) y[v] *= 20;
      v += joint_type(b.joint.kind).rate_count();
    }
  }
};

double size(const Motor<>& m) { return m.resultant.norm() + m.moment.norm(); }

/// The worst relative distance of each kind of answer.
struct Worst {
  double value = 0;

  void note(double distance, double scale) { value = test::worst_of(value, distance / scale); }
};

constexpr std::uint64_t seeds = 500;

}  // namespace

BOOST_AUTO_TEST_SUITE(a_random_tree_with_rotors)

BOOST_AUTO_TEST_CASE(agrees_with_the_tree_of_ordinary_bodies) {
  Worst rates, inverse, mass, reaction, drive, parts, balance, place, terms;
  int rotors = 0;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    BOOST_TEST_CONTEXT("seed = " << seed) {
      const RandomRotors random(seed);
      const BodySystem<FrozenGuide> a(random.guide, random.with, random.gravity);
      const BodySystem<FrozenGuide> b(random.guide, random.without, random.gravity);
      rotors += static_cast<int>(a.tree().rotors().size());
      BOOST_TEST_REQUIRE(b.tree().rotors().empty());
      BodyWorkspace w = a.workspace();
      BodyWorkspace v = b.workspace();
      const Eigen::VectorXd& y = random.y;

      Eigen::VectorXd x, z;
      a.accelerations(0, y, random.extra, x, w);
      b.accelerations(0, y, random.extra, z, v);
      const double fastest = z.cwiseAbs().maxCoeff() + 1;
      rates.note((x - z).cwiseAbs().maxCoeff<Eigen::PropagateNaN>(), fastest);
      a.rates(0, y, x, w);
      b.rates(0, y, z, v);
      rates.note((x - z).cwiseAbs().maxCoeff<Eigen::PropagateNaN>(), z.cwiseAbs().maxCoeff() + 1);

      a.joint_forces(0, y, random.extra, x, w);
      b.joint_forces(0, y, random.extra, z, v);
      inverse.note((x - z).cwiseAbs().maxCoeff<Eigen::PropagateNaN>(), z.cwiseAbs().maxCoeff() + 1);

      Eigen::MatrixXd A, B;
      a.mass_matrix(y, A, w);
      b.mass_matrix(y, B, v);
      mass.note((A - B).cwiseAbs().maxCoeff<Eigen::PropagateNaN>(), B.cwiseAbs().maxCoeff());

      JointReactions r, s;
      a.reactions(0, y, r, w);
      b.reactions(0, y, s, v);
      double largest = 1;
      for (const Force<Body>& R : s.on_body) largest = std::max(largest, size(R.value));
      for (std::size_t i = 0; i < r.on_body.size(); ++i) {
        reaction.note(size(r.on_body[i].value - s.on_body[i].value), largest);
      }
      drive.note((r.drive - s.drive).cwiseAbs().maxCoeff<Eigen::PropagateNaN>(), largest);

      std::vector<ReactionParts> p, o;
      a.reaction_parts(0, y, p, w);
      b.reaction_parts(0, y, o, v);
      for (std::size_t i = 0; i < p.size(); ++i) {
        for (const auto part : {&ReactionParts::spin, &ReactionParts::guide,
                                &ReactionParts::gravity, &ReactionParts::forces}) {
          largest = std::max(largest, size((o[i].*part).value));
        }
      }
      for (std::size_t i = 0; i < p.size(); ++i) {
        for (const auto part : {&ReactionParts::spin, &ReactionParts::guide,
                                &ReactionParts::gravity, &ReactionParts::forces}) {
          parts.note(size((p[i].*part).value - (o[i].*part).value), largest);
        }
      }

      const BodyBalance m = a.balance(0, y, w);
      const BodyBalance n = b.balance(0, y, v);
      const double energy = n.kinetic_energy + n.relative_kinetic_energy;
      balance.note(std::abs(m.kinetic_energy - n.kinetic_energy), energy);
      balance.note(std::abs(m.relative_kinetic_energy - n.relative_kinetic_energy), energy);
      // The motor of a regulated rotor compensates its constant force.
      double potential = n.potential_energy;
      for (int i = 0; i < a.body_count(); ++i) {
        const BodyDescription& body = a.tree().body(i);
        if (!body.rotor || body.rotor->mode != RotorMode::regulated) continue;
        potential += body.forces[0].constant * y[a.tree().place(i).q];
      }
      balance.note(std::abs(m.potential_energy - potential), energy + std::abs(potential) + 100);
      balance.note(size(m.momentum.value - n.momentum.value), size(n.momentum.value));
      balance.note(size(m.relative_momentum.value - n.relative_momentum.value),
                   size(n.relative_momentum.value) + size(n.momentum.value));

      for (int i = 0; i < a.body_count(); ++i) {
        const LoadContext<> here = a.situation(0, y, i, w);
        const LoadContext<> there = b.situation(0, y, i, v);
        place.note((here.X.value.rotation - there.X.value.rotation).norm() +
                       (here.X.value.translation - there.X.value.translation).norm(),
                   1 + there.X.value.translation.norm());
        place.note(size(here.V_rel.value - there.V_rel.value), 1 + size(there.V_rel.value));
        const ForceParts<Body> f = a.terms(0, y, i, w);
        const ForceParts<Body> g = b.terms(0, y, i, v);
        terms.note(size(f.total().value - g.total().value), largest);
      }
    }
  }
  for (const Worst& worst : {rates, inverse, mass, reaction, drive, parts, balance, place, terms}) {
    BOOST_TEST(worst.value <= 1e-12);
  }
  BOOST_TEST(rotors > int(seeds));
  BOOST_TEST_MESSAGE(rotors << " rotors: rates " << rates.value << ", inverse " << inverse.value
                            << ", mass " << mass.value << ", reactions " << reaction.value
                            << ", drives " << drive.value << ", parts " << parts.value
                            << ", balance " << balance.value << ", places " << place.value
                            << ", terms " << terms.value);
}

// A_eff u' + c + G_R u = Q, for joints with given forces.
BOOST_AUTO_TEST_CASE(obeys_its_matrices) {
  double worst = 0;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    BOOST_TEST_CONTEXT("seed = " << seed) {
      const RandomRotors random(seed);
      const BodySystem<FrozenGuide> a(random.guide, random.with, random.gravity);
      BodyWorkspace w = a.workspace();
      Eigen::VectorXd dv;
      a.accelerations(0, random.y, {}, dv, w);
      Eigen::VectorXd v = random.y.tail(dv.size());
      Eigen::VectorXd moved = Eigen::VectorXd::Ones(dv.size());
      for (int i = 0; i < a.body_count(); ++i) {
        const JointPlace p = a.tree().place(i);
        const JointRule rule = a.tree().body(i).rule;
        if (rule == JointRule::held) v.segment(p.v, p.v_count).setZero();
        if (rule != JointRule::forces) moved.segment(p.v, p.v_count).setZero();
      }
      const RotorMatrices m = rotor_matrices(a, 0, random.y, w);
      if (m.rates.empty()) continue;
      const Eigen::VectorXd u = v(m.rates);
      const Eigen::VectorXd inertia = m.A_eff * dv(m.rates);
      const Eigen::VectorXd gyroscopic = m.G_R * u;
      const Eigen::VectorXd rest = inertia + m.c + gyroscopic - m.Q;
      const double scale = 1 + inertia.norm() + m.c.norm() + gyroscopic.norm() + m.Q.norm();
      worst = test::worst_of(worst, rest.cwiseProduct(moved(m.rates)).norm() / scale);
    }
  }
  BOOST_TEST_MESSAGE("matrices: " << worst);
  BOOST_TEST(worst <= 1e-13);
}

// Dual numbers through rotors against those through ordinary bodies, and against differences.
BOOST_AUTO_TEST_CASE(is_linearized_by_dual_numbers) {
  using Dual = Eigen::AutoDiffScalar<Eigen::Matrix<double, 3, 1>>;
  using Duals = Eigen::Matrix<Dual, Eigen::Dynamic, 1>;
  double worst = 0;
  double apart = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    BOOST_TEST_CONTEXT("seed = " << seed) {
      RandomRotors random(seed);
      for (BodyDescription& b : random.with) b.loads.clear();
      for (BodyDescription& b : random.without) b.loads.clear();
      const BodySystem<FrozenGuide> a(random.guide, random.with, random.gravity);
      const BodySystem<FrozenGuide> b(random.guide, random.without, random.gravity);
      test::Sample sample(seed);
      Eigen::MatrixXd directions(random.y.size(), 3);
      for (double& x : directions.reshaped()) x = sample.uniform(-1, 1);
      Duals y(random.y.size());
      for (Eigen::Index i = 0; i < y.size(); ++i) {
        y[i] = Dual(random.y[i], directions.row(i).transpose());
      }
      const Duals f = a.rates(0, y);
      const Duals g = b.rates(0, y);
      const Eigen::VectorXd value = a.rates(0, random.y);
      for (int k = 0; k < 3; ++k) {
        const double h = 1e-5;
        const Eigen::VectorXd step = h * directions.col(k);
        const Eigen::VectorXd slope =
            (a.rates(0, random.y + step) - a.rates(0, random.y - step)) / (2 * h);
        const double size = slope.norm() + value.norm();
        Eigen::VectorXd found(y.size()), other(y.size());
        for (Eigen::Index i = 0; i < y.size(); ++i) {
          found[i] = f[i].derivatives()[k];
          other[i] = g[i].derivatives()[k];
          BOOST_TEST(std::abs(f[i].value() - value[i]) <= 1e-15 * size);
        }
        worst = test::worst_of(worst, (found - slope).norm() / size);
        apart = test::worst_of(apart, (found - other).norm() / size);
      }
    }
  }
  BOOST_TEST_MESSAGE("derivatives: " << apart << " from ordinary bodies', " << worst
                                     << " from differences");
  BOOST_TEST(apart <= 1e-12);
  BOOST_TEST(worst <= 1e-7);
}

BOOST_AUTO_TEST_CASE(refuses_unsupported_dual_numbers) {
  using Dual = Eigen::AutoDiffScalar<Eigen::Matrix<double, 1, 1>>;
  using Duals = Eigen::Matrix<Dual, Eigen::Dynamic, 1>;
  RandomRotors random(1);
  for (BodyDescription& b : random.with) b.loads.clear();
  const Duals y = random.y.cast<Dual>();
  const BodySystem<RestingFrame<>> resting({}, random.with);
  BOOST_TEST((resting.rates(Dual(0, 1, 0), y).size() == y.size()));
  random.with[0].loads.emplace_back(Attraction{{{0, 0, 1}}});
  const BodySystem<RestingFrame<>> loaded({}, random.with);
  BOOST_CHECK_THROW((void)loaded.rates(0, y), InvalidInput);
}

// The angle of a rotor affects nothing else, exactly.
BOOST_AUTO_TEST_CASE(does_not_depend_on_the_rotor_angle) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    BOOST_TEST_CONTEXT("seed = " << seed) {
      const RandomRotors random(seed);
      const BodySystem<FrozenGuide> a(random.guide, random.with, random.gravity);
      Eigen::VectorXd turned = random.y;
      for (int i = 0; i < a.body_count(); ++i) {
        if (a.tree().body(i).rotor) turned[a.tree().place(i).q] += 1e9;
      }
      BOOST_TEST((a.rates(0, random.y) == a.rates(0, turned)));
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
