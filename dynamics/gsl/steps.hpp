#pragma once

#include <Eigen/Core>
#include <gsl/gsl_odeiv2.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <exception>
#include <memory>
#include <type_traits>
#include <utility>

#include <dynamics/gsl/errors.hpp>
#include <dynamics/step/accuracy.hpp>
#include <dynamics/step/explicit.hpp>
#include <dynamics/step/jacobian.hpp>
#include <dynamics/step/shared.hpp>

namespace kreisel {

/// GSL's adaptive steppers. msbdf and bsimp need a Jacobian and are for stiff fields: bsimp as a
/// rule, msbdf if 1e-4 is enough.
enum class GslMethod { rkf45, rk8pd, msadams, msbdf, bsimp };

namespace detail {

[[nodiscard]] inline const gsl_odeiv2_step_type* gsl_type(GslMethod method) {
  switch (method) {
    case GslMethod::rkf45: return gsl_odeiv2_step_rkf45;
    case GslMethod::rk8pd: return gsl_odeiv2_step_rk8pd;
    case GslMethod::msadams: return gsl_odeiv2_step_msadams;
    case GslMethod::msbdf: return gsl_odeiv2_step_msbdf;
    case GslMethod::bsimp: return gsl_odeiv2_step_bsimp;
  }
  refuse_steps("unknown GslMethod: ", static_cast<int>(method));
}

/// GSL error control with the error bounds of Accuracy. GSL's own control has no blocks and uses
/// the present size only.
class GslControl {
 public:
  template <std::size_t n>
  GslControl(const Accuracy& accuracy, const std::array<int, n>& blocks, int components)
      : accuracy_(accuracy) {
    static_assert(n <= 8, "a state has eight blocks at most");
    require_blocks(blocks, components);
    for (const int size : blocks) blocks_[used_++] = {static_cast<std::size_t>(size), 0};
  }

  /// Must be called with every accepted state.
  void note_size(const double* y) {
    for (std::size_t b = 0; b < used_; y += blocks_[b++].components) {
      blocks_[b].size = std::max(blocks_[b].size, norm(y, blocks_[b]));
    }
  }

  /// The largest ratio of v to the error allowed for its block.
  [[nodiscard]] double ratio(const double* v) const {
    double worst = 0;
    for (std::size_t b = 0; b < used_; v += blocks_[b++].components) {
      const double r = norm(v, blocks_[b]) / allowed(blocks_[b]);
      worst = r <= worst || worst != worst ? worst : r;  // a NaN stays
    }
    return worst;
  }

  [[nodiscard]] static gsl_odeiv2_control gsl(GslControl* self) { return {&type, self}; }

 private:
  struct Block {
    std::size_t components;
    double size;
  };

  [[nodiscard]] static double norm(const double* v, const Block& block) {
    return Eigen::Map<const Eigen::VectorXd>(v, static_cast<Eigen::Index>(block.components))
        .stableNorm();
  }

  [[nodiscard]] double allowed(const Block& block) const {
    return accuracy_.relative * std::max(block.size, accuracy_.absolute_scale);
  }

  /// GSL's rule for the next step, with its constants.
  static int adjust(void* self, std::size_t, unsigned order, const double*, const double* error,
                    const double*, double* h) {
    const double worst = static_cast<GslControl*>(self)->ratio(error);
    if (!(worst <= 1.1)) {
      const double factor = 0.9 * std::pow(worst, -1.0 / order);
      *h *= factor > 0.2 ? factor : 0.2;
      return GSL_ODEIV_HADJ_DEC;
    }
    if (worst > 0.5) return GSL_ODEIV_HADJ_NIL;
    *h *= std::clamp(0.9 * std::pow(worst, -1.0 / (order + 1)), 1.0, 4.9);
    return GSL_ODEIV_HADJ_INC;
  }

  static int error_level(void* self, double, double, double, std::size_t component, double* level) {
    const auto& control = *static_cast<GslControl*>(self);
    std::size_t b = 0;
    while (component >= control.blocks_[b].components) component -= control.blocks_[b++].components;
    *level = control.allowed(control.blocks_[b]);
    return GSL_SUCCESS;
  }

