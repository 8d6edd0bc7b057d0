#include <Eigen/Cholesky>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <tuple>
#include <utility>
#include <variant>

#include <dynamics/tree/accelerations.hpp>
#include <dynamics/tree/constraints.hpp>
#include <dynamics/tree/evaluation.hpp>
#include <dynamics/tree/loads.hpp>
#include <dynamics/tree/passes.hpp>
#include <motor/error.hpp>

namespace kreisel::detail {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

struct ConstraintSpace {
  std::vector<ConstraintRow<>> rows;
  std::vector<double> rates;
  std::vector<std::size_t> owner;  ///< of each row: its constraint
  MatrixXd directions;             ///< J^t
  MatrixXd responses;              ///< M^-1 J^t
  MatrixXd mass;                   ///< J M^-1 J^t
  MatrixXd scaled;
  VectorXd scale;
  Eigen::LLT<MatrixXd> factors;
  VectorXd right;
  VectorXd multipliers;
  VectorXd change;  ///< of the motion, and that of the coordinates
  VectorXd moved;
  std::vector<double> spin_up;
};

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

[[noreturn]] void refuse(const std::string& name, const std::string& why) {
  throw InvalidInput("constraint '" + name + "': " + why);
}

void check_numbers(const Constraint& constraint) {
  ConstraintNumbers numbers;
  std::visit([&numbers](const auto& kind) { kind.list(numbers); }, constraint.kind);
  for (const double x : numbers.all) {
    if (!std::isfinite(x)) refuse(constraint.name, "a number is not finite");
  }
  for (const auto& v : numbers.directions) {
    if (!(v.norm() > 0)) refuse(constraint.name, "an axis, a direction or an attitude is 0");
  }
  for (const double length : numbers.lengths) {
    if (!(length > 0)) refuse(constraint.name, "a length or a radius is not positive");
  }
}

/// The coordinate and the rate of a gear's joint.
JointPlace gear_joint(const BodyTree& tree, const Constraint& constraint, const std::string& body) {
  const JointPlace place = tree.place(tree.index(body));
  if (place.q_count == 1 && place.v_count == 1) return place;
  refuse(constraint.name, "the joint of '" + body + "' has not a single coordinate");
}

std::size_t link_of(const BodyTree& tree, const Constraint& constraint, const std::string& body) {
  if (body == "guide") return 0;
  const int index = tree.index(body);
  if (tree.body(index).rotor) {
    refuse(constraint.name, "'" + body + "' is a rotor: hold its carrier, or make it a body");
  }
  return tree.link(index);
}

/// The motion of a link relative to another, on that other one's axes. Needs the motions relative
/// to the guide in w.
SeenMotion<> seen(const ConstraintLink& link, const BodyWorkspace& w) {
  const auto& [x_1, V_1] = w.place[link.first];
  const auto& [x_2, V_2] = w.place[link.second];
  const LinkMotion<>& first = w.motion[link.first];
  const LinkMotion<>& second = w.motion[link.second];
  const Vector3<double>& u = V_1.resultant;
  const Vector3<double> d = x_2 - x_1;
  const Vector3<double> v = V_2.moment - V_1.moment - cross(u, d);
  const Vector3<double> dw = second.dw - first.dw - cross(u, V_2.resultant);
  const Vector3<double> a =
      second.a - first.a - cross(first.dw, d) - cross(u, cross(u, d)) - 2.0 * cross(u, v);
  const Matrix3<double> back = w.pose[link.first].R.transpose();
  return {back * w.pose[link.second].R,
          back * d,
          back * (V_2.resultant - u),
          back * v,
          back * dw,
          back * a};
}

/// The size of the two bodies: the greater of their radii of gyration about their origins, or
/// 1 m if they have no mass. Gaps are relative to it, too: all points may be the bodies' origins.
double size_of_bodies(const BodyTree& tree, const ConstraintLink& link) {
  double size = 0;
  for (const std::size_t i : {link.first, link.second}) {
    const Inertia<>& T = tree.links()[i].inertia;
    if (T.mass > 0) size = std::max(size, std::sqrt(trace(T.tensor) / (2 * T.mass)));
  }
  return size > 0 ? size : 1;
}

void set_rows(const BodyTree& tree, const double* q, const double* v, const double* dv,
              BodyWorkspace& w) {
  ConstraintSpace& c = *w.constraints;
  c.rows.clear();
  c.rates.clear();
  c.owner.clear();
  for (std::size_t i = 0; i < tree.constraints().size(); ++i) {
    const ConstraintLink& link = tree.constraints()[i];
    std::visit(
        [&]<class Kind>(const Kind& kind) {
          if constexpr (std::is_same_v<Kind, constraint::Gear>) {
            const auto gear = [&](const double* x, int first, int second) {
              return x[first] - kind.ratio * x[second];
            };
            c.rows.push_back({{},
                              gear(q, link.q_first, link.q_second) - kind.offset,
                              gear(dv, link.v_first, link.v_second),
                              std::abs(q[link.q_first]) + std::abs(kind.offset) + 1});
            c.rates.push_back(gear(v, link.v_first, link.v_second));
          } else {
            const SeenMotion<> m = seen(link, w);
            const double bodies = size_of_bodies(tree, link);
            kind.rows(m, [&](ConstraintRow<> row) {
              if (!row.direction.resultant.isZero(0)) row.size += bodies;
              c.rows.push_back(row);
              c.rates.push_back(row.rate(m));
            });
          }
        },
        link.constraint.kind);
    c.owner.resize(c.rows.size(), i);
  }
}

/// Adds a force of the first link on the second, given on the first's axes about its origin.
void add_between(const ConstraintLink& link, const Motor<>& P, BodyWorkspace& w) {
  const Matrix3<double>& R = w.pose[link.first].R;
  const Motor<> on_guide_axes{R * P.resultant, R * P.moment};
  const Vector3<double> d = w.place[link.second].x - w.place[link.first].x;
  w.force[link.second] += on_guide_axes.reduced_at(d);
  w.force[link.first] -= on_guide_axes;
}

/// The joint forces of a unit multiplier: the row of J.
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
}

