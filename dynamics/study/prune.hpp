#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <iomanip>
#include <limits>
#include <ostream>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include <dynamics/model/structure.hpp>
#include <dynamics/solve/error_measure.hpp>
#include <dynamics/solve/solve_options.hpp>
#include <dynamics/step/explicit.hpp>
#include <dynamics/step/integrator.hpp>
#include <motor/error.hpp>

namespace kreisel {

/// Options of prune().
struct Pruning {
  double tolerance = 1e-6;                   ///< for the total effect of all dropped terms, as
                                             ///< RunReport::error_estimate
  double horizon = 0;                        ///< s
  double begin = 0;                          ///< s
  std::vector<double> discontinuities = {};  ///< as in SolveOptions
  double absolute_scale = 1e-3;              ///< as in SolveOptions
  double max_evaluations = 1e7;              ///< of either field in one run
};

/// A term of a scene that may be left out, and the effect of that.
struct PrunedTerm {
  std::string name;
  bool kept = true;
  double bound = 0;  ///< of the effect of dropping this term alone
  std::string why = {};
};

/// A scene, one of these types, from which terms are dropped.
template <class... Scenes>
struct Pruned {
  std::variant<Scenes...> scene;
  std::vector<PrunedTerm> terms;
  double bound = 0;        ///< of the total effect of all dropped terms
  double evaluations = 0;  ///< of fields, for the bounds
};

inline std::ostream& operator<<(std::ostream& out, const std::vector<PrunedTerm>& terms) {
  std::size_t width = 0;
  for (const PrunedTerm& term : terms) width = std::max(width, term.name.size());
  const std::ios_base::fmtflags before = out.flags();
  const std::streamsize digits = out.precision(1);
  out << std::left << std::scientific;
  for (const PrunedTerm& term : terms) {
    out << std::setw(static_cast<int>(width) + 2) << term.name
        << (term.kept ? "kept     " : "dropped  ") << term.bound;
    if (!term.why.empty()) out << "  " << term.why;
    out << '\n';
  }
  out.precision(digits);
  out.flags(before);
  return out;
}

namespace detail {

/// Deviation of a scene's motions from its exact ones, from one start, if terms are left out.
template <class Scene>
class PruningEffect {
  using Vector = typename Scene::Vector;
  static constexpr int n = int(Vector::RowsAtCompileTime);
  using Pair = Eigen::Matrix<double, 2 * n, 1>;

 public:
  PruningEffect(const Scene& scene, const typename Scene::State& start, const Pruning& options)
      : scene_(scene), options_(options), start_(scene.to_vector(start)), scale_(start_) {
    for (const auto& blocks : {blocks_of(scene), blocks_of(scene)}) {
      blocks_.insert(blocks_.end(), blocks.begin(), blocks.end());
    }
    // The sizes at the start are needed to find the greatest sizes on the way.
    scale_ = sizes_with(start_);
    Vector greatest = scale_;
    Steps steps = started(nullptr, rough);
    while (steps.t() != end()) {
      steps.step_towards(end());
      greatest = greatest.cwiseMax(sizes_with(scene_part(steps.y())));
    }
    evaluations_ += steps.effort().evaluations;
    scale_ = greatest;
  }

  /// Rates: of the scene with a term left out.
  [[nodiscard]] double bound(const std::function<Vector(double, const Vector&)>& rates) {
    const Run fine = run(rates, exact);
    const Run coarse = run(rates, rough);
    ErrorMeasure<Scene> distance(scene_, options_.absolute_scale);
    double off = 0;
    for (std::size_t i = 0; i < fine.states.size(); ++i) {
      const Vector& x = fine.states[i];
      off = max_or_nan(off, distance(x + coarse.deviations[i], x + fine.deviations[i]));
    }
    return caution * fine.worst + 2 * off +
           error_of_pair(0, rules::times_finer, rounding, fine.steps).sum();
  }

  [[nodiscard]] double evaluations() const { return evaluations_; }

 private:
  using Rates = std::function<Vector(double, const Vector&)>;

  static constexpr double exact = 1e-7;
  static constexpr double rough = 1e-5;
  static constexpr double caution = 1.3;
  static constexpr double rounding = 16;
  static constexpr int samples = 32;

  /// x and (y - x)/resolution, relative to their sizes.
  struct Field {
    const PruningEffect* effect;
    const Rates* rates;  ///< null: y is left alone

