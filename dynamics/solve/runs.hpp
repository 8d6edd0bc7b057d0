#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <utility>

#include <dynamics/decompositions.hpp>
#include <dynamics/scene/euler_top.hpp>
#include <dynamics/solve/adaptive_runs.hpp>
#include <dynamics/solve/task.hpp>
#include <dynamics/step/advance.hpp>
#include <dynamics/step/gauss.hpp>
#include <dynamics/step/jacobian.hpp>
#include <dynamics/step/radau.hpp>
#include <dynamics/step/splitting.hpp>
#include <dynamics/step/taylor.hpp>

/// The integrators as solve() sees them: each a kind of run that has one setting, an accuracy or a
/// step, which can be made finer by ten or thirty times in the error.
///
/// A kind is made from (task), one of fixed steps from (scene, task, start), and has
///   first()               the setting to begin with
///   finer(x)              of the run beside
///   between(x, part)      of more runs, where rounding is all that is left: other steps than of both
///   tightened(x, ratio)   a setting whose error is `ratio` < 1 of this one's
///   finest(), last(x)     the setting beyond which rounding leaves nothing to gain; whether x is it
///   falls(x, y)           what the error of steps at y is of that at x
///   may_be_rounding(x)    whether what steps at x err by, after others that erred by too much, may be
///                         rounding that has grown
///   begins_near_rounding  whether the first setting errs by little more than rounding
///   rounding              of one step where nothing grows, in units of 2^-53
///   finer_by(x)           how many times finer that is
///   goes_on(x)            whether the finer run may become the coarser one of the next pair
///   digits_lost(x, n)     what rounding in n steps does to the state, in units of its last digit: a
///                         random walk; 0 where the method errs by more
///   run(x, scene, start)  with on_the_way(t, end) -> State and effort(); and pass(bookmark), where it
///                         can go on from what it has noted there
namespace kreisel::detail {

/// The Jacobian of a scene's field: exact, where the field takes dual numbers.
template <class Scene>
[[nodiscard]] auto jacobian_of(const Scene& scene) {
  constexpr int n = int(Scene::Vector::RowsAtCompileTime);
  if constexpr (n == Eigen::Dynamic) {
    return difference_jacobian<n>(SceneField<Scene>{&scene});
  } else {
    using Dual = Eigen::AutoDiffScalar<Eigen::Matrix<double, n + 1, 1>>;
    using DualVector = Eigen::Matrix<Dual, n, 1>;
    if constexpr (requires(const Dual& t, const DualVector& y) { scene.rates(t, y); }) {
      return forward_jacobian<n>(SceneField<Scene>{&scene});
    } else {
      return difference_jacobian<n>(SceneField<Scene>{&scene});
    }
  }
}

/// What is fastest in a field: its eigenvalue of the greatest modulus; 0 where the Jacobian is not
/// finite, for whether a field is stiff cannot end a run that goes on without knowing.
template <class Scene>
[[nodiscard]] std::complex<double> fastest_rate(const Scene& scene, double t,
                                                const typename Scene::State& state) {
  const Eigen::MatrixXd J = jacobian_of(scene)(t, scene.to_vector(state)).of_state;
  if (!J.allFinite()) return 0;
  const Eigen::VectorXcd rates = eigenvalues(J);
  int fastest = 0;
  for (int i = 1; i < int(rates.size()); ++i) {
    if (std::abs(rates[i]) > std::abs(rates[fastest])) fastest = i;
  }
  return rates[fastest];
}

template <class Scene>
class VernerRuns : public AdaptiveRuns {
 public:
  using AdaptiveRuns::AdaptiveRuns;

  static constexpr Method method = Method::verner98;
  static constexpr double rounding = 2.5;

  class Run {
   public:
    Run(const Scene& scene, const Task& task, const typename Scene::State& start,
        const Accuracy& accuracy)
        : scene_(scene),
          // Where radau13 may not take over there is no need to look; and it cannot, where its
          // factorisations would outweigh everything.
          looks_(task.method == Method::automatic && scene.to_vector(start).size() <= 200),
          steps_(scene, task.begin, start, accuracy) {
      steps_.stop_at(task.jumps);
    }

    /// The state at t; or that at an earlier time, where the field proved stiff.
    [[nodiscard]] typename Scene::State on_the_way(double t, double end) {
      while (!steps_.covers(t)) {
        steps_.step_towards(end);
        if (looks_ && proves_stiff(end)) return steps_.state();
      }
      return steps_.at(t);
    }