  static constexpr gsl_odeiv2_control_type type = {"blocks",     nullptr, nullptr, &adjust,
                                                   &error_level, nullptr, nullptr};

  Accuracy accuracy_;
  std::array<Block, 8> blocks_ = {};
  std::size_t used_ = 0;
};

}  // namespace detail

/// GSL's steppers with the interface of ExplicitRungeKutta, for comparison and for stiff fields.
///
/// GSL returns success with a NaN in the state. This class makes GSL try a shorter step if the
/// field is not finite. If no step succeeds, the last accepted time and state stay readable.
/// Exceptions of the field pass through. Neither state nor time is compensated. The accuracy is
/// that of one step by GSL's own estimate. The estimates of msadams, msbdf and, at moderate
/// stiffness, bsimp are too low, sometimes by a factor of 100.
///
/// Source : GSL 2.7 reference manual, ordinary differential equations
/// Field  : callable (double t, Vector y) -> Vector
/// J      : callable (double t, Vector y) -> Jacobian<n>; forward_jacobian() makes one
/// Cost   : a step of rkf45 7 evaluations, of rk8pd 14
/// Throws : InvalidInput for an accuracy out of range, a start that is not finite, a Jacobian that
///          is missing; ComputationFailed naming the time where steps become too short or too many
template <class Vector, class Field, class J = NoJacobian>
class GslSteps {
 public:
  template <std::size_t n = 1>
  GslSteps(GslMethod method, Field field, double t, const Vector& y, const Accuracy& accuracy = {},
           const std::array<int, n>& blocks = {int(Vector::RowsAtCompileTime)})
      : GslSteps(method, std::move(field), J{}, t, y, accuracy, blocks) {}

  template <std::size_t n = 1>
  GslSteps(GslMethod method, Field field, J jacobian, double t, const Vector& y,
           const Accuracy& accuracy = {},
           const std::array<int, n>& blocks = {int(Vector::RowsAtCompileTime)})
      : field_(std::move(field)),
        jacobian_(std::move(jacobian)),
        accuracy_(accuracy),
        t_(t),
        y_(y),
        control_(accuracy, blocks, dimension),
        step_(gsl_odeiv2_step_alloc(detail::gsl_type(method), dimension), &gsl_odeiv2_step_free),
        evolve_(gsl_odeiv2_evolve_alloc(dimension), &gsl_odeiv2_evolve_free) {
    detail::check(accuracy);
    if (!std::isfinite(t)) detail::refuse_steps("the start time is not finite");
    if (!detail::finite(y)) detail::refuse_steps("the state at the start is not finite");
    const bool implicit = method == GslMethod::msbdf || method == GslMethod::bsimp;
    if (implicit && std::is_same_v<J, NoJacobian>) {
      detail::refuse_steps("GSL ", gsl_odeiv2_step_name(step_.get()),
                           " needs a Jacobian: forward_jacobian(field) makes one");
    }
    control_.note_size(y_.data());
    // msadams and msbdf read only the control from their driver.
    driver_.c = &gsl_control_;
    gsl_odeiv2_step_set_driver(step_.get(), &driver_);
  }

  // GSL keeps pointers to this object.
  GslSteps(const GslSteps&) = delete;
  GslSteps& operator=(const GslSteps&) = delete;

  [[nodiscard]] double t() const { return t_; }
  [[nodiscard]] const Vector& y() const { return y_; }
  [[nodiscard]] const IntegrationStatistics& effort() const { return effort_; }

  /// Integrates to `end` exactly, forwards or backwards.
  const Vector& advance_to(double end) {
    if (!std::isfinite(end)) detail::refuse_steps("the end time is not finite");
    if (end == t_) return y_;
    if (length_ == 0) length_ = first_length();
    if (std::signbit(length_) != std::signbit(end - t_)) {
      length_ = -length_;
      forget();
    }
    const detail::GslErrorsReturned guard;
    while (t_ != end) take_step(end);
    return y_;
  }

 private:
  static constexpr int dimension = Vector::RowsAtCompileTime;

  /// Clears the steppers' memory of earlier steps.
  void forget() {
    gsl_odeiv2_step_reset(step_.get());
    gsl_odeiv2_evolve_reset(evolve_.get());
  }

