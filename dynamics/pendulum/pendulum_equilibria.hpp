#pragma once

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include <dynamics/pendulum/pendulum.hpp>

namespace kreisel {

/// An angle at which the pendulum can rest in the guide.
template <class S = double>
struct Equilibrium {
  S angle;          ///< in (-pi, pi]
  S stiffness;      ///< d moment/d phi there  [N m]
  bool stable;      ///< the moment goes from - to +
  bool degenerate;  ///< stiffness 0 to rounding: equilibria have merged here (bifurcation)
};

namespace detail {

/// The root of a function in a bracket, by Newton's method. Bisection replaces a Newton step that
/// leaves the bracket or is longer than half the step before.
///
/// look  : for x, whether the root lies below x, and the point of the next Newton step
/// least : accepted length of a step beyond the rounding of x
template <class S, class Look>
[[nodiscard]] S root_in_bracket(S low, S high, S x, const S& least, const Look& look) {
  using std::abs;
  constexpr int most_steps = 2 * std::numeric_limits<S>::digits + 100;
  S last_step = std::numeric_limits<S>::max();
  for (int i = 0; i < most_steps; ++i) {
    const auto [below, newton] = look(x);
    (below ? high : low) = x;
    const S half = (low + high) / S(2);
    const bool good = newton >= low && newton <= high && abs(S(newton - x)) <= last_step / S(2);
    const S next = good ? newton : half;
    last_step = abs(S(next - x));
    x = next;
    if (last_step <= least + std::numeric_limits<S>::epsilon() * abs(x)) break;
  }
  return x;
}

/// Isolates and polishes the roots of  m(x) = E sin x + F cos x + H cos 2x + K sin 2x  on one turn.
///
/// Recursive bisection of [start - 2 pi, start]. A piece of half-width r about x is dropped if
/// Taylor's remainder bound proves |m| > 0 on it. It is monotone if the bound proves |m'| > 0; the
/// signs at its ends then decide. A piece that is undecided at r = sqrt(epsilon), or is 0 to
/// rounding everywhere, is a cluster: a bifurcation point, examined by its ends and its extremum.
template <class S>
class EquilibriumOptions {
 public:
  explicit EquilibriumOptions(const PendulumCoefficients<S>& c) : c_(c), e_(c.e()) {
    using std::abs, std::acos, std::sqrt;
    pi_ = acos(S(-1));
    const S size = abs(e_) + abs(c.f) + abs(c.h) + abs(c.k);
    if (!(size > S(0)) || !(size <= std::numeric_limits<S>::max())) {
      throw InvalidInput(size == S(0)
                             ? "every angle is an equilibrium: E, F, H and K are all 0"
                             : "the coefficients E, F, H, K of the pendulum must be finite");
    }
    noise_ = S(8) * std::numeric_limits<S>::epsilon() * size;
    fourth_ = abs(e_) + abs(c.f) + S(16) * (abs(c.h) + abs(c.k));
    floor_ = sqrt(std::numeric_limits<S>::epsilon());
    if constexpr (is_wide) {
      coarse_.emplace(PendulumCoefficients<double>{double(c.weight), double(c.delta_e), double(c.f),
                                                   double(c.h), double(c.k)});
    }
  }

  [[nodiscard]] std::vector<Equilibrium<S>> run() {
    using std::abs;
    // At most four roots: of five points at least one is no root. Cut the circle where |m| is
    // largest.
    S start(0);
    S largest(-1);
    for (int i = 0; i < 5; ++i) {
      const S x = S(0.9) + S(0.55) * S(i);
      const S size = abs(moment(x));
      if (size > largest) {
        largest = size;
        start = x;
      }
    }
    bisect(start - S(2) * pi_, start);
    flush_cluster();
    return merged();
  }

 private:
  /// A root in [low, high], where the moment is monotone; or undecided, and then degenerate.
  struct Root {
    S x, low, high;
    bool degenerate;
  };

  struct Jet {
    S m, d1, d2, d3;
  };

  /// The result of a bound on a piece of the circle; level: 0 to rounding, or too short for a proof.
  enum class Piece { without_root, monotone, undecided, level };

