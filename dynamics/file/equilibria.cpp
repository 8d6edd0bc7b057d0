#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <numbers>
#include <optional>
#include <utility>

#include <dynamics/decompositions.hpp>
#include <dynamics/file/equilibria.hpp>
#include <dynamics/file/steady_motions.hpp>
#include <dynamics/study/equilibrium.hpp>
#include <motor/error.hpp>

namespace kreisel {

using detail::Link;
using detail::LinkKind;
using Eigen::MatrixXd, Eigen::VectorXd;
using std::numbers::pi;

namespace steady_motion {

namespace {

/// True if a whole turn of the angle y[q] changes no rate. Springs, elements and controllers may
/// count turns.
bool is_periodic(const StudySystem& system, const VectorXd& y, int q) {
  const VectorXd here = system.rates(system.begin(), y);
  const auto change = [&](double turn) {
    VectorXd turned = y;
    turned[q] += turn;
    return (system.rates(system.begin(), turned) - here).cwiseAbs().maxCoeff();
  };
  return change(2 * pi) <= 1e-9 + 1e-6 * change(0.1);
}

/// Indices of the angles in which the system has the period 2 pi at a state.
std::vector<int> periodic_angles(const StudySystem& system, const VectorXd& y) {
  std::vector<int> places;
  for (const Link& link : system.tree().links()) {
    const bool turns = link.kind == LinkKind::revolute && link.moved_by_forces();
    if (turns && is_periodic(system, y, link.q)) places.push_back(link.q);
  }
  return places;
}

/// An element of Halton's sequence in a base, in (0, 1).
double halton(int index, int base) {
  double result = 0;
  double digit = 1;
  for (int rest = index + 1; rest > 0; rest /= base) {
    digit /= base;
    result += digit * (rest % base);
  }
  return result;
}

/// The states from which equilibria are searched.
class Starts {
 public:
  /// fixed : directions whose values are kept
  Starts(const StudySystem& system, VectorXd base, const Places& fixed)
      : base_(std::move(base)), choices_(1) {
    int dimension = 0;
    for (const Link& link : system.tree().links()) {
      if (!link.moved_by_forces() || fixed[static_cast<std::size_t>(link.v)]) continue;
      links_.push_back(&link);
      dimension += detail::rate_count(link.kind);
      choices_ = std::min(most_choices, choices_ * choices(link.kind));
    }
    const int most = std::max(16, 6000 / std::max(1, dimension * dimension));
    count_ = links_.empty() ? 1 : std::min(most, choices_ + 1 + random_starts);
    for (int n = 2; static_cast<int>(primes_.size()) < dimension; ++n) {
      const bool is_prime =
          std::none_of(primes_.begin(), primes_.end(), [n](int p) { return n % p == 0; });
      if (is_prime) primes_.push_back(n);
    }
  }

  [[nodiscard]] int count() const { return count_; }

  [[nodiscard]] VectorXd operator()(int k) const {
    if (k == 1 || links_.empty()) return base_;
    return k <= choices_ ? corner(k == 0 ? 0 : k - 1) : random(k - choices_ - 1);
  }

 private:
  static constexpr int most_choices = 64;
  static constexpr int random_starts = 24;

  static int choices(LinkKind kind) {
    if (kind == LinkKind::revolute) return 2;
    return detail::rate_count(kind) == 1 ? 1 : 4;
  }

  /// Angles of 0 or pi; attitudes rotated by pi about one of the axes, or not at all.
  [[nodiscard]] VectorXd corner(int number) const {
    VectorXd y = base_;
    for (const Link* const link : links_) {
      const int choice = number % choices(link->kind);
      number /= choices(link->kind);
      y.segment(link->q, detail::coordinate_count(link->kind)).setZero();
      if (link->kind == LinkKind::revolute) y[link->q] = choice * pi;
      if (choices(link->kind) == 4) y[link->q + (choice + 3) % 4] = 1;
    }
    return y;
  }

  [[nodiscard]] VectorXd random(int index) const {
    VectorXd y = base_;
    auto prime = primes_.begin();
    const auto next = [&] { return halton(index, *prime++); };
    const auto spread = [&](int q) { y[q] += (1 + std::abs(y[q])) * (2 * next() - 1); };
    for (const Link* const link : links_) {
      if (link->kind == LinkKind::revolute) y[link->q] = pi * (2 * next() - 1);
      if (choices(link->kind) == 1) spread(link->q);
      if (choices(link->kind) != 4) continue;
      // Uniform over all attitudes, after Shoemake.
      const double share = next();
      const double a = 2 * pi * next();
      const double b = 2 * pi * next();
      y.segment<4>(link->q) << std::sqrt(1 - share) * std::sin(a),
          std::sqrt(1 - share) * std::cos(a), std::sqrt(share) * std::sin(b),
          std::sqrt(share) * std::cos(b);
      for (int k = 4; link->kind == LinkKind::free && k < 7; ++k) spread(link->q + k);
    }
    return y;
  }

