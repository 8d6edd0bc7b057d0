#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <memory>

#include <dynamics/tree/constraint/space.hpp>
#include <dynamics/tree/evaluation.hpp>
#include <dynamics/tree/passes.hpp>

namespace kreisel::detail {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

ConstraintMemory::ConstraintMemory() = default;
ConstraintMemory::ConstraintMemory(const ConstraintMemory& other)
    : space_(other.space_ ? std::make_unique<ConstraintSpace>(*other.space_) : nullptr) {}
ConstraintMemory::ConstraintMemory(ConstraintMemory&& other) noexcept = default;
ConstraintMemory& ConstraintMemory::operator=(const ConstraintMemory& other) {
  return *this = ConstraintMemory(other);
}
ConstraintMemory& ConstraintMemory::operator=(ConstraintMemory&& other) noexcept = default;
ConstraintMemory::~ConstraintMemory() = default;

ConstraintSpace& ConstraintMemory::operator*() {
  if (!space_) space_ = std::make_unique<ConstraintSpace>();
  return *space_;
}

namespace {

/// A row of J below this part of its lengths is rounding. The joints alone fulfil its condition, as
/// with a second hinge on the axis of the first.
constexpr double rounding_of_row = 1e-13;

/// The joint forces of a unit multiplier: the row of J, or 0 if the condition follows from the
/// joints.
void set_direction(const BodyTree& tree, const ConstraintLink& link, const ConstraintRow<>& row,
                   Eigen::Ref<VectorXd> result, BodyWorkspace& w) {
  result.setZero();
  if (const auto* gear = std::get_if<constraint::Gear>(&link.constraint.kind)) {
    result[link.v_first] = 1;
    result[link.v_second] = -gear->ratio;
    return;
  }
  std::fill(w.force.begin(), w.force.end(), Motor<>{});
  add_between(link, row.direction, w);
  sum_inwards(tree, w);
  project(tree, w, result.data());
  const double size = std::max(row.size, 1.0);
  if ((result.array().abs() <= rounding_of_row * size).all()) result.setZero();
}

/// The greatest mobility of a constraint's conditions of the same kind as condition k, of positions or
/// of rotations.
double greatest_mobility(const ConstraintSpace& c, std::size_t k) {
  const auto turns = [&c](std::size_t i) { return c.rows[i].direction.resultant.isZero(0); };
  double greatest = 0;
  for (std::size_t i = 0; i < c.rows.size(); ++i) {
    if (c.owner[i] != c.owner[k] || turns(i) != turns(k)) continue;
    greatest = std::max(greatest, c.mass(static_cast<Index>(i), static_cast<Index>(i)));
  }
  return greatest;
}

/// Sets the scale of each condition, the same for all of one constraint and kind. A condition that
/// follows from the others except for small parts must not weigh as much as they do.
void set_scales(ConstraintSpace& c) {
  c.scale.resize(c.mass.rows());
  for (Index k = 0; k < c.scale.size(); ++k) {
    const double mobility = greatest_mobility(c, static_cast<std::size_t>(k));
    c.scale[k] = mobility > 0 ? 1 / std::sqrt(mobility) : 0;
  }
}

}  // namespace

void set_directions(const BodyTree& tree, BodyWorkspace& w) {
  ConstraintSpace& c = *w.constraints;
  const auto m = static_cast<Index>(c.rows.size());
  c.directions.resize(tree.rates(), m);
  c.responses.resize(tree.rates(), m);
  c.spin_up = w.spin_up;
  for (Index k = 0; k < m; ++k) {
    const auto row = static_cast<std::size_t>(k);
    set_direction(tree, tree.constraints()[c.owner[row]], c.rows[row], c.directions.col(k), w);
    respond(tree, c.directions.col(k).data(), c.responses.col(k).data(), w);
  }
  w.spin_up = c.spin_up;
  c.mass = c.directions.transpose() * c.responses;
}

void solve_multipliers(const VectorXd& b, VectorXd& x, ConstraintSpace& c) {
  set_scales(c);
  c.scaled = c.scale.asDiagonal() * c.mass * c.scale.asDiagonal();
  c.factors.compute(c.scaled);
  c.pivot = c.factors.info() == Eigen::Success
                ? c.factors.matrixLLT().diagonal().cwiseAbs2().minCoeff()
                : 0;
  x = c.scale.cwiseProduct(b);
  if (c.pivot > redundant_below) {
    c.factors.solveInPlace(x);
  } else {
    Eigen::CompleteOrthogonalDecomposition<MatrixXd> general;
    general.setThreshold(redundant_below);
    general.compute(c.scaled);
    x = general.solve(x).eval();
    const Index rank = general.rank();
    const auto pivots = general.matrixQTZ().diagonal().cwiseAbs();
    c.pivot = rank > 0 ? pivots[rank - 1] / pivots[0] : 1;
  }
  x = c.scale.cwiseProduct(x);
}

double independence(const ConstraintSpace& c) {
  // A condition that moves nothing at all follows from the joints.
  constexpr double none = 1e-13;
  double least = c.pivot;
  for (std::size_t k = 0; k < c.rows.size(); ++k) {
    const double greatest = greatest_mobility(c, k);
    const double own = c.mass(static_cast<Index>(k), static_cast<Index>(k));
    if (own > none * greatest) least = std::min(least, own / greatest);
  }
  return least;
}

}  // namespace kreisel::detail