  /// With more digits than double the same in double isolates most roots, and begins to polish.
  static constexpr bool is_wide =
      std::numeric_limits<S>::digits > std::numeric_limits<double>::digits;
  template <class>
  friend class EquilibriumOptions;

  [[nodiscard]] Jet jet(const S& x) const {
    using std::cos, std::sin;
    const S s = sin(x);
    const S c = cos(x);
    const S c2 = (c - s) * (c + s);
    const S s2 = S(2) * s * c;
    const S single = e_ * s + c_.f * c;
    const S single_rate = e_ * c - c_.f * s;
    const S twice = c_.h * c2 + c_.k * s2;
    const S twice_rate = S(2) * (c_.k * c2 - c_.h * s2);
    return {single + twice, single_rate + twice_rate, -single - S(4) * twice,
            -single_rate - S(4) * twice_rate};
  }

  /// The moment. Near 0 and pi the difference of F and H decides, so F and H are combined first.
  /// Elsewhere each term is as small as its cosine.
  [[nodiscard]] S moment(const S& x) const {
    using std::abs, std::cos, std::sin;
    const S s = sin(x);
    const S c = cos(x);
    return e_ * s + S(2) * c_.k * s * c + (abs(s) < S(0.25) ? level(s, c) : steep(s, c));
  }

  /// F cos x + H cos 2x
  [[nodiscard]] S steep(const S& s, const S& c) const {
    return c_.f * c + c_.h * ((c - s) * (c + s));
  }
  [[nodiscard]] S level(const S& s, const S& c) const {
    const S s_squared = s * s;
    const S at_zero = c > S(0) ? S((c_.f + c_.h) - c_.f * s_squared / (S(1) + c))
                               : S((c_.h - c_.f) + c_.f * s_squared / (S(1) - c));
    return at_zero - S(2) * c_.h * s_squared;
  }

  [[nodiscard]] bool positive(const S& x) const { return moment(x) >= S(0); }

  /// The piece of half-width r about x.
  [[nodiscard]] Piece piece(const S& x, const S& r) const {
    using std::abs;
    if constexpr (is_wide) {
      const auto found = coarse_->piece(double(x), double(r));
      if (found != EquilibriumOptions<double>::Piece::level) return Piece(int(found));
    }
    const Jet at = jet(x);
    const S third = abs(at.d3) + fourth_ * r / S(3);
    const S swing = r * (abs(at.d1) + r * (abs(at.d2) / S(2) + r * third / S(6)));
    if (abs(at.m) > swing + noise_) return Piece::without_root;
    if (abs(at.d1) > r * (abs(at.d2) + r * third / S(2)) + S(4) * noise_) return Piece::monotone;
    return r <= floor_ || abs(at.m) + swing <= noise_ ? Piece::level : Piece::undecided;
  }

  void bisect(const S& low, const S& high) {
    const S x = (low + high) / S(2);
    switch (piece(x, S((high - low) / S(2)))) {
      case Piece::without_root: return flush_cluster();
      case Piece::monotone:
        flush_cluster();
        if (positive(low) != positive(high)) found_.push_back({solve(low, high), low, high, false});
        return;
      case Piece::level:
        if (!in_cluster_) cluster_low_ = low;
        in_cluster_ = true;
        cluster_high_ = high;
        return;
      case Piece::undecided: bisect(low, x); bisect(x, high);
    }
  }

  void flush_cluster() {
    using std::abs;
    if (!in_cluster_) return;
    in_cluster_ = false;
    const S low = cluster_low_;
    const S high = cluster_high_;
    if (positive(low) != positive(high)) {
      found_.push_back({solve(low, high), low, high, true});
      return;
    }
    const S x = extremum(low, high);
    if (abs(moment(x)) <= noise_) {
      found_.push_back({x, low, high, true});
    } else if (positive(x) != positive(low)) {
      found_.push_back({solve(low, x), low, x, false});
      found_.push_back({solve(x, high), x, high, false});
    }
  }

  /// The point between two near points at which the slope of the moment vanishes.
  [[nodiscard]] S extremum(const S& low, const S& high) const {
    S x = (low + high) / S(2);
    for (int i = 0; i < 50; ++i) {
      const Jet at = jet(x);
      if (at.d2 == S(0)) break;
      const S next = std::clamp(S(x - at.d1 / at.d2), low, high);
      if (next == x) break;
      x = next;
    }
    return x;
  }