  VectorXd base_;
  std::vector<const Link*> links_;
  std::vector<int> primes_;
  int choices_;
  int count_ = 1;
};

/// Searches equilibria of a system and keeps distinct ones.
class Search {
 public:
  Search(const StudySystem& system, const VectorXd& start, double t_end)
      : system_(system),
        directions_(system),
        tangent_(tangent_of(system, start)),
        t_end_(t_end),
        base_(start) {
    const int q = system.tree().coordinates();
    for (int i = 0; i < directions_.rates; ++i) {
      const int rate = directions_.rates + i;
      if (!directions_.held[static_cast<std::size_t>(rate)]) base_[q + i] = 0;
    }
    base_ = detail::on_constraints(system, base_);
    const Places cyclic =
        directions_.cyclic(linearized(system, system.begin(), base_),
                           linearized(system, system.begin(), off(system, base_)));
    fixed_ = joined(directions_.held, cyclic);
    running_ = list(joined(directions_.running, cyclic));
  }

  Equilibria run() {
    const Starts starts(system_, base_, fixed_);
    found_.starts = starts.count();
    for (int k = 0; k < starts.count() && found_.list.size() < most_found; ++k) {
      const VectorXd guess = starts(k);
      refine(guess);
      descend(guess);
    }
    return std::move(found_);
  }

 private:
  static constexpr std::size_t most_found = 64;
  static constexpr double shares[] = {0.21, 0.5, 0.83};

  /// Keeps the equilibrium that Newton's method reaches, if any. Accelerations may be undetermined
  /// at a start.
  void refine(const VectorXd& guess) {
    try {
      const auto reached =
          find_equilibrium(system_, system_.begin(), guess,
                           {.held = list(fixed_), .running = running_, .most_iterations = 40});
      add(reached.state, reached.residual);
    } catch (const ComputationFailed&) {
      // Another start may converge.
    }
  }

  /// Descends along the accelerations, then refines the end by Newton's method.
  void descend(const VectorXd& guess) {
    std::optional<VectorXd> low;
    try {
      low = descended(guess);
    } catch (const ComputationFailed&) {
      // Another start may converge.
    }
    if (low) refine(*low);
  }

  /// The end of  dq/ds = q''(q), where q'' is the acceleration of a body released at rest. Implicit
  /// Euler steps grow as the acceleration falls: close to an equilibrium they are Newton's.
  [[nodiscard]] std::optional<VectorXd> descended(VectorXd y) const {
    y = detail::on_constraints(system_, y);
    double step = 0;
    double before = 0;
    for (int i = 0; i < 50; ++i) {
      const auto r = detail::reduced(system_, system_.begin(), y, tangent_, detail::InTime::no);
      const std::vector<int> free = searched(r.free);
      if (free.empty()) return std::nullopt;
      const VectorXd a = r.v.segment(directions_.rates, directions_.rates)(free);
      const double size = a.cwiseAbs().maxCoeff();
      if (!std::isfinite(size)) return std::nullopt;
      if (i == 0) {
        if (size == 0) return std::nullopt;
        step = 0.1 / size;
      } else {
        if (size <= 1e-9 * (1 + before)) return y;
        step *= std::clamp(before / size, 0.3, 5.0);
      }
      before = size;
      const MatrixXd J = r.A.middleRows(directions_.rates, directions_.rates)(free, free);
      const MatrixXd M = MatrixXd::Identity(J.rows(), J.cols()) / step - J;
      VectorXd move = detail::shortest_solution(M, a, 1e-15).x;
      move *= std::min(1.0, 1 / move.cwiseAbs().maxCoeff());
      y = moved(system_, y, r.free.complete(detail::scattered(tangent_.dimension(), free, move)));
    }
    return y;
  }

  void add(VectorXd state, double residual) {
    const Linearization there = linearized(system_, system_.begin(), state);
    const VectorXd& rate = there.rate;
    for (int i = 0; i < directions_.rates; ++i) {
      const bool runs = directions_.running[static_cast<std::size_t>(i)];
      if (!runs && std::abs(rate[i]) > 1e-9) return;
    }
    Equilibrium equilibrium{in_turns_of(system_, std::move(state), VectorXd::Zero(base_.size())),
                            residual};
    note_neutral(there, equilibrium);
    const auto is_same = [&](std::size_t k) {
      const Equilibrium& other = found_.list[k];
      if (distance(system_, other.state, equilibrium.state) <= 1e-6) return true;
      return other.neutral > 0 && other.neutral == equilibrium.neutral &&
             ((traces_[k] - traces(there.A)).cwiseAbs().maxCoeff() <= 1e-6 ||
              are_joined(other.state, equilibrium.state, there.A.norm()));
    };
    for (std::size_t k = 0; k < found_.list.size(); ++k) {
      if (is_same(k)) return;
    }
    if (!stays(system_, there, t_end_)) return;
    found_.list.push_back(std::move(equilibrium));
    traces_.push_back(traces(there.A));
  }