    [[nodiscard]] bool stiff() const { return stiff_; }
    [[nodiscard]] const Effort& effort() const { return steps_.effort(); }
    [[nodiscard]] double noise() const { return steps_.noise(); }

    template <class Bookmark>
    void pass(Bookmark& bookmark) {
      bookmark(looks_, steps_);
    }

   private:
    /// Whether it is stability that keeps the steps short, or, looked at once, something that is
    /// damped away soon. What is fast and not damped has to be resolved by any method.
    [[nodiscard]] bool proves_stiff(double end) {
      constexpr double soon = 1e-3;  // of the time left
      const bool looks_early = steps_.effort().steps == 50;
      if (!looks_early && !steps_.stiff()) return false;
      const std::complex<double> rate = fastest_rate(scene_, steps_.t(), steps_.state());
      const double speed = std::abs(rate);
      const bool dies_soon =
          rate.real() < -0.5 * speed && speed * std::abs(end - steps_.t()) > 1 / soon;
      stiff_ = dies_soon || (steps_.stiff() && rate.real() < -0.05 * speed);
      looks_ = !stiff_ && looks_early;
      return stiff_;
    }

    const Scene& scene_;
    bool looks_;
    bool stiff_ = false;
    Advance<Scene> steps_;
  };

  [[nodiscard]] Run run(double setting, const Scene& scene,
                        const typename Scene::State& start) const {
    return {scene, task(), start, accuracy(setting)};
  }
};

/// A run of adaptive steps.
template <class Scene, class Steps>
struct AdaptiveRun {
  const Scene* scene;
  Steps steps;

  [[nodiscard]] typename Scene::State on_the_way(double t, double end) {
    while (!steps.covers(t)) steps.step_towards(end);
    return scene->from_vector(steps.at(t));
  }
  [[nodiscard]] const Effort& effort() const { return steps.effort(); }
  [[nodiscard]] double noise() const requires requires { steps.noise(); }
  { return steps.noise(); }

  template <class Bookmark>
  void pass(Bookmark& bookmark) {
    bookmark(steps);
  }
};

template <class Scene>
inline constexpr bool knows_series = requires(const Scene& scene) {
  scene.series();
};

template <class Scene>
class TaylorRuns : public AdaptiveRuns {
  using Steps =
      TaylorSteps<typename Scene::Vector, decltype(std::declval<const Scene&>().series())>;

 public:
  /// To go down to 1e-18 costs a tenth more than 4e-16, and over 1e5 s errs by up to 200 times less.
  explicit TaylorRuns(const Task& task) : AdaptiveRuns(task, times_finer, 1e-18) {}

  static constexpr Method method = Method::taylor;
  static constexpr double rounding = 2.5;

  /// Longer steps round more.
  [[nodiscard]] static double digits_lost(double accuracy, double steps) {
    return 2.5 * AdaptiveRuns::digits_lost(accuracy, steps);
  }

  /// Finer than of the others: a tenth more of steps, where a second try would double them.
  [[nodiscard]] double first() const { return allowed(AdaptiveRuns::first() / 3); }

  using Run = AdaptiveRun<Scene, Steps>;

  [[nodiscard]] Run run(double setting, const Scene& scene,
                        const typename Scene::State& start) const {
    Run r{&scene, Steps(scene.series(), task().begin, scene.to_vector(start), accuracy(setting),
                        blocks_of(scene))};
    r.steps.stop_at(task().jumps);
    return r;
  }
};

template <class Scene>
class RadauRuns : public AdaptiveRuns {
  using Field = SceneField<Scene>;
  using J = decltype(jacobian_of(std::declval<const Scene&>()));
  using Steps = RadauSteps<typename Scene::Vector, Field, J>;

 public:
  explicit RadauRuns(const Task& task) : AdaptiveRuns(task, times_finer, 4e-16) {}

  static constexpr Method method = Method::radau13;
  static constexpr double rounding = 24;  // where Newton's iterations stop, and of stiff springs

  [[nodiscard]] static double digits_lost(double accuracy, double steps) {
    return 4 * AdaptiveRuns::digits_lost(accuracy, steps);
  }