    Pair operator()(double t, const Pair& both) const {
      const Vector x = effect->scene_part(both);
      const Vector dx = effect->scene_.rates(t, x);
      Pair rate = Pair::Zero();
      rate.template head<n>() = dx.cwiseQuotient(effect->scale_);
      if (rates != nullptr) {
        const Vector dy = (*rates)(t, x + effect->deviation(both));
        rate.template tail<n>() = (dy - dx).cwiseQuotient(effect->scale_) / effect->resolution();
      }
      return rate;
    }
  };
  using Steps = ExplicitRungeKutta<Pair, Field>;

  struct Run {
    std::vector<Vector> states = {};
    std::vector<Vector> deviations = {};
    double worst = 0;
    double steps = 0;
  };

  [[nodiscard]] double end() const { return options_.begin + options_.horizon; }

  /// The finest resolution of a deviation; a finer one would be lost in rounding.
  [[nodiscard]] double resolution() const { return std::max(options_.tolerance, 1e-7); }

  [[nodiscard]] Vector scene_part(const Pair& both) const {
    return both.template head<n>().cwiseProduct(scale_);
  }
  [[nodiscard]] Vector deviation(const Pair& both) const {
    return resolution() * both.template tail<n>().cwiseProduct(scale_);
  }

  /// The size of the block of each component.
  [[nodiscard]] Vector sizes_with(const Vector& y) const {
    Vector sizes;
    int begin = 0;
    for (const int components : blocks_of(scene_)) {
      const double size = std::max(norm(y, begin, components), options_.absolute_scale);
      for (int i = begin; i < begin + components; ++i) sizes[i] = size;
      begin += components;
    }
    return sizes;
  }

  [[nodiscard]] Steps started(const Rates* rates, double accuracy) const {
    Pair both = Pair::Zero();
    both.template head<n>() = start_.cwiseQuotient(scale_);
    Steps steps({this, rates}, options_.begin, both, {accuracy, 1, options_.max_evaluations},
                blocks_);
    steps.stop_at(options_.discontinuities);
    return steps;
  }

  [[nodiscard]] Run run(const Rates& rates, double accuracy) {
    Run result;
    ErrorMeasure<Scene> distance(scene_, options_.absolute_scale);
    const auto note = [&](const Pair& both) {
      const Vector x = scene_part(both);
      result.worst = max_or_nan(result.worst, distance(x + deviation(both), x));
    };
    Steps steps = started(&rates, accuracy);
    note(steps.y());
    // Closer at the beginning: motions that start from 0 soon reach their size.
    const auto sample = [&] {
      const auto part = static_cast<double>(result.states.size() + 1) / samples;
      return part < 1 ? options_.begin + options_.horizon * part * part : end();
    };
    while (steps.t() != end()) {
      steps.step_towards(end());
      while (result.states.size() < samples && steps.covers(sample())) {
        const Pair both = steps.at(sample());
        note(both);
        result.states.push_back(scene_part(both));
        result.deviations.push_back(deviation(both));
      }
      note(steps.y());
    }
    result.steps = steps.effort().steps;
    evaluations_ += 2 * steps.effort().evaluations;
    return result;
  }

  const Scene& scene_;
  const Pruning& options_;
  Vector start_;
  Vector scale_;
  std::vector<int> blocks_;
  double evaluations_ = 0;
};

template <class Scene, class Quantity>
inline constexpr bool is_droppable = requires(const Scene& scene) {
  scene.without(Quantity{}, 0.0, 0.0);
};

template <class Scene, class Quantity>
[[nodiscard]] auto without(const Scene& scene, const Pruning& options) {
  return scene.without(Quantity{}, options.begin, options.begin + options.horizon);
}

template <class... Kinds>
struct SceneKinds {
  using Result = Pruned<Kinds...>;
  using Scene = std::variant<Kinds...>;
};

template <class... Kinds, class Next>
[[nodiscard]] auto operator|(SceneKinds<Kinds...> all, SceneKinds<Next> /*next*/) {
  if constexpr ((std::is_same_v<Kinds, Next> || ...)) {
    return all;
  } else {
    return SceneKinds<Kinds..., Next>{};
  }
}

template <class Quantity, class Kind>
[[nodiscard]] auto kind_without() {
  if constexpr (is_droppable<Kind, Quantity>) {
    return SceneKinds<decltype(std::declval<const Kind&>().without(Quantity{}, 0.0, 0.0))>{};
  } else {
    return SceneKinds<Kind>{};
  }
}

template <class... Kinds>
[[nodiscard]] auto with_all_left_out(SceneKinds<Kinds...> all) {
  return all;
}
/// The possible scene types if any of the quantities are left out.
template <class Quantity, class... Rest, class... Kinds>
[[nodiscard]] auto with_all_left_out(SceneKinds<Kinds...> all) {
  return with_all_left_out<Rest...>((all | ... | kind_without<Quantity, Kinds>()));
}

/// Chooses among the quantities, in turn.
template <class Scene, class... Quantities>
class Pruner {
  using Kinds = decltype(with_all_left_out<Quantities...>(SceneKinds<Scene>{}));
  using AnyKind = typename Kinds::Scene;
  using Chosen = std::array<bool, sizeof...(Quantities)>;

