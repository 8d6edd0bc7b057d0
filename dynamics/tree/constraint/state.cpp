#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <tuple>
#include <utility>

#include <dynamics/tree/accelerations.hpp>
#include <dynamics/tree/constraint/singular.hpp>
#include <dynamics/tree/constraint/state.hpp>
#include <dynamics/tree/constraints.hpp>
#include <dynamics/tree/loads.hpp>
#include <dynamics/tree/passes.hpp>
#include <motor/error.hpp>

/// States and their constraints: gaps, projection, assembly, redundancy.

namespace kreisel::detail {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// The gap of a row relative to its size.
double relative_gap(const ConstraintRow<>& row) {
  return row.gap == 0 ? 0 : std::abs(row.gap) / row.size;
}

}  // namespace

void set_state(const BodyTree& tree, const VectorXd& y, BodyWorkspace& w) {
  const double* v = y.data() + tree.coordinates();
  set_poses(tree, y.data(), w);
  set_motions(tree, LinkMotion<>{}, v, nullptr, w);
  set_places(tree, v, w);
  list_conditions(tree, y.data(), v, static_cast<const double*>(w.still.data()), w, *w.constraints);
}

std::pair<double, std::size_t> worst_gap(const ConstraintSpace& c) {
  std::pair<double, std::size_t> worst{0, 0};
  for (std::size_t k = 0; k < c.rows.size(); ++k) {
    const double gap = relative_gap(c.rows[k]);
    if (std::isnan(gap)) return {gap, c.owner[k]};
    if (gap > worst.first) worst = {gap, c.owner[k]};
  }
  return worst;
}

void list_gaps(ConstraintSpace& c) {
  c.right = VectorXd::NullaryExpr(static_cast<Index>(c.rows.size()), [&c](Index k) {
    return c.rows[static_cast<std::size_t>(k)].gap;
  });
}

void move_coordinates(const BodyTree& tree, VectorXd& y, ConstraintSpace& c) {
  c.moved.resize(tree.coordinates());
  set_coordinate_rates(tree, y.data(), c.change.data(), c.moved.data());
  y.head(tree.coordinates()) += c.moved;
}

void close_rates(const BodyTree& tree, VectorXd& y, ConstraintSpace& c) {
  c.right = Eigen::Map<const VectorXd>(c.rates.data(), static_cast<Index>(c.rates.size()));
  solve_multipliers(c.right, c.multipliers, c);
  y.tail(tree.rates()) -= c.responses * c.multipliers;
}

namespace {

/// Moves the coordinates by the least change that closes the gaps to first order.
void close_gaps(const BodyTree& tree, VectorXd& y, ConstraintSpace& c) {
  list_gaps(c);
  solve_multipliers(c.right, c.multipliers, c);
  c.change = -c.responses * c.multipliers;
  move_coordinates(tree, y, c);
}

/// Refuses a state in which a constraint stays open by this part of its size.
[[noreturn]] void refuse_open(const BodyTree& tree, std::size_t constraint, double open,
                              const std::string& why) {
  char part[32];
  std::snprintf(part, sizeof part, "%.3g", open);
  throw ComputationFailed("constraint '" + tree.constraints()[constraint].constraint.name + "': " +
                          (std::isnan(open) ? "it has no direction here: its points coincide, or "
                                              "its wheel lies flat on the plane"
                                            : why + "; it is open by " + part + " of its size"));
}

}  // namespace

std::vector<ConstraintGap> constraint_gaps(const BodyTree& tree, const VectorXd& y,
                                           BodyWorkspace& w) {
  set_state(tree, y, w);
  const ConstraintSpace& c = *w.constraints;
  std::vector<ConstraintGap> result;
  for (const ConstraintLink& link : tree.constraints()) result.push_back({link.constraint.name});
  const auto grow = [](double& greatest, double size) {
    if (std::isnan(size) || size > greatest) greatest = size;
  };
  for (std::size_t k = 0; k < c.rows.size(); ++k) {
    ConstraintGap& gap = result[c.owner[k]];
    grow(gap.position, std::abs(c.rows[k].gap));
    grow(gap.rate, std::abs(c.rates[k]));
    grow(gap.relative, relative_gap(c.rows[k]));
  }
  return result;
}

void project_on_directions(const BodyTree& tree, VectorXd& y, BodyWorkspace& w) {
  constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();
  constexpr double far = 1e-2;
  ConstraintSpace& c = *w.constraints;
  set_state(tree, y, w);
  eliminate_all(tree, w);
  set_directions(tree, w);
  double before = far;
  for (auto [worst, at] = worst_gap(c); !(worst <= rounding); std::tie(worst, at) = worst_gap(c)) {
    if (!(worst < before)) {
      if (worst <= 64 * rounding) break;
      refuse_open(tree, at, worst,
                  "the state is too far from its conditions, or at a singular position");
    }
    before = worst / 2;
    close_gaps(tree, y, c);
    set_state(tree, y, w);
  }
  close_rates(tree, y, c);
}

void project_on_constraints(const BodyTree& tree, VectorXd& y, BodyWorkspace& w) {
  project_on_directions(tree, y, w);
  const auto itself = [](const VectorXd& state) -> const VectorXd& { return state; };
  if (const auto found = interpolated_near_singular(tree, y, w, itself)) y = *found;
}

VectorXd assembled(const BodyTree& tree, VectorXd y, BodyWorkspace& w) {
  constexpr int most = 100;
  ConstraintSpace& c = *w.constraints;
  for (int i = 0;; ++i) {
    set_state(tree, y, w);
    eliminate_all(tree, w);
    set_directions(tree, w);
    const auto [worst, at] = worst_gap(c);
    if (worst <= 64 * std::numeric_limits<double>::epsilon()) break;
    if (i == most || !std::isfinite(worst)) {
      refuse_open(tree, at, worst, "no state near the start fulfils it");
    }
    close_gaps(tree, y, c);
  }
  close_rates(tree, y, c);
  for (const Link& link : tree.links()) {
    if (coordinate_count(link.kind) >= 4) y.segment<4>(link.q).normalize();
  }
  return y;
}

std::vector<RedundantConstraint> redundant_constraints(const BodyTree& tree, const VectorXd& y,
                                                       BodyWorkspace& w) {
  ConstraintSpace& c = *w.constraints;
  set_state(tree, y, w);
  eliminate_all(tree, w);
  set_directions(tree, w);
  std::vector<RedundantConstraint> all;
  for (const ConstraintLink& link : tree.constraints()) all.push_back({link.constraint.name, 0, 0});
  // Cholesky's decomposition, row by row: what is left of a row's diagonal is new in it.
  MatrixXd L = c.mass;
  for (Index k = 0; k < L.rows(); ++k) {
    RedundantConstraint& own = all[c.owner[static_cast<std::size_t>(k)]];
    own.conditions += 1;
    if (L(k, k) <= redundant_below * c.mass(k, k)) {
      own.redundant += 1;
      continue;
    }
    for (Index i = k + 1; i < L.rows(); ++i) {
      const double part = L(i, k) / L(k, k);
      L.row(i).tail(L.cols() - k) -= part * L.row(k).tail(L.cols() - k);
    }
  }
  std::erase_if(all, [](const RedundantConstraint& one) { return one.redundant == 0; });
  return all;
}

}  // namespace kreisel::detail