  /// To finer tolerances a third run would tell ten times too great an error of stiff bearings.
  [[nodiscard]] bool may_be_rounding(double accuracy) const {
    return digits_off(task()) > 0 && AdaptiveRuns::may_be_rounding(accuracy);
  }

  using Run = AdaptiveRun<Scene, Steps>;

  [[nodiscard]] Run run(double setting, const Scene& scene,
                        const typename Scene::State& start) const {
    Run r{&scene, Steps(Field{&scene}, jacobian_of(scene), task().begin, scene.to_vector(start),
                        accuracy(setting), blocks_of(scene))};
    r.steps.stop_at(task().jumps);
    return r;
  }
};

/// The length of equal steps, all of which end at the output times.
struct EqualLength {
  double longest;

  /// Of the run beside which this one goes on, with at least one step more between any two outputs:
  /// else the two would be the same, and tell nothing of their error.
  double beside = std::numeric_limits<double>::infinity();

  template <class Bookmark>
  void pass(Bookmark& bookmark) {
    bookmark(longest, beside);
  }

  [[nodiscard]] double over(double interval) const {
    return std::min(longest, interval / (std::ceil(interval / beside) + 1));
  }
};

/// The settings of fixed steps of a method of the order given: their length.
class FixedRuns {
 public:
  static constexpr bool begins_near_rounding = false;

  FixedRuns(int order, double first, double shortest)
      : root_(1.0 / order), first_{first}, shortest_(shortest) {}

  [[nodiscard]] EqualLength first() const { return first_; }
  [[nodiscard]] EqualLength finer(const EqualLength& step) const {
    return {step.longest * std::pow(times_finer, -root_), step.longest};
  }
  [[nodiscard]] EqualLength between(const EqualLength& step, double part) const {
    return {step.longest * std::pow(times_finer, -root_ * part), step.longest};
  }

  /// Where the shortest steps still err, it is by rounding or by a jump that nobody declared: neither
  /// falls with the method's order.
  [[nodiscard]] double finer_by(const EqualLength& step) const {
    return last(step) ? 2 : times_finer;
  }

  [[nodiscard]] static bool goes_on(const EqualLength& /*step*/) { return false; }
  [[nodiscard]] static double digits_lost(const EqualLength& /*step*/, double steps) {
    return 0.02 * std::sqrt(steps);
  }
  [[nodiscard]] EqualLength finest() const { return {shortest_}; }
  [[nodiscard]] static bool may_be_rounding(const EqualLength& /*step*/) { return false; }
  [[nodiscard]] bool last(const EqualLength& step) const { return step.longest <= shortest_; }
  [[nodiscard]] double falls(const EqualLength& from, const EqualLength& to) const {
    return std::pow(to.longest / from.longest, 1 / root_);
  }
  [[nodiscard]] EqualLength tightened(const EqualLength& step, double ratio) const {
    return {std::max(step.longest * std::clamp(std::pow(ratio, root_), 0.2, 0.9), shortest_)};
  }

 protected:
  template <class Steps>
  static void advance(Steps& steps, const EqualLength& step, double t) {
    if (t == steps.t()) return;
    steps.take_steps_of(step.over(std::abs(t - steps.t())));
    steps.advance_to(t);
  }

 private:
  double root_;
  EqualLength first_;
  double shortest_;
};

/// The mean of 20 steps of Verner98 at accuracy 1e-14, once they have stopped to grow.
template <class Scene>
[[nodiscard]] double pace(const Scene& scene, const Task& task,
                          const typename Scene::State& start) {
  ExplicitSteps<typename Scene::Vector, SceneField<Scene>> steps(
      {&scene}, task.begin, scene.to_vector(start), {1e-14, task.smallest}, blocks_of(scene));
  const double end = task.times.back();
  const auto go = [&] {
    const double from = steps.t();
    const double before = steps.effort().steps;
    for (int i = 0; i < 20 && steps.t() != end; ++i) steps.step_towards(end);
    const double taken = steps.effort().steps - before;
    return taken > 0 ? std::abs(steps.t() - from) / taken : 0;
  };
  double pace = go();
  for (int i = 0; i < 30; ++i) {
    const double next = go();
    if (next < 1.2 * pace) break;
    pace = next;
  }
  return std::max(pace, std::numeric_limits<double>::min());
}

template <class Scene>
class GaussRuns : public FixedRuns {
  using Field = SceneField<Scene>;