 public:
  Pruner(const Scene& scene, const std::vector<typename Scene::State>& starts,
         const Pruning& options)
      : scene_(scene), options_(options) {
    effects_.reserve(starts.size());
    for (const auto& start : starts) effects_.emplace_back(scene, start, options);
  }

  [[nodiscard]] typename Kinds::Result result() {
    (consider<Quantities>(), ...);
    double evaluations = 0;
    for (const auto& effect : effects_) evaluations += effect.evaluations();
    return {reduced<0, Scene, Quantities...>(scene_), terms_, together_, evaluations};
  }

 private:
  template <class Reduced>
  [[nodiscard]] double bound(const Reduced& scene) {
    double worst = 0;
    for (auto& effect : effects_) {
      const double found = effect.bound([&scene](double t, const typename Scene::Vector& y) ->
                                        typename Scene::Vector { return scene.rates(t, y); });
      // A NaN is no bound.
      worst = found <= worst ? worst : std::isnan(found) ? infinite : found;
    }
    return worst;
  }

  template <class Quantity>
  void consider() {
    const std::size_t index = next_++;
    if constexpr (is_droppable<Scene, Quantity>) {
      const auto is_there = [](const auto& kind) {
        return is_droppable<std::decay_t<decltype(kind)>, Quantity>;
      };
      PrunedTerm term{Quantity::name, true, infinite};
      if (!std::visit(is_there, reduced<0, Scene, Quantities...>(scene_))) {
        term = {Quantity::name, false, 0, "dropped with a term above"};
      } else {
        try {
          term.bound = bound(without<Scene, Quantity>(scene_, options_));
          term.kept = !fits(index, term.bound);
        } catch (const Error& error) {
          term.why = error.what();
        }
      }
      terms_.push_back(term);
    }
  }

  /// Drops a term if the tolerance allows it. Two bounds must fit: the sum of its own and those of
  /// the others, and the bound of all together. Effects add up only as far as they are linear.
  [[nodiscard]] bool fits(std::size_t index, double alone) {
    if (!(sum_ + alone <= options_.tolerance)) return false;
    chosen_.at(index) = true;
    const double together = sum_ > 0 ? bound_together() : alone;
    chosen_.at(index) = together <= options_.tolerance;
    if (!chosen_.at(index)) return false;
    sum_ += alone;
    together_ = together;
    return true;
  }

  [[nodiscard]] double bound_together() {
    return std::visit([this](const auto& kind) { return this->bound(kind); },
                      reduced<0, Scene, Quantities...>(scene_));
  }

  template <std::size_t index, class Kind>
  [[nodiscard]] AnyKind reduced(const Kind& scene) const {
    return AnyKind(std::in_place_type<Kind>, scene);
  }
  template <std::size_t index, class Kind, class Quantity, class... Rest>
  [[nodiscard]] AnyKind reduced(const Kind& scene) const {
    if constexpr (is_droppable<Kind, Quantity>) {
      if (chosen_[index]) {
        const auto less = without<Kind, Quantity>(scene, options_);
        return reduced<index + 1, std::decay_t<decltype(less)>, Rest...>(less);
      }
    }
    return reduced<index + 1, Kind, Rest...>(scene);
  }

  static constexpr double infinite = std::numeric_limits<double>::infinity();