  void take_step(double end) {
    double t = t_;
    Vector y = y_;
    const auto rejected = evolve_->failed_steps;
    const int status = gsl_odeiv2_evolve_apply(evolve_.get(), &gsl_control_, step_.get(), &system_,
                                               &t, end, &length_, y.data());
    effort_.rejected += static_cast<double>(evolve_->failed_steps - rejected);
    if (status != GSL_SUCCESS || !detail::finite(y)) {
      forget();
      length_ = 0;
      if (thrown_) std::rethrow_exception(std::exchange(thrown_, nullptr));
      detail::stop_integration(t_, "GSL ", gsl_odeiv2_step_name(step_.get()),
                               " does not accept any step (", gsl_strerror(status), ')');
    }
    t_ = t;
    y_ = y;
    control_.note_size(y_.data());
    effort_.steps += 1;
  }

  /// A hundredth of the time in which a block changes by its own size, as in ExplicitRungeKutta.
  [[nodiscard]] double first_length() {
    effort_.evaluations += 1;
    const Vector rate = field_(t_, y_);
    if (!detail::finite(rate)) detail::stop_integration(t_, "the field is not finite");
    const double worst = control_.ratio(rate.data()) * accuracy_.relative;
    return worst > 0 ? 0.01 / worst : 1.0;
  }

  /// No exception may cross GSL's C frames, which lie between the field and the caller.
  template <class Call>
  [[nodiscard]] int guarded(const Call& call) {
    try {
      if (effort_.evaluations > accuracy_.max_evaluations) {
        detail::stop_without_evaluations(t_, accuracy_.max_evaluations);
      }
      return call() ? GSL_SUCCESS : GSL_ERANGE;  // GSL answers ERANGE with a shorter step
    } catch (...) {
      thrown_ = std::current_exception();
      return GSL_EBADFUNC;  // and gives up at EBADFUNC
    }
  }

  static int call_field(double t, const double* y, double* rate, void* self) {
    auto& steps = *static_cast<GslSteps*>(self);
    return steps.guarded([&] {
      steps.effort_.evaluations += 1;
      const Vector f = steps.field_(t, Vector(Eigen::Map<const Vector>(y)));
      Eigen::Map<Vector>{rate} = f;
      return detail::finite(f);
    });
  }

  static int call_jacobian(double t, const double* y, double* of_state, double* of_time,
                           void* self) {
    if constexpr (std::is_same_v<J, NoJacobian>) {
      return GSL_EBADFUNC;
    } else {
      auto& steps = *static_cast<GslSteps*>(self);
      return steps.guarded([&] {
        const Jacobian<dimension> j = steps.jacobian_(t, Vector(Eigen::Map<const Vector>(y)));
        constexpr auto rows = dimension == 1 ? Eigen::ColMajor : Eigen::RowMajor;
        Eigen::Map<Eigen::Matrix<double, dimension, dimension, rows>>{of_state} = j.of_state;
        Eigen::Map<Vector>{of_time} = j.of_time;
        return detail::finite(j.of_state) && detail::finite(j.of_time);
      });
    }
  }

  Field field_;
  J jacobian_;
  Accuracy accuracy_;
  double t_;
  Vector y_;
  double length_ = 0;  ///< of the next step; 0: a first length is computed
  IntegrationStatistics effort_;
  std::exception_ptr thrown_;
  detail::GslControl control_;
  gsl_odeiv2_control gsl_control_ = detail::GslControl::gsl(&control_);
  gsl_odeiv2_system system_ = {&call_field, &call_jacobian, std::size_t(dimension), this};
  gsl_odeiv2_driver driver_ = {};
  std::unique_ptr<gsl_odeiv2_step, decltype(&gsl_odeiv2_step_free)> step_;
  std::unique_ptr<gsl_odeiv2_evolve, decltype(&gsl_odeiv2_evolve_free)> evolve_;
};

template <class Field, class Vector, class... More>
GslSteps(GslMethod, Field, double, Vector, More...) -> GslSteps<Vector, Field>;
template <class Field, class J, class Vector, class... More>
requires(!std::is_arithmetic_v<J>) GslSteps(GslMethod, Field, J, double, Vector, More...)
->GslSteps<Vector, Field, J>;

}  // namespace kreisel
