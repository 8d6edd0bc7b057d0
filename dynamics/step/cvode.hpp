#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cvode/cvode.h>
#include <exception>
#include <limits>
#include <memory>
#include <nvector/nvector_serial.h>
#include <span>
#include <string>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>
#include <type_traits>
#include <utility>

#include <dynamics/step/accuracy.hpp>
#include <dynamics/step/jacobian.hpp>
#include <dynamics/step/shared.hpp>

namespace kreisel {

/// CVODE's multistep methods of variable order. adams: orders 1 to 12, fixed-point iterations, for
/// fields that are not stiff and expensive to evaluate. bdf: orders 1 to 5, Newton's method with a
/// dense matrix, for stiff fields.
enum class CvodeMethod { adams, bdf };

namespace detail {

struct SundialsFree {
  void operator()(N_Vector v) const { N_VDestroy(v); }
  void operator()(SUNMatrix m) const { SUNMatDestroy(m); }
  void operator()(SUNLinearSolver s) const { SUNLinSolFree(s); }
  void operator()(SUNNonlinearSolver s) const { SUNNonlinSolFree(s); }
  void operator()(SUNContext c) const { SUNContext_Free(&c); }
  void operator()(void* cvode) const { CVodeFree(&cvode); }
};

template <class Pointer>
using Sundials = std::unique_ptr<std::remove_pointer_t<Pointer>, SundialsFree>;

[[nodiscard]] inline Sundials<SUNContext> sundials_context() {
  SUNContext context = nullptr;
  if (SUNContext_Create(nullptr, &context) != 0) throw ComputationFailed("CVODE: no context");
  return Sundials<SUNContext>(context);
}

[[nodiscard]] inline std::string cvode_flag(int flag) {
  char* const name = CVodeGetReturnFlagName(flag);  // freed here
  std::string text = name;
  std::free(name);
  return text;
}

}  // namespace detail

/// SUNDIALS' CVODE with the interface of ExplicitRungeKutta, for comparison and for stiff fields of
/// many components.
///
/// CVODE tries a shorter step if the field is not finite. If no step succeeds, the last accepted
/// time and state stay readable. Exceptions of the field pass through. Neither state nor time is
/// compensated. The accuracy is that of one step by CVODE's own estimate, a root mean square over
/// the components. The errors add up to 10 to 1000 times as much.
///
/// Vector : Eigen::Matrix<double, n, 1>; n may be Eigen::Dynamic
/// Field  : as ExplicitRungeKutta takes it
/// J      : callable (double t, Vector y) -> Jacobian<n>, for bdf; default: CVODE's differences
/// Blocks : as ExplicitRungeKutta
/// Source : A. C. Hindmarsh et al., SUNDIALS, ACM TOMS 31 (2005) 363; its manual, release 6
/// Cost   : about two evaluations a step, and some microseconds besides
/// Throws : InvalidInput for an accuracy out of range or a start that is not finite;
///          ComputationFailed naming the time and CVODE's reason
template <class Vector, class Field, class J = NoJacobian>
class CvodeSteps {
 public:
  using Scalar = double;

  CvodeSteps(CvodeMethod method, Field field, double t, const Vector& y,
             const Accuracy& accuracy = {}, std::span<const int> blocks = {})
      : CvodeSteps(method, std::move(field), J{}, t, y, accuracy, blocks) {}

  CvodeSteps(CvodeMethod method, Field field, J jacobian, double t, const Vector& y,
             const Accuracy& accuracy = {}, std::span<const int> blocks = {})
      : field_(std::move(field)),
        jacobian_(std::move(jacobian)),
        accuracy_(accuracy),
        t_(t),
        y_(y),
        rate_(y),
        allowed_(y),
        sizes_(blocks, accuracy.absolute_scale, y),
        context_(detail::sundials_context()),
        state_(N_VNew_Serial(count(), context_.get())) {
    detail::check(accuracy);
    if (!std::isfinite(t)) detail::refuse_steps("the start time is not finite");
    if (!detail::finite(y)) detail::refuse_steps("the state at the start is not finite");
    require(state_ != nullptr, "has no memory");
    cvode_.reset(CVodeCreate(method == CvodeMethod::adams ? CV_ADAMS : CV_BDF, context_.get()));
    require(cvode_ != nullptr, "has no memory");
    put_state();
    require(CVodeInit(cvode_.get(), &call_field, t, state_.get()) == CV_SUCCESS &&
                CVodeSetErrFile(cvode_.get(), nullptr) == CV_SUCCESS &&  // its message is thrown
                CVodeSetUserData(cvode_.get(), this) == CV_SUCCESS &&
                CVodeWFtolerances(cvode_.get(), &set_weights) == CV_SUCCESS &&
                CVodeSetMaxNumSteps(cvode_.get(), -1) == CV_SUCCESS,
            "does not accept the accuracy");
    method == CvodeMethod::adams ? iterate() : solve_by_newton();
  }

