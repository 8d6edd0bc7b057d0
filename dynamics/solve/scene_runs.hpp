#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include <dynamics/scene/euler_top.hpp>
#include <dynamics/solve/error_measure.hpp>
#include <dynamics/solve/run.hpp>
#include <dynamics/step/advance.hpp>
#include <dynamics/step/gauss.hpp>
#include <dynamics/step/jacobian.hpp>
#include <dynamics/step/taylor.hpp>

/// The runs of one scene.

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

template <class Vector>
void write(double* y, const Vector& from) {
  std::copy_n(from.data(), from.size(), y);
}

template <class Steps>
class RunOfExplicitSteps final : public ExplicitRun {
 public:
  RunOfExplicitSteps(const SteppedScene& scene, bool other, bool looks, Steps steps)
      : ExplicitRun(scene, other), looks_(looks), steps_(std::move(steps)) {}

  void on_the_way(double t, double end, double* y) override {
    while (!steps_.covers(t)) {
      steps_.step_towards(end);
      if (looks_ && looks_now(end, y)) return;
    }
    write(y, steps_.at(t));
  }

  double step_towards(double end) override {
    steps_.step_towards(end);
    return steps_.t();
  }

  [[nodiscard]] const Effort& effort() const override { return steps_.effort(); }
  [[nodiscard]] double noise() const override { return steps_.noise(); }
  void pass(Bookmark& bookmark) override { bookmark(looks_, steps_); }

 private:
  /// Looked at once, or where it seems to be stability that keeps the steps short.
  [[nodiscard]] bool looks_now(double end, double* y) {
    const bool looks_early = steps_.effort().steps == 50;
    if (!looks_early && !steps_.stiff()) return false;
    write(y, steps_.y());
    const auto components = static_cast<std::size_t>(steps_.y().size());
    const bool stiff = proves_stiff(steps_.t(), {y, components}, end, steps_.stiff(), 0);
    looks_ = !stiff && looks_early;
    return stiff;
  }

  bool looks_;
  Steps steps_;
};

template <class Steps>
class RunOfTaylorSteps final : public LookingRun {
 public:
  RunOfTaylorSteps(const SteppedScene& scene, bool other, bool looks, Steps steps)
      : LookingRun(scene, other), looks_(looks), steps_(std::move(steps)) {}

  void on_the_way(double t, double end, double* y) override {
    while (!steps_.covers(t)) {
      steps_.step_towards(end);
      if (!looks_ || steps_.effort().steps < next_look_) continue;
      next_look_ *= 2;
      write(y, steps_.y());
      const auto components = static_cast<std::size_t>(steps_.y().size());
      if (proves_stiff(steps_.t(), {y, components}, end, false, steps_.length())) return;
    }
    write(y, steps_.at(t));
  }

  [[nodiscard]] const Effort& effort() const override { return steps_.effort(); }
  [[nodiscard]] double noise() const override { return steps_.noise(); }
  void pass(Bookmark& bookmark) override { bookmark(next_look_, steps_); }

 private:
  bool looks_;
  double next_look_ = 50;
  Steps steps_;
};

template <class Steps>
class RunOfGaussSteps final : public Run {
 public:
  RunOfGaussSteps(const EqualLength& length, Steps steps)
      : length_(length), steps_(std::move(steps)) {}

  void on_the_way(double t, double /*end*/, double* y) override {
    length_.advance(steps_, t);
    write(y, steps_.y());
  }

  [[nodiscard]] const Effort& effort() const override { return steps_.effort(); }
  [[nodiscard]] double noise() const override { return steps_.noise(); }
  void pass(Bookmark& bookmark) override { bookmark(steps_); }

 private:
  EqualLength length_;
  Steps steps_;
};

/// The scene off by last digits, if it has such.
template <class Scene>
[[nodiscard]] std::optional<Scene> off_by_last_digits(const Scene& scene) {
  if constexpr (requires { scene.off_by_last_digits(); }) {
    return scene.off_by_last_digits();
  } else {
    return std::nullopt;
  }
}

template <class Scene>
class SceneRuns final : public SteppedScene {
  using State = typename Scene::State;
  using Own = typename Scene::Vector;
  using Field = SceneField<Scene>;

