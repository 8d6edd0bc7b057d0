#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <type_traits>
#include <variant>
#include <vector>

#include <dynamics/tree/constraint/row.hpp>
#include <dynamics/tree/tree.hpp>
#include <dynamics/tree/workspace.hpp>

/// The conditions of all constraints of a tree, in double or in dual numbers.

namespace kreisel::detail {

/// The conditions of all constraints, one after another.
template <class S = double>
struct Conditions {
  std::vector<ConstraintRow<S>> rows;
  std::vector<S> rates;
  std::vector<std::size_t> owner;  ///< of each row: its constraint
};

/// The motion of a link relative to another, on that other one's axes. Needs the motions relative
/// to the guide in w.
template <class S>
[[nodiscard]] SeenMotion<S> seen(const ConstraintLink& link, const MotionSpace<S>& w) {
  const auto& [x_1, V_1] = w.place[link.first];
  const auto& [x_2, V_2] = w.place[link.second];
  const LinkMotion<S>& first = w.motion[link.first];
  const LinkMotion<S>& second = w.motion[link.second];
  const Vector3<S>& u = V_1.resultant;
  const Vector3<S> d = x_2 - x_1;
  const Vector3<S> turned = cross(u, d);
  const Vector3<S> v = V_2.moment - V_1.moment - turned;
  const Vector3<S> dw = second.dw - first.dw - cross(u, V_2.resultant);
  const Vector3<S> a =
      second.a - first.a - cross(first.dw, d) - cross(u, turned) - S(2) * cross(u, v);
  const Matrix3<S>& R = w.pose[link.first].R;
  SeenMotion<S> m;
  for (int k = 0; k < 3; ++k) {
    const Vector3<S> image = transposed_product(R, column(w.pose[link.second].R, k));
    for (int i = 0; i < 3; ++i) m.R(i, k) = image[i];
  }
  m.x = transposed_product(R, d);
  m.w = transposed_product(R, Vector3<S>(V_2.resultant - u));
  m.v = transposed_product(R, v);
  m.dw = transposed_product(R, dw);
  m.a = transposed_product(R, a);
  return m;
}

/// The size of the two bodies: the greater of their radii of gyration about their origins, or
/// 1 m if they have no mass. Gaps are relative to it, too: all points may be the bodies' origins.
[[nodiscard]] inline double size_of_bodies(const BodyTree& tree, const ConstraintLink& link) {
  double size = 0;
  for (const std::size_t i : {link.first, link.second}) {
    const Inertia<>& T = tree.links()[i].inertia;
    if (T.mass > 0) size = std::max(size, std::sqrt(trace(T.tensor) / (2 * T.mass)));
  }
  return size > 0 ? size : 1;
}

/// Lists the conditions at a state with the accelerations dv. Needs poses, positions and the motions
/// relative to the guide in w, for the same dv.
template <class S>
void list_conditions(const BodyTree& tree, const S* q, const S* v, const S* dv,
                     const MotionSpace<S>& w, Conditions<S>& c) {
  c.rows.clear();
  c.rates.clear();
  c.owner.clear();
  for (std::size_t i = 0; i < tree.constraints().size(); ++i) {
    const ConstraintLink& link = tree.constraints()[i];
    std::visit(
        [&]<class Kind>(const Kind& kind) {
          if constexpr (std::is_same_v<Kind, constraint::Gear>) {
            const auto gear = [&](const S* x, int first, int second) {
              return S(x[first] - kind.ratio * x[second]);
            };
            c.rows.push_back({{},
                              S(gear(q, link.q_first, link.q_second) - kind.offset),
                              gear(dv, link.v_first, link.v_second),
                              std::abs(number_in(q[link.q_first])) + std::abs(kind.offset) + 1});
            c.rates.push_back(gear(v, link.v_first, link.v_second));
          } else {
            const SeenMotion<S> m = seen(link, w);
            const double bodies = size_of_bodies(tree, link);
            kind.add_rows(m, c.rows);
            for (std::size_t k = c.rates.size(); k < c.rows.size(); ++k) {
              ConstraintRow<S>& row = c.rows[k];
              if (extent(row.direction.resultant) > 0) row.size += bodies;
              c.rates.push_back(row.rate(m));
            }
          }
        },
        link.constraint.kind);
    c.owner.resize(c.rows.size(), i);
  }
}

/// Adds a force of the first link on the second, given on the first's axes about its origin.
template <class S>
void add_between(const ConstraintLink& link, const Motor<S>& P, MotionSpace<S>& w) {
  const Matrix3<S>& R = w.pose[link.first].R;
  const Motor<S> on_guide_axes{R * P.resultant, R * P.moment};
  const Vector3<S> d = w.place[link.second].x - w.place[link.first].x;
  w.force[link.second] += on_guide_axes.reduced_at(d);
  w.force[link.first] -= on_guide_axes;
}

}  // namespace kreisel::detail