 public:
  GaussRuns(const Scene& scene, const Task& task, const typename Scene::State& start)
      : GaussRuns(task, pace(scene, task, start)) {}

  static constexpr Method method = Method::gauss16;
  static constexpr double rounding = 2.5;
  static constexpr bool begins_near_rounding = true;

  struct Run {
    const Scene* scene;
    EqualLength length;
    GaussSteps<typename Scene::Vector, Field> steps;

    [[nodiscard]] typename Scene::State on_the_way(double t, double /*end*/) {
      advance(steps, length, t);
      return scene->from_vector(steps.y());
    }
    [[nodiscard]] const Effort& effort() const { return steps.effort(); }
    [[nodiscard]] double noise() const { return steps.noise(); }

    template <class Bookmark>
    void pass(Bookmark& bookmark) {
      bookmark(steps);
    }
  };

  [[nodiscard]] Run run(const EqualLength& length, const Scene& scene,
                        const typename Scene::State& start) const {
    Run r{&scene,
          length,
          {Field{&scene}, task_.begin, scene.to_vector(start), length.longest, blocks_of(scene),
           task_.smallest}};
    r.steps.give_up_after(task_.most_evaluations);
    return r;
  }

 private:
  // 16 Gauss points carry about twice as far as Verner98's stages do at 1e-14.
  GaussRuns(const Task& task, double pace) : FixedRuns(16, 2 * pace, pace / 2), task_(task) {}

  const Task& task_;
};

/// Whether splitting applies to a scene: a symmetric top under weight.
[[nodiscard]] inline bool splits(const EulerTop& top) {
  return top.moments().x() == top.moments().y() && !top.weight_moment().isZero(0) &&
         top.rotor_momentum().isZero(0);
}

/// Whether it pays: the spin commands the weight.
///
/// The weight's part of the nutation is  A k / L^2.
[[nodiscard]] inline bool is_fast(const EulerTop& top, const EulerTop::State& start) {
  const double L = top.moments().cwiseProduct(start.angular_velocity).norm();
  return L * L > 1000 * top.moments().x() * top.weight_moment().norm();
}

class SplittingRuns : public FixedRuns {
  struct Weight {
    const EulerTop* top;

    [[nodiscard]] Vector3<double> operator()(double /*t*/, const Eigen::Quaterniond& q) const {
      return top->weight_torque(q);
    }
  };

 public:
  SplittingRuns(const EulerTop& top, const Task& task, const EulerTop::State& start)
      : SplittingRuns(task, fastest_rate(top, start)) {}

  static constexpr Method method = Method::splitting;
  static constexpr double rounding = 2.5;

  struct Run {
    EqualLength length;
    SplittingSteps<SymmetricFreeFlow, Weight> steps;

    [[nodiscard]] EulerTop::State on_the_way(double t, double /*end*/) {
      advance(steps, length, t);
      return {steps.attitude(), steps.angular_velocity()};
    }
    [[nodiscard]] const Effort& effort() const { return steps.effort(); }
  };

  [[nodiscard]] Run run(const EqualLength& length, const EulerTop& top,
                        const EulerTop::State& start) const {
    const Vector3<double>& I = top.moments();
    Run r{length,
          {SymmetricFreeFlow(I.x(), I.z()),
           {&top},
           task_.begin,
           start.attitude,
           start.angular_velocity,
           length.longest}};
    r.steps.give_up_after(task_.most_evaluations);
    return r;
  }

 private:
  /// What the torque turns with on body axes.
  [[nodiscard]] static double fastest_rate(const EulerTop& top, const EulerTop::State& start) {
    const Vector3<double>& I = top.moments();
    const bool axial = top.weight_moment().x() == 0 && top.weight_moment().y() == 0;
    const double nutation = I.cwiseProduct(start.angular_velocity).norm() / I.x();
    const double spin = axial ? 0 : start.angular_velocity.norm();
    return std::max(nutation, spin) + std::sqrt(top.weight_moment().norm() / I.x());
  }

  SplittingRuns(const Task& task, double rate)
      // Steps of 2/rate err by some 1e-9.
      : FixedRuns(8, 2 / rate * std::clamp(std::pow(task.tolerance / 1e-9, 1.0 / 8), 0.2, 4.0),
                  0.02 / rate),
        task_(task) {}

  const Task& task_;
};

}  // namespace kreisel::detail