  const Scene& scene_;
  const Pruning& options_;
  std::vector<PruningEffect<Scene>> effects_;
  std::vector<PrunedTerm> terms_;
  Chosen chosen_{};
  std::size_t next_ = 0;
  double sum_ = 0;  ///< of the bounds of dropped terms
  double together_ = 0;
};

inline void check(const Pruning& options) {
  if (!(options.horizon >= 0 && std::isfinite(options.horizon))) {
    refuse_task("pruning: horizon = ", options.horizon, " s must be finite, 0 or above");
  }
  check(SolveOptions{.begin = options.begin,
                     .output_times = {options.begin + options.horizon},
                     .discontinuities = options.discontinuities,
                     .tolerance = options.tolerance,
                     .absolute_scale = options.absolute_scale,
                     .max_evaluations = options.max_evaluations});
}

template <class... Quantities>
struct PrunedQuantities {
  template <class Scene>
  [[nodiscard]] static auto of(const Scene& scene, const std::vector<typename Scene::State>& starts,
                               const Pruning& options) {
    check(options);
    if (starts.empty()) refuse_task("pruning: at least one start must be given");
    return Pruner<Scene, Quantities...>(scene, starts, options).result();
  }
};

}  // namespace detail

/// Drops those terms of a scene whose total effect stays below a tolerance, over a time and for the
/// given starts.
///
///   const auto pruned = prune(gyro, start, {.tolerance = 1e-6, .horizon = 60});
///   std::cout << pruned.terms;
///   const auto run = std::visit(
///       [&](const auto& scene) { return solve(scene, start, {.output_times = {60}}); }, pruned.scene);
///
/// Without Quantities it tries, in this order, those of the following that the scene offers. They
/// are GuideRate, GuideUnsteadiness, RotorAsymmetry, ProductsOfInertia, CentrifugalForce and
/// RingInertia. Named ones, prune<ProductsOfInertia, LoadOf<ViscousDrag<>>>(..), are tried alone.
///
/// Let x be the motion of the scene, x' = f(t, x), and y that of the scene with a term left out, y'
/// = f(t, y) - d(t, y). The deviation z = y - x is not computed as a difference of two
/// integrations. It has an equation of its own, exact for any size of z, integrated together with
/// x:
///
///   z' = f(t, x + z) - d(t, x + z) - f(t, x),   z(begin) = 0
///
/// Steps resolve z relative to its own size, so that they may be coarse for small z too. They are
/// held to 1e-7 and, for a second result, to 1e-5. Let |..| be the measure of
/// RunReport::error_estimate: attitudes in radian, other parts relative to their greatest size so
/// far. Then
///
///   bound = 1.3 max |z| + 2 max |z - z of the coarser steps| + rounding
///
/// over the ends of steps and 32 times. A term is dropped while the sum of these bounds stays below
/// the tolerance. If there are several, the bound of all together must stay below the tolerance
/// too.
///
/// Scene  : FixedPointBody, FreeBody, CardanGyro; or a scene for Integrator that also has
///          without(Quantity, begin, end) -> a scene of the same State
/// Units  : radian, second; parts of the state that are no attitudes: relative
/// Error  : measured, not proved: true effect / bound is <= 0.83 in 1050 random scenes and for 1165
///          terms left out, tolerances of 1e-9 to 1e-2, and above 0.1 in 703 of 709
///          (tests/dynamics/study/prune.cpp). It holds for the motions that are given, not for
///          others; for an ensemble give its outermost ones
/// Cost   : two runs of both fields for each term, and two more for each combination of terms.
///          In 4 scenes fields became 1.7 to 4.8 times as fast, runs of solve() 1.4 to 3 times; the
///          bounds cost 3 to 9 such runs and are paid for after 5 to 27: this is for ensembles and
///          repeated runs, never for one (benchmarks/prune_gain.cpp). RingInertia spares nothing: a
///          gyro adds the moments of its rings to the rotor's when it is built, and is of one type
///          with and without; it shows the rings' effect. The steps are explicit:
///          stiff scenes take long
/// Throws : InvalidInput for a tolerance outside [1e-15, 1e-2], a horizon below 0, no starts;
///          ComputationFailed where the scene's own motion fails. A term without which it fails, or
///          cannot be made, is kept, with the reason
template <class... Quantities, class Scene>
[[nodiscard]] auto prune(const Scene& scene, const std::vector<typename Scene::State>& starts,
                         const Pruning& options) {
  using Chosen =
      std::conditional_t<sizeof...(Quantities) == 0,
                         detail::PrunedQuantities<GuideRate, GuideUnsteadiness, RotorAsymmetry,
                                                  ProductsOfInertia, CentrifugalForce, RingInertia>,
                         detail::PrunedQuantities<Quantities...>>;
  static_assert((detail::is_droppable<Scene, Quantities> && ...),
                "the scene does not have one of the named terms");
  return Chosen::of(scene, starts, options);
}

/// The same for one motion.
template <class... Quantities, class Scene>
[[nodiscard]] auto prune(const Scene& scene, const typename Scene::State& start,
                         const Pruning& options) {
  return prune<Quantities...>(scene, std::vector{start}, options);
}

}  // namespace kreisel