/// Sets J, M^-1 J^t and J M^-1 J^t. Needs the rows set and the joints eliminated.
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

/// Solves  (J M^-1 J^t) x = b  for rows scaled to a diagonal of 1. Directions that are below 1e-6 of
/// the greatest follow from the others.
void solve_multipliers(const VectorXd& b, VectorXd& x, ConstraintSpace& c) {
  constexpr double least = 1e-12;
  c.scale = c.mass.diagonal().unaryExpr([](double d) { return d > 0 ? 1 / std::sqrt(d) : 0; });
  c.scaled = c.scale.asDiagonal() * c.mass * c.scale.asDiagonal();
  c.factors.compute(c.scaled);
  const bool regular = c.factors.info() == Eigen::Success &&
                       c.factors.matrixLLT().diagonal().cwiseAbs2().minCoeff() > least;
  x = c.scale.cwiseProduct(b);
  if (regular) {
    c.factors.solveInPlace(x);
  } else {
    Eigen::CompleteOrthogonalDecomposition<MatrixXd> general;
    general.setThreshold(least);
    general.compute(c.scaled);
    x = general.solve(x).eval();
  }
  x = c.scale.cwiseProduct(x);
}

/// Sets poses and motions relative to the guide, and the rows, for a state.
void set_state(const BodyTree& tree, const VectorXd& y, BodyWorkspace& w) {
  const double* v = y.data() + tree.coordinates();
  set_poses(tree, y.data(), w);
  set_motions(tree, LinkMotion<>{}, v, nullptr, w);
  set_places(tree, v, w);
  set_rows(tree, y.data(), v, w.still.data(), w);
}

/// The gap of a row relative to its size.
double relative_gap(const ConstraintRow<>& row) {
  return row.gap == 0 ? 0 : std::abs(row.gap) / row.size;
}

/// The greatest gap relative to its size, and its constraint.
std::pair<double, std::size_t> worst_gap(const ConstraintSpace& c) {
  std::pair<double, std::size_t> worst{0, 0};
  for (std::size_t k = 0; k < c.rows.size(); ++k) {
    const double gap = relative_gap(c.rows[k]);
    if (std::isnan(gap)) return {gap, c.owner[k]};
    if (gap > worst.first) worst = {gap, c.owner[k]};
  }
  return worst;
}

/// Moves the coordinates by the least change that closes the gaps to first order.
void close_gaps(const BodyTree& tree, VectorXd& y, ConstraintSpace& c) {
  c.right = VectorXd::NullaryExpr(static_cast<Index>(c.rows.size()), [&c](Index k) {
    return c.rows[static_cast<std::size_t>(k)].gap;
  });
  solve_multipliers(c.right, c.multipliers, c);
  c.change = -c.responses * c.multipliers;
  c.moved.resize(tree.coordinates());
  set_coordinate_rates(tree, y.data(), c.change.data(), c.moved.data());
  y.head(tree.coordinates()) += c.moved;
}

/// Changes the rates least so that they fulfil the conditions.
void close_rates(const BodyTree& tree, VectorXd& y, ConstraintSpace& c) {
  c.right = Eigen::Map<const VectorXd>(c.rates.data(), static_cast<Index>(c.rates.size()));
  solve_multipliers(c.right, c.multipliers, c);
  y.tail(tree.rates()) -= c.responses * c.multipliers;
}

std::string text(double x) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.3g", x);
  return buffer;
}

}  // namespace

ConstraintLink linked(const BodyTree& tree, const Constraint& constraint) {
  if (constraint.first == constraint.second) refuse(constraint.name, "it joins a body to itself");
  check_numbers(constraint);
  ConstraintLink link{constraint};
  link.first = link_of(tree, constraint, constraint.first);
  link.second = link_of(tree, constraint, constraint.second);
  if (link.is_gear()) {
    const JointPlace first = gear_joint(tree, constraint, constraint.first);
    const JointPlace second = gear_joint(tree, constraint, constraint.second);
    link.q_first = first.q;
    link.v_first = first.v;
    link.q_second = second.q;
    link.v_second = second.v;
  }
  return link;
}