  /// The roots, with those joined between which the moment is 0 to rounding. The signs beyond the
  /// ends of a group decide its kind.
  [[nodiscard]] std::vector<Equilibrium<S>> merged() const {
    using std::abs;
    std::vector<Equilibrium<S>> result;
    for (auto first = found_.begin(); first != found_.end();) {
      auto last = first;
      auto next = std::next(last);
      while (next != found_.end() && next->x - last->x < S(0.1) &&
             abs(moment(extremum(last->x, next->x))) <= noise_) {
        last = next++;
      }
      const bool degenerate = first->degenerate || last != first;
      const bool stable = !positive(first->low) && positive(last->high);
      S angle = last != first ? S((first->x + last->x) / S(2)) : first->x;
      if (angle <= -pi_) {
        angle += S(2) * pi_;
        if (!degenerate) angle = std::min(S(angle - moment(angle) / jet(angle).d1), pi_);
      }
      result.push_back({angle, jet(angle).d1, stable, degenerate});
      first = next;
    }
    std::sort(result.begin(), result.end(),
              [](const auto& a, const auto& b) { return a.angle < b.angle; });
    return result;
  }

  /// The root in a bracket, with full relative accuracy for a root near 0.
  [[nodiscard]] S solve(const S& low, const S& high) const {
    if (c_.f + c_.h == S(0) && low <= S(0) && S(0) <= high) return S(0);
    if (c_.f == c_.h && low <= -pi_ && -pi_ <= high) return -pi_;
    const bool rising = positive(high);
    S start = (low + high) / S(2);
    if constexpr (is_wide) {
      start = std::clamp(S(coarse_->solve(double(low), double(high))), low, high);
    }
    return root_in_bracket(low, high, start, S(0), [&](const S& x) {
      const S m = moment(x);
      return std::pair((m >= S(0)) == rising, S(x - m / jet(x).d1));
    });
  }

  PendulumCoefficients<S> c_;
  std::conditional_t<is_wide, std::optional<EquilibriumOptions<double>>, StaticZero> coarse_;
  S e_;
  S pi_, noise_, fourth_, floor_;
  bool in_cluster_ = false;
  S cluster_low_, cluster_high_;
  std::vector<Root> found_;  // ascending
};

}  // namespace detail

/// All equilibria of a steady pendulum, in ascending order: the roots of
///
///   E sin(phi) + F cos(phi) + H cos(2 phi) + K sin(2 phi) = 0   on (-pi, pi],  two to four.
///
/// The list is complete: every piece of the circle is excluded or proved monotone by a bound, not
/// by sampling. A merged pair is reported once, degenerate and unstable. Three merged into one are
/// degenerate and as stable as the moment's change of sign.
///
/// Source : paper 002 (23) at rest
/// Error  : <= 4u (|angle| + (|E sin phi| + |F cos phi| + |H cos 2phi| + |K sin 2phi|)/stiffness),
///          measured 1.6u: an equilibrium of 1e-10 rad has all its digits, unless F + H cancels
/// Cost   : 1 us (double, two roots, 2.5 GHz Xeon)
/// Throws : InvalidInput when E, F, H, K are all 0, or not finite
template <class S>
[[nodiscard]] std::vector<Equilibrium<S>> equilibria(const PendulumCoefficients<S>& c) {
  return detail::EquilibriumOptions<S>(c).run();
}

/// The stable equilibrium nearest 0; of two equally near (to 16u) the positive one.
///
/// Throws : ComputationFailed when none of them is stable (never for a list made by equilibria())
template <class S>
[[nodiscard]] Equilibrium<S> nearest_stable(const std::vector<Equilibrium<S>>& list) {
  using std::abs;
  const Equilibrium<S>* best = nullptr;
  for (const Equilibrium<S>& candidate : list) {
    if (!candidate.stable) continue;
    const S allowance = S(8) * std::numeric_limits<S>::epsilon() * abs(candidate.angle);
    if (best == nullptr || abs(candidate.angle) <= abs(best->angle) + allowance) best = &candidate;
  }
  if (best == nullptr) throw ComputationFailed("the pendulum has no stable equilibrium");
  return *best;
}

}  // namespace kreisel