  // CVODE keeps pointers to this object.
  CvodeSteps(const CvodeSteps&) = delete;
  CvodeSteps& operator=(const CvodeSteps&) = delete;

  [[nodiscard]] double t() const { return t_; }
  [[nodiscard]] const Vector& y() const { return y_; }
  [[nodiscard]] const IntegrationStatistics& effort() const { return effort_; }

  /// Integrates to `end` exactly, forwards or backwards.
  const Vector& advance_to(double end) {
    while (end != t_) step_towards(end);
    return y_;
  }

  /// One step towards `end`, not beyond `end`.
  void step_towards(double end) {
    if (!std::isfinite(end)) detail::refuse_steps("the end time is not finite");
    if (end == t_) return;
    const bool turned = std::signbit(end - t_) != std::signbit(direction_);
    if (turned || broken_) begin_again();
    direction_ = std::copysign(1.0, end - t_);
    begin_ = t_;
    double t = t_;
    require(CVodeSetStopTime(cvode_.get(), end) == CV_SUCCESS, "does not accept the end time");
    const int flag = CVode(cvode_.get(), end, state_.get(), &t, CV_ONE_STEP);
    note_effort();
    const bool finds_none = flag < 0 || !detail::finite(map(N_VGetArrayPointer(state_.get())));
    // CVODE itself never stops.
    const bool stands_still =
        t != end && std::abs(t - t_) <= 4 * std::numeric_limits<double>::epsilon() * std::abs(t);
    if (finds_none || stands_still) {
      broken_ = true;
      if (thrown_) std::rethrow_exception(std::exchange(thrown_, nullptr));
      detail::stop_integration(
          t_, "no step of CVODE succeeds (",
          finds_none ? detail::cvode_flag(flag) : "the step is too short to advance time", ')');
    }
    t_ = t;
    y_ = map(N_VGetArrayPointer(state_.get()));
    effort_.steps += 1;
  }

  /// True if a time lies within the last step.
  [[nodiscard]] bool covers(double time) const {
    return time >= std::min(begin_, t_) && time <= std::max(begin_, t_);
  }

  /// The state at a time within the last step, by CVODE's own polynomial.
  ///
  /// Throws : InvalidInput for a time outside the last step
  [[nodiscard]] Vector at(double time) {
    if (!covers(time)) {
      detail::refuse_steps("t = ", time, " s lies outside the last step, [", begin_, ", ", t_,
                           "] s");
    }
    if (time == t_) return y_;
    const detail::Sundials<N_Vector> there(N_VNew_Serial(count(), context_.get()));
    require(there && CVodeGetDky(cvode_.get(), time, 0, there.get()) == CV_SUCCESS,
            "has no state within its last step");
    return map(N_VGetArrayPointer(there.get()));
  }

 private:
  static void require(bool good, const char* what) {
    if (!good) throw ComputationFailed(std::string("CVODE ") + what);
  }

  [[nodiscard]] sunindextype count() const { return static_cast<sunindextype>(y_.size()); }

  [[nodiscard]] Eigen::Map<const Vector> map(const double* numbers) const {
    return Eigen::Map<const Vector>(numbers, y_.size());
  }

  void put_state() { std::copy_n(y_.data(), y_.size(), N_VGetArrayPointer(state_.get())); }

  void iterate() {
    iteration_.reset(SUNNonlinSol_FixedPoint(state_.get(), 0, context_.get()));
    require(iteration_ && CVodeSetNonlinearSolver(cvode_.get(), iteration_.get()) == CV_SUCCESS,
            "has no iteration");
  }

  void solve_by_newton() {
    matrix_.reset(SUNDenseMatrix(count(), count(), context_.get()));
    require(matrix_ != nullptr, "has no memory");
    solver_.reset(SUNLinSol_Dense(state_.get(), matrix_.get(), context_.get()));
    require(
        solver_ && CVodeSetLinearSolver(cvode_.get(), solver_.get(), matrix_.get()) == CV_SUCCESS,
        "has no linear solver");
    if constexpr (!std::is_same_v<J, NoJacobian>) {
      require(CVodeSetJacFn(cvode_.get(), &call_jacobian) == CV_SUCCESS,
              "does not accept the Jacobian");
    }
  }

