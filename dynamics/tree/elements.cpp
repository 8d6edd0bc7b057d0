#include <algorithm>
#include <cmath>
#include <utility>

#include <dynamics/tree/elements.hpp>
#include <dynamics/tree/passes.hpp>

namespace kreisel::detail {

double element_energy(const BodyTree& tree, double t, const double* q, const MotionSpace<>& w) {
  double sum = 0;
  for (std::size_t k = 0; k < tree.elements().size(); ++k) {
    const ElementPlace& place = tree.element_places()[k];
    sum += std::visit(
        [&](const auto& kind) {
          if constexpr (joins_joints<std::decay_t<decltype(kind)>>) {
            return kind.potential(difference(kind, place.q, {true, true}, q));
          } else {
            return kind.potential(motion_between(kind.ends, place.slot, t, w));
          }
        },
        tree.elements()[k]);
  }
  return sum;
}

namespace {

/// The force of a coupling on its second body: along or about the axis of that body's joint.
Motor<> force_on_second(const BodyTree& tree, const CouplingElement& coupling,
                        const ElementPlace& place, const double* q, const double* v,
                        const MotionSpace<>& w) {
  const double force = -coupling.ratio * coupling_force(coupling, place, q, v);
  const Vector3<double> along =
      transposed_product(w.pose[place.slot[0]].R, w.pose[place.slot[1]].axis);
  const Vector3<double> zero = Vector3<double>::Zero();
  if (tree.body(place.body[1]).joint.kind == JointKind::prismatic) return {force * along, zero};
  return {zero, force * along};
}

}  // namespace

Vector3<double> second_point(const Element& element) {
  return std::visit(
      [](const auto& kind) -> Vector3<double> {
        if constexpr (joins_joints<std::decay_t<decltype(kind)>>) {
          return Vector3<double>::Zero();
        } else {
          return kind.ends[1].at;
        }
      },
      element);
}

void element_forces(const BodyTree& tree, double t, const double* q, const double* v,
                    const OutsideForces<double>* outside, const MotionSpace<>& w,
                    std::vector<Motor<>>& result) {
  result.resize(tree.elements().size());
  for (std::size_t k = 0; k < result.size(); ++k) {
    const ElementPlace& place = tree.element_places()[k];
    result[k] = std::visit(
        [&](const auto& kind) {
          if constexpr (joins_joints<std::decay_t<decltype(kind)>>) {
            return force_on_second(tree, kind, place, q, v, w);
          } else {
            return kind.force(motion_between(kind.ends, place.slot, t, w));
          }
        },
        tree.elements()[k]);
  }
  if (outside == nullptr) return;
  for (const auto& [k, paid_out] : outside->winches) {
    const auto index = static_cast<std::size_t>(k);
    const auto& rope = std::get<RopeElement>(tree.elements()[index]);
    const auto m = motion_between(rope.ends, tree.element_places()[index].slot, t, w);
    result[index] += winch_force(rope, m, paid_out);
  }
}

bool has_corners(const BodyTree& tree) {
  return std::any_of(tree.elements().begin(), tree.elements().end(), [](const Element& element) {
    const auto* const spring = std::get_if<SpringElement>(&element);
    return std::holds_alternative<RopeElement>(element) ||
           (spring != nullptr && spring->table.size() > 2);
  });
}

double corner_frequency(const BodyTree& tree) {
  double greatest = 0;
  for (const Element& element : tree.elements()) {
    const auto* const rope = std::get_if<RopeElement>(&element);
    if (rope != nullptr) greatest = std::max(greatest, rope->length.greatest_frequency());
  }
  return greatest;
}

namespace {

constexpr double rounding_of_corners = 1e-14;

/// The length of the k-th element, a rope, that its winch has paid out.
double paid_out(const OutsideForces<double>* outside, std::size_t k) {
  if (outside == nullptr) return 0;
  for (const auto& [rope, length] : outside->winches) {
    if (static_cast<std::size_t>(rope) == k) return length;
  }
  return 0;
}

}  // namespace

std::vector<Corner> element_corners(const BodyTree& tree, double t,
                                    const OutsideForces<double>* outside, const MotionSpace<>& w) {
  std::vector<Corner> result;
  for (std::size_t k = 0; k < tree.elements().size(); ++k) {
    const std::array<std::size_t, 2>& slot = tree.element_places()[k].slot;
    const auto add = [&](const auto& kind, double length, double length_rate) {
      const auto m = motion_between(kind.ends, slot, t, w);
      const double squared = m.reach.squaredNorm();
      const double in_time = -2 * length * length_rate;
      result.push_back({squared - length * length, 2 * m.reach.dot(m.velocity) + in_time, in_time,
                        rounding_of_corners * (squared + length * length)});
    };
    if (const auto* const rope = std::get_if<RopeElement>(&tree.elements()[k])) {
      add(*rope, rope->length(t) + paid_out(outside, k), rope->length.derivative(t, 1));
    } else if (const auto* const spring = std::get_if<SpringElement>(&tree.elements()[k])) {
      for (std::size_t i = 1; i + 1 < spring->table.size(); ++i) {
        add(*spring, spring->table[i].length, 0);
      }
    }
  }
  return result;
}

namespace {

Corner end_of_pull(const RopeElement& rope, double t, double paid_out,
                   const ElementMotion<AlongOne>& m) {
  const double rate = rope.length.derivative(t, 1);
  const double acceleration = rope.length.derivative(t, 2);
  const AlongOne squared = m.reach.squaredNorm();
  if (squared.value() == 0) return {};
  const AlongOne distance = sqrt(squared);
  const AlongOne length = with_rate(rope.length(t) + paid_out, rate);
  const AlongOne stretch = squared - length * distance;
  const AlongOne approach = m.reach.dot(m.velocity);
  const AlongOne pull = rope.stiffness * stretch +
                        rope.damping * (approach - distance * with_rate(rate, acceleration));
  const double L = distance.value();
  const double size = rope.stiffness * L * (L + length.value()) +
                      rope.damping * (std::abs(approach.value()) + L * std::abs(rate));
  return {pull.value(), pull.derivatives()[0],
          -L * (rope.stiffness * rate + rope.damping * acceleration), rounding_of_corners * size};
}

}  // namespace

bool has_damped_ropes(const BodyTree& tree) {
  return std::any_of(tree.elements().begin(), tree.elements().end(), [](const Element& element) {
    const auto* const rope = std::get_if<RopeElement>(&element);
    return rope != nullptr && rope->damping > 0;
  });
}

void append_ends_of_pull(const BodyTree& tree, double t, const OutsideForces<double>* outside,
                         const Eigen::VectorXd& y, const Eigen::VectorXd& dy,
                         std::vector<Corner>& result) {
  const Eigen::Matrix<AlongOne, Eigen::Dynamic, 1> along = y.binaryExpr(dy, &with_rate);
  MotionSpace<AlongOne> w(tree);
  set_poses(tree, along.data(), w);
  set_places(tree, along.data() + tree.coordinates(), w);
  for (std::size_t k = 0; k < tree.elements().size(); ++k) {
    const auto* const rope = std::get_if<RopeElement>(&tree.elements()[k]);
    if (rope == nullptr || !(rope->damping > 0)) continue;
    const auto m = motion_between(rope->ends, tree.element_places()[k].slot, with_rate(t, 1), w);
    result.push_back(end_of_pull(*rope, t, paid_out(outside, k), m));
  }
}

}  // namespace kreisel::detail
