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

#include <dynamics/model/scene.hpp>
#include <dynamics/rigid/euler_top.hpp>
#include <dynamics/solve/any_field.hpp>
#include <dynamics/solve/error_measure.hpp>
#include <dynamics/solve/run.hpp>
#include <dynamics/solve/runs_of_steps.hpp>
#include <dynamics/step/integrator.hpp>
#include <dynamics/step/jacobian.hpp>

/// The runs of one scene.

namespace kreisel::detail {

/// The Jacobian of a scene's field, exact if the field accepts dual numbers.
template <class Scene>
[[nodiscard]] auto jacobian_of(const Scene& scene) {
  constexpr int n = int(Scene::Vector::RowsAtCompileTime);
  using Dual = Eigen::AutoDiffScalar<Eigen::Matrix<double, n + 1, 1>>;
  using DualVector = Eigen::Matrix<Dual, n, 1>;
  if constexpr (requires(const Dual& t, const DualVector& y) { scene.rates(t, y); }) {
    return forward_jacobian<n>(SceneField<Scene>{&scene});
  } else {
    return difference_jacobian<n>(SceneField<Scene>{&scene});
  }
}

/// The scene with parameters perturbed by last digits; none if it has no perturbed_by_ulps().
template <class Scene>
[[nodiscard]] std::optional<Scene> perturbed_by_ulps(const Scene& scene) {
  if constexpr (HasPerturbation<Scene>) {
    return scene.perturbed_by_ulps();
  } else {
    return std::nullopt;
  }
}

template <class Scene>
class SceneRuns final : public SteppedScene {
  using State = typename Scene::State;
  using Own = typename Scene::Vector;

 public:
  explicit SceneRuns(const Scene& scene)
      : scene_(scene), other_(detail::perturbed_by_ulps(scene)) {}

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
    if constexpr (HasSeries<Scene> && requires { scene_.knows_series(); }) {
      return scene_.knows_series();
    } else {
      return HasSeries<Scene>;
    }
  }
  [[nodiscard]] bool has_samples() const override {
    if constexpr (HasSamples<Scene>) {
      return scene_.has_samples();
    } else {
      return false;
    }
  }
  [[nodiscard]] std::vector<double> sample_times(double begin, double end) const override {
    if constexpr (HasSamples<Scene>) {
      return scene_.sample_times(begin, end);
    } else {
      return {};
    }
  }
  [[nodiscard]] Eigen::VectorXd sampled(double t, const Eigen::VectorXd& y) const override {
    Eigen::VectorXd state = y;
    if constexpr (HasSamples<Scene>) {
      static_assert(of_any_size, "a scene with samples needs a Vector of dynamic size");
      scene_.sample(t, state);
    }
    return state;
  }
  [[nodiscard]] bool has_corners() const override {
    if constexpr (HasCorners<Scene>) {
      return scene_.has_corners();
    } else {
      return false;
    }
  }
  [[nodiscard]] std::vector<Corner> corners(double t, std::span<const double> y) const override {
    if constexpr (HasCorners<Scene>) {
      return scene_.corners(t, vector_of<Own>(y));
    } else {
      return {};
    }
  }
  [[nodiscard]] double corner_frequency() const override {
    if constexpr (HasCorners<Scene>) {
      return scene_.corner_frequency();
    } else {
      return 0;
    }
  }
  [[nodiscard]] bool may_be_stiff() const override {
    if constexpr (HasStiffness<Scene>) {
      return scene_.may_be_stiff();
    } else {
      return true;
    }
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
    if constexpr (HasConserved<Scene>) {
      const auto now = scene_.conserved(t, from_components(y));
      if (drifts.empty()) {
        for (const auto& [name, value] : now) drifts.push_back({name, value, 0});
      }
      for (std::size_t i = 0; i < now.size(); ++i) {
        drifts[i].largest =
            max_or_nan(drifts[i].largest, std::abs(now[i].second - drifts[i].start));
      }
    }
  }

  [[nodiscard]] std::unique_ptr<StiffField> stiff_field(bool other) const override {
    if constexpr (of_any_size) {
      return detail::stiff_field(field(other));
    } else {
      auto jacobian = jacobian_of(scene(other));
      using J = decltype(jacobian);
      return std::make_unique<StiffFieldOf<Own, SceneField<Scene>, J>>(field(other),
                                                                       std::move(jacobian));
    }
  }

  [[nodiscard]] std::unique_ptr<SteppedRun> explicit_run(const SolveOptions& options,
                                                         const Eigen::VectorXd& start,
                                                         const Accuracy& accuracy,
                                                         bool other) const override {
    if constexpr (of_any_size) {
      return run_explicit_steps(*this, field(other), options, start, accuracy);
    } else {
      return run_explicit_steps<Own>(*this, field(other), options, start, accuracy);
    }
  }

  [[nodiscard]] std::unique_ptr<SteppedRun> taylor_run(const SolveOptions& options,
                                                       const Eigen::VectorXd& start,
                                                       const Accuracy& accuracy,
                                                       bool other) const override {
    if constexpr (HasSeries<Scene>) {
      if constexpr (of_any_size) {
        return run_taylor_steps(*this, AnySeries(scene(other).series()), options, start, accuracy);
      } else {
        return run_taylor_steps<Own>(*this, scene(other).series(), options, start, accuracy);
      }
    } else {
      return nullptr;
    }
  }

  [[nodiscard]] std::unique_ptr<Run> gauss_run(const SolveOptions& options,
                                               const Eigen::VectorXd& start,
                                               const EqualLength& length,
                                               bool other) const override {
    if constexpr (of_any_size) {
      return run_gauss_steps(*this, field(other), options, start, length);
    } else {
      return run_gauss_steps<Own>(*this, field(other), options, start, length);
    }
  }

 private:
  static constexpr bool of_any_size = Own::RowsAtCompileTime == Eigen::Dynamic;

  [[nodiscard]] auto field(bool other) const {
    SceneField<Scene> field{&scene(other)};
    if constexpr (of_any_size) {
      return AnyField(std::move(field));
    } else {
      return field;
    }
  }

  [[nodiscard]] const Scene& scene(bool other) const { return other ? *other_ : scene_; }

  const Scene& scene_;
  std::optional<Scene> other_;
};

}  // namespace kreisel::detail