  /// The coordinates that are searched, as far as they are independent.
  [[nodiscard]] std::vector<int> searched(const FreeDirections& directions) const {
    std::vector<int> free;
    for (int i = 0; i < directions_.rates; ++i) {
      if (!directions.is_dependent(i) && !fixed_[static_cast<std::size_t>(i)]) free.push_back(i);
    }
    return free;
  }

  /// The directions in which a state of rest may lie beside another. They are the independent
  /// coordinates that are searched, and the memory of controllers.
  [[nodiscard]] std::vector<int> directions_of_rest(const FreeDirections& directions) const {
    std::vector<int> result = searched(directions);
    for (int i = 2 * directions_.rates; i < tangent_.dimension(); ++i) result.push_back(i);
    return result;
  }

  /// The numbers that vanish at rest: accelerations and the rates of the memory, in the order of
  /// these directions.
  [[nodiscard]] std::vector<int> of_rest(std::vector<int> directions) const {
    for (int& i : directions) {
      if (i < directions_.rates) i += directions_.rates;
    }
    return directions;
  }
  [[nodiscard]] VectorXd changes(const VectorXd& y) const {
    const VectorXd rate = tangent_.inverse(y) * system_.rates(system_.begin(), y);
    return rate(of_rest(directions_of_rest({})));
  }

  /// True if all states between two equilibria are equilibria.
  [[nodiscard]] bool are_joined(const VectorXd& from, const VectorXd& to, double norm) const {
    const VectorXd way = tangent_.between(from, in_turns_of(system_, to, from));
    return std::all_of(std::begin(shares), std::end(shares), [&](double share) {
      const auto y = detail::moved_or_none(system_, tangent_, from, VectorXd(share * way));
      return y && changes(*y).cwiseAbs().maxCoeff() <= 1e-9 * norm;
    });
  }

  /// Traces of powers of A / |A|: equal for matrices with the same eigenvalues.
  [[nodiscard]] static Eigen::Vector4d traces(const MatrixXd& A) {
    const double norm = A.norm();
    Eigen::Vector4d result = Eigen::Vector4d::Zero();
    if (norm == 0) return result;
    MatrixXd power = A / norm;
    for (int k = 0; k < 4; ++k) {
      result[k] = power.trace();
      power = power * A / norm;
    }
    return result;
  }

  /// Counts the directions in which the equilibrium is not isolated.
  void note_neutral(const Linearization& there, Equilibrium& equilibrium) const {
    const std::vector<int> free = directions_of_rest(there.free);
    const MatrixXd J = there.A(of_rest(free), free);
    if (J.size() == 0) return;
    const auto [values, U, V] = detail::singular_values(J);
    for (Eigen::Index k = 0; k < values.size(); ++k) {
      if (values[k] > 1e-9 * values[0]) continue;
      const double reach = 0.2;
      const VectorXd eta =
          detail::scattered(tangent_.dimension(), free, VectorXd(reach * V.col(k)));
      const auto near =
          detail::moved_or_none(system_, tangent_, equilibrium.state, there.free.complete(eta));
      const bool is_family =
          near && changes(*near).cwiseAbs().maxCoeff() <= 1e-8 * (1e-9 + reach * values[0]);
      equilibrium.neutral += is_family ? 1 : 0;
      equilibrium.degenerate = equilibrium.degenerate || !is_family;
    }
  }

  const StudySystem& system_;
  Directions directions_;
  Tangent tangent_;
  double t_end_;
  VectorXd base_;
  Places fixed_;
  std::vector<int> running_;
  Equilibria found_;
  std::vector<Eigen::Vector4d> traces_;
};

}  // namespace

Equilibria find_equilibria(const StudySystem& system, const VectorXd& start, double t_end) {
  return Search(system, start, t_end).run();
}

VectorXd in_turns_of(const StudySystem& system, VectorXd state, const VectorXd& other) {
  for (const int q : periodic_angles(system, state)) {
    state[q] -= 2 * pi * std::ceil((state[q] - other[q]) / (2 * pi) - 0.5);
  }
  return state;
}

double distance(const StudySystem& system, const VectorXd& a, const VectorXd& b) {
  const VectorXd near = in_turns_of(system, b, a);
  const VectorXd eta = tangent_of(system, a).between(a, near);
  return eta.head(system.tree().rates()).cwiseAbs().maxCoeff();
}

}  // namespace steady_motion

}  // namespace kreisel