  /// Restarts at the present state and clears the memory of earlier steps.
  void begin_again() {
    put_state();
    require(CVodeReInit(cvode_.get(), t_, state_.get()) == CV_SUCCESS, "does not restart");
    before_ = effort_;
    broken_ = false;
  }

  /// CVODE counts from its last restart.
  void note_effort() {
    long int rejected = 0;
    CVodeGetNumErrTestFails(cvode_.get(), &rejected);
    effort_.rejected = before_.rejected + static_cast<double>(rejected);
    if (!solver_) return;
    long int jacobians = 0;
    CVodeGetNumJacEvals(cvode_.get(), &jacobians);
    effort_.jacobians = before_.jacobians + static_cast<double>(jacobians);
  }

  /// No exception may cross CVODE's C frames, which lie between the field and the caller.
  template <class Call>
  [[nodiscard]] int guarded(const Call& call) {
    constexpr int try_shorter = 1;
    constexpr int give_up = -1;
    if (thrown_) return give_up;
    try {
      if (effort_.evaluations > accuracy_.max_evaluations) {
        detail::stop_without_evaluations(t_, accuracy_.max_evaluations);
      }
      return call() ? 0 : try_shorter;
    } catch (...) {
      thrown_ = std::current_exception();
      return give_up;
    }
  }

  static int call_field(double t, N_Vector y, N_Vector rate, void* self) {
    auto& steps = *static_cast<CvodeSteps*>(self);
    return steps.guarded([&] {
      steps.effort_.evaluations += 1;
      const Vector state = steps.map(N_VGetArrayPointer(y));
      detail::call(steps.field_, t, state, steps.rate_);
      std::copy_n(steps.rate_.data(), steps.rate_.size(), N_VGetArrayPointer(rate));
      return detail::finite(steps.rate_);
    });
  }

  static int call_jacobian(double t, N_Vector y, N_Vector /*rate*/, SUNMatrix matrix, void* self,
                           N_Vector, N_Vector, N_Vector) {
    auto& steps = *static_cast<CvodeSteps*>(self);
    return steps.guarded([&] {
      const auto jacobian = steps.jacobian_(t, Vector(steps.map(N_VGetArrayPointer(y)))).of_state;
      std::copy_n(jacobian.data(), jacobian.size(), SUNDenseMatrix_Data(matrix));  // by columns
      return detail::finite(jacobian);
    });
  }

  /// Sets the weights: one over the error that Accuracy allows in each component. Called with every
  /// accepted state.
  static int set_weights(N_Vector y, N_Vector weights, void* self) {
    auto& steps = *static_cast<CvodeSteps*>(self);
    steps.sizes_.note(steps.map(N_VGetArrayPointer(y)));
    steps.sizes_.put(steps.allowed_);
    double* const weight = N_VGetArrayPointer(weights);
    for (Eigen::Index i = 0; i < steps.allowed_.size(); ++i) {
      const double allowed = steps.accuracy_.relative * steps.allowed_[i];
      weight[i] = 1 / std::max(allowed, std::numeric_limits<double>::min());
    }
    return 0;
  }

  Field field_;
  J jacobian_;
  Accuracy accuracy_;
  double t_;
  Vector y_;
  Vector rate_;
  Vector allowed_;
  double begin_ = t_;  ///< of the last step
  double direction_ = 1;
  bool broken_ = false;
  IntegrationStatistics effort_;
  IntegrationStatistics before_;  ///< at CVODE's last restart
  std::exception_ptr thrown_;
  detail::BlockSizes<Vector> sizes_;
  detail::Sundials<SUNContext> context_;
  detail::Sundials<N_Vector> state_;
  detail::Sundials<SUNMatrix> matrix_;
  detail::Sundials<SUNLinearSolver> solver_;
  detail::Sundials<SUNNonlinearSolver> iteration_;
  std::unique_ptr<void, detail::SundialsFree> cvode_;
};

template <class Field, class Vector, class... More>
CvodeSteps(CvodeMethod, Field, double, Vector, More...) -> CvodeSteps<Vector, Field>;
template <class Field, class J, class Vector, class... More>
requires(!std::is_arithmetic_v<J>) CvodeSteps(CvodeMethod, Field, J, double, Vector, More...)
->CvodeSteps<Vector, Field, J>;

}  // namespace kreisel