 public:
  explicit SceneRuns(const Scene& scene)
      : scene_(scene), other_(detail::off_by_last_digits(scene)) {}

  [[nodiscard]] Eigen::VectorXd to_vector(const State& state) const {
    return vector_of<Eigen::VectorXd>(scene_.to_vector(state));
  }
  [[nodiscard]] State from_components(std::span<const double> y) const {
    return scene_.from_vector(vector_of<Own>(y));
  }

  [[nodiscard]] std::vector<int> blocks() const override {
    const auto& blocks = blocks_of(scene_);
    return {blocks.begin(), blocks.end()};
  }
  [[nodiscard]] bool has_other() const override { return other_.has_value(); }
  [[nodiscard]] bool knows_series() const override {
    return requires { scene_.series(); };
  }
  [[nodiscard]] const EulerTop* top() const override {
    if constexpr (std::is_same_v<Scene, EulerTop>) {
      return &scene_;
    } else {
      return nullptr;
    }
  }

  void note_invariants(double t, std::span<const double> y,
                       std::vector<InvariantDrift>& drifts) const override {
    if constexpr (requires(const State& state) { scene_.conserved(t, state); }) {
      const auto now = scene_.conserved(t, from_components(y));
      if (drifts.empty()) {
        for (const auto& [name, value] : now) drifts.push_back({name, value, 0});
      }
      for (std::size_t i = 0; i < now.size(); ++i) {
        drifts[i].largest = worse(drifts[i].largest, std::abs(now[i].second - drifts[i].start));
      }
    }
  }

  [[nodiscard]] std::unique_ptr<StiffField> stiff_field(bool other) const override {
    auto jacobian = jacobian_of(scene(other));
    using J = decltype(jacobian);
    return std::make_unique<StiffFieldOf<Own, Field, J>>(Field{&scene(other)}, std::move(jacobian));
  }

  [[nodiscard]] std::unique_ptr<ExplicitRun> explicit_run(const Task& task,
                                                          const Eigen::VectorXd& start,
                                                          const Accuracy& accuracy,
                                                          bool other) const override {
    using Steps = ExplicitSteps<Own, Field>;
    // Where radau13 may not take over there is no need to look; and it cannot, where its
    // factorisations would outweigh everything.
    const bool looks = task.method == Method::automatic && start.size() <= 200;
    Steps steps({&scene(other)}, task.begin, vector_of<Own>(start), accuracy, blocks_of(scene_));
    steps.stop_at(task.jumps);
    return std::make_unique<RunOfExplicitSteps<Steps>>(*this, other, looks, std::move(steps));
  }

  [[nodiscard]] std::unique_ptr<Run> taylor_run(const Task& task, const Eigen::VectorXd& start,
                                                const Accuracy& accuracy,
                                                bool other) const override {
    if constexpr (requires { scene_.series(); }) {
      using Steps = TaylorSteps<Own, decltype(scene_.series())>;
      bool looks = false;
      if constexpr (requires { scene_.is_damped(); }) {
        looks = task.method == Method::automatic && scene(other).is_damped();
      }
      Steps steps(scene(other).series(), task.begin, vector_of<Own>(start), accuracy,
                  blocks_of(scene_));
      steps.stop_at(task.jumps);
      return std::make_unique<RunOfTaylorSteps<Steps>>(*this, other, looks, std::move(steps));
    } else {
      return nullptr;
    }
  }

  [[nodiscard]] std::unique_ptr<Run> gauss_run(const Task& task, const Eigen::VectorXd& start,
                                               const EqualLength& length,
                                               bool other) const override {
    using Steps = GaussSteps<Own, Field>;
    Steps steps({&scene(other)}, task.begin, vector_of<Own>(start), length.longest,
                blocks_of(scene_), task.smallest);
    steps.give_up_after(task.most_evaluations);
    return std::make_unique<RunOfGaussSteps<Steps>>(length, std::move(steps));
  }

 private:
  [[nodiscard]] const Scene& scene(bool other) const { return other ? *other_ : scene_; }

  const Scene& scene_;
  std::optional<Scene> other_;
};

}  // namespace kreisel::detail

#ifndef KREISEL_COMPILED
#include <dynamics/solve/solve_defined.hpp>
#endif