void constrain(const BodyTree& tree, const double* q, const double* v, double* dv,
               BodyWorkspace& w) {
  ConstraintSpace& c = *w.constraints;
  set_motions(tree, LinkMotion<>{}, v, dv, w);
  set_places(tree, v, w);
  set_rows(tree, q, v, dv, w);
  set_directions(tree, w);
  c.right = VectorXd::NullaryExpr(static_cast<Index>(c.rows.size()), [&c](Index k) {
    return -c.rows[static_cast<std::size_t>(k)].acceleration;
  });
  solve_multipliers(c.right, c.multipliers, c);
  Eigen::Map<VectorXd>(dv, tree.rates()) += c.responses * c.multipliers;
}

void take_off_constraints(const BodyTree& tree, BodyWorkspace& w) {
  const ConstraintSpace& c = *w.constraints;
  for (std::size_t k = 0; k < c.rows.size(); ++k) {
    const double mu = c.multipliers[static_cast<Index>(k)];
    add_between(tree.constraints()[c.owner[k]], -mu * c.rows[k].direction, w);
  }
}

/// The reaction of a gear on the second joint's body, from its multiplier.
inline Motor<> gear_reaction(const BodyTree& tree, const ConstraintLink& link, double mu,
                             const BodyWorkspace& w) {
  const double force = -std::get<constraint::Gear>(link.constraint.kind).ratio * mu;
  const Vector3<double> along =
      force * (w.pose[link.first].R.transpose() * w.pose[link.second].axis);
  const Vector3<double> none = Vector3<double>::Zero();
  const bool turns = tree.links()[link.second].turns_by_angle();
  return turns ? Motor<>{none, along} : Motor<>{along, none};
}

std::vector<ConstraintReaction> constraint_reactions(const BodyTree& tree, BodyWorkspace& w) {
  const ConstraintSpace& c = *w.constraints;
  std::vector<ConstraintReaction> result;
  for (const ConstraintLink& link : tree.constraints()) {
    result.push_back({link.constraint.name, {}, Vector3<double>::Zero()});
  }
  for (std::size_t k = 0; k < c.rows.size(); ++k) {
    const ConstraintLink& link = tree.constraints()[c.owner[k]];
    const double mu = c.multipliers[static_cast<Index>(k)];
    result[c.owner[k]].on_second +=
        link.is_gear() ? gear_reaction(tree, link, mu, w) : mu * c.rows[k].direction;
  }
  for (std::size_t i = 0; i < result.size(); ++i) {
    const ConstraintLink& link = tree.constraints()[i];
    std::visit(
        [&]<class Kind>(const Kind& kind) {
          if constexpr (!std::is_same_v<Kind, constraint::Gear>) {
            const SeenMotion<> m = seen(link, w);
            result[i].at = kind.point_of_second(m);
            result[i].on_second = result[i].on_second.reduced_at(m.place(result[i].at));
          }
        },
        link.constraint.kind);
  }
  return result;
}

std::vector<ConstraintGap> constraint_gaps(const BodyTree& tree, const VectorXd& y,
                                           BodyWorkspace& w) {
  set_state(tree, y, w);
  const ConstraintSpace& c = *w.constraints;
  std::vector<ConstraintGap> result;
  for (const ConstraintLink& link : tree.constraints()) result.push_back({link.constraint.name});
  for (std::size_t k = 0; k < c.rows.size(); ++k) {
    ConstraintGap& gap = result[c.owner[k]];
    gap.position = std::max(gap.position, std::abs(c.rows[k].gap));
    gap.rate = std::max(gap.rate, std::abs(c.rates[k]));
    gap.relative = std::max(gap.relative, relative_gap(c.rows[k]));
  }
  return result;
}

void project_on_constraints(const BodyTree& tree, VectorXd& y, BodyWorkspace& w) {
  constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();
  constexpr double far = 1e-2;
  ConstraintSpace& c = *w.constraints;
  set_state(tree, y, w);
  eliminate_all(tree, w);
  set_directions(tree, w);
  double before = far;
  for (auto [worst, at] = worst_gap(c); worst > rounding; std::tie(worst, at) = worst_gap(c)) {
    if (!(worst < before)) {
      if (worst <= 64 * rounding) break;
      throw ComputationFailed("constraint '" + tree.constraints()[at].constraint.name +
                              "': off by " + text(worst) +
                              " of its size; the state is too far from its conditions, or at a "
                              "singular position");
    }
    before = worst / 2;
    close_gaps(tree, y, c);
    set_state(tree, y, w);
  }
  close_rates(tree, y, c);
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
      throw ComputationFailed("constraint '" + tree.constraints()[at].constraint.name +
                              "': no state near the start fulfils it; it stays open by " +
                              text(worst) + " of its size");
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
  constexpr double least = 1e-12;
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
    if (L(k, k) <= least * c.mass(k, k)) {
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
