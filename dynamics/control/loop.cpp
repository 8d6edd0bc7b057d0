#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <dynamics/control/actuator.hpp>
#include <dynamics/control/loop.hpp>
#include <dynamics/signal/same_time.hpp>
#include <motor/error.hpp>

namespace kreisel::detail {

using Eigen::MatrixXd;
using Eigen::VectorXd;

bool SampleTimes::contain(double t) const {
  const double k = std::round((t - first_) / period_);
  return k >= 0 && is_same_time(at(k), t, std::abs(first_));
}

void SampleTimes::append(double begin, double end, std::vector<double>& times) const {
  constexpr double most = 1e7;
  double k = std::max(0.0, std::floor((begin - first_) / period_) - 1);
  if ((end - at(k)) / period_ > most) {
    throw InvalidInput(
        "more than ten million samples of a controller lie in the run: take a "
        "longer period or an earlier end");
  }
  const auto is_same = [this](double a, double b) { return is_same_time(a, b, std::abs(first_)); };
  for (; at(k) <= end || is_same(at(k), end); ++k) {
    if (at(k) > begin && !is_same(at(k), begin)) times.push_back(is_same(at(k), end) ? end : at(k));
  }
}

ControlLoop::ControlLoop(Controller controller, const BodyTree& tree, int memory)
    : controller_(std::move(controller)),
      memory_(memory),
      reads_at_(controller_.first, controller_.period) {
  check();
  actuators_ = kreisel::actuators(controller_, tree);
  check_limits();
  check_winches(tree);
  check_readings(tree);
  if (const auto* const pid = std::get_if<PidLaw>(&controller_.law)) {
    set_pid(*pid);
  } else if (const auto* const law = std::get_if<StateSpaceLaw>(&controller_.law)) {
    law_ = *law;
    check_matrices();
  } else {
    callable_ = std::get<CallableLaw>(controller_.law);
    if (!callable_->law) refuse("its law is an empty function");
    if (callable_->memory < 0) refuse("its memory has fewer than 0 numbers");
  }
  if (initial().size() != memory_size()) {
    refuse(std::to_string(states()) + " numbers are its memory, but `initial` has another count");
  }
  feeds_through_ = callable_.has_value() || !law_.D.isZero(0);
  if (!is_sampled() && feeds_through_ && reads_accelerations()) {
    refuse(
        "its output depends at once on a reading of accelerations, which the output changes: "
        "give it a period, or a law without direct feedthrough (D = 0)");
  }
  if (is_sampled()) set_delay();
}

void ControlLoop::refuse(const std::string& why) const {
  throw InvalidInput("controller '" + controller_.name + "': " + why);
}

void ControlLoop::check() const {
  if (controller_.name.empty()) throw InvalidInput("a controller has no name: give it one");
  const auto finite_from_0 = [](double x) { return x >= 0 && std::isfinite(x); };
  if (!finite_from_0(controller_.period)) refuse("its period must be finite, 0 or above");
  if (!finite_from_0(controller_.delay)) refuse("its delay must be finite, 0 or above");
  if (!std::isfinite(controller_.first)) refuse("the time of its first sample is not finite");
  if (controller_.delay > 0 && controller_.period == 0) {
    refuse("a delay needs a period: a continuous law has no delay");
  }
  if (controller_.delay > 1000 * controller_.period) {
    refuse("its delay is longer than 1000 periods");
  }
  if (controller_.reads.empty()) refuse("it reads nothing");
  if (controller_.drives.empty()) refuse("it drives nothing");
  const std::size_t references = controller_.reference.size();
  if (references != 0 && references != controller_.reads.size()) {
    refuse(std::to_string(references) + " references for " +
           std::to_string(controller_.reads.size()) + " readings: give one for each");
  }
}

void ControlLoop::check_limits() const {
  const std::size_t limits = controller_.limit.size();
  if (limits != 0 && limits != actuators_.size()) {
    refuse(std::to_string(limits) + " limits for " + std::to_string(actuators_.size()) +
           " outputs: give one for each");
  }
  for (const double limit : controller_.limit) {
    if (!(limit > 0)) refuse("a limit must be above 0");
  }
}

void ControlLoop::check_winches(const BodyTree& tree) const {
  for (const Actuator& actuator : actuators_) {
    const auto* const winch = std::get_if<Actuator::Winch>(&actuator.kind);
    if (winch == nullptr || is_sampled()) continue;
    const auto& rope =
        std::get<RopeElement>(tree.elements()[static_cast<std::size_t>(winch->element)]);
    if (rope.damping == 0) continue;
    refuse("the damping of the rope '" + rope.name +
           "' needs the rate of its length, which a continuous law does not give: give the "
           "controller a period, or the rope no damping");
  }
}

void ControlLoop::check_body(const BodyTree& tree, int body) const {
  if (body >= 0 && body < static_cast<int>(tree.bodies().size())) return;
  refuse("a reading is of body " + std::to_string(body) + ", which the system does not have");
}

void ControlLoop::check_carrier(const BodyTree& tree, int body) const {
  check_body(tree, body);
  if (!tree.body(body).rotor) return;
  refuse("it reads the motion of the rotor '" + tree.body(body).name +
         "': read its joint, or its carrier");
}

void ControlLoop::check_frames(const BodyTree& tree, const Reading& reading) const {
  const auto check = [&](const SensorFrame& frame) {
    if (frame.kind == SensorFrame::Kind::body) check_carrier(tree, frame.body);
  };
  if (const auto* const point = std::get_if<PointSensor>(&reading.sensor)) {
    check(point->against);
    check(point->axes);
  } else if (const auto* const attitude = std::get_if<AttitudeSensor>(&reading.sensor)) {
    check(attitude->against);
  } else if (const auto* const angles = std::get_if<AttitudeAngles>(&reading.sensor)) {
    check(angles->sensor.against);
  }
}

void ControlLoop::check_readings(const BodyTree& tree) const {
  const auto check_component = [&](int component, int count) {
    if (component >= 0 && component < count) return;
    refuse("a reading is component " + std::to_string(component) + " of " + std::to_string(count));
  };
  for (const Reading& reading : controller_.reads) {
    if (const auto* const joint = std::get_if<JointSensor>(&reading.sensor)) {
      check_body(tree, joint->body);
      const JointPlace place = tree.place(joint->body);
      check_component(joint->component, joint->is_rate ? place.v_count : place.q_count);
      if (!joint->is_rate && place.q_count != place.v_count) {
        refuse("it reads a coordinate of the joint of '" + tree.body(joint->body).name +
               "', which is an attitude: read an attitude sensor");
      }
      continue;
    }
    const auto body_of = [](const auto& sensor) {
      if constexpr (requires { sensor.sensor; }) {
        return sensor.sensor.body;
      } else {
        return sensor.body;
      }
    };
    check_carrier(tree, std::visit(body_of, reading.sensor));
    check_frames(tree, reading);
    const bool is_point = std::holds_alternative<PointSensor>(reading.sensor);
    const bool is_attitude = std::holds_alternative<AttitudeSensor>(reading.sensor);
    check_component(reading.component, is_point ? 9 : is_attitude ? 4 : 3);
  }
}

void ControlLoop::check_matrices() const {
  const auto n = law_.A.rows();
  const auto fits = [](const MatrixXd& M, Eigen::Index rows, Eigen::Index columns) {
    return M.rows() == rows && (M.cols() == columns || rows == 0);
  };
  const auto finite = [](const auto& M) { return M.size() == 0 || M.allFinite(); };
  if (!fits(law_.A, n, n)) refuse("A of its law is not square");
  if (!fits(law_.B, n, inputs()))
    refuse("B must have a row for each state, a column for each reading");
  if (!fits(law_.C, outputs(), n))
    refuse("C must have a row for each output, a column for each state");
  if (!fits(law_.D, outputs(), inputs())) {
    refuse("D must have a row for each output, a column for each reading");
  }
  if (!finite(law_.A) || !finite(law_.B) || !finite(law_.C) || !finite(law_.D) ||
      !finite(law_.initial)) {
    refuse("a number of its law is not finite");
  }
}

void ControlLoop::set_pid(const PidLaw& pid) {
  for (const double x : {pid.proportional, pid.integral, pid.derivative, pid.filter}) {
    if (!std::isfinite(x)) refuse("a number of its law is not finite");
  }
  if (inputs() != outputs()) {
    refuse("a pid needs one reading for each output; it has " + std::to_string(inputs()) +
           " readings and " + std::to_string(outputs()) + " outputs");
  }
  if (pid.filter < 0) refuse("its filter must be 0 or above");
  if (pid.derivative != 0 && pid.filter == 0 && !is_sampled()) {
    refuse("a continuous derivative needs a filter above 0, a time constant in seconds");
  }
  const int m = inputs();
  const double T = controller_.period;
  const MatrixXd one = MatrixXd::Identity(m, m);
  const int integrals = pid.integral != 0 ? m : 0;
  const int of_derivative = pid.derivative == 0 ? 0 : is_sampled() ? 2 * m : m;
  const int n = integrals + of_derivative;
  law_ = {MatrixXd::Zero(n, n), MatrixXd::Zero(n, m), MatrixXd::Zero(m, n), pid.proportional * one,
          VectorXd::Zero(n)};
  integral_ = pid.integral;
  if (integrals > 0) {
    law_.C.leftCols(m) = pid.integral * one;
    law_.B.topRows(m) = is_sampled() ? MatrixXd(T * one) : one;
    if (is_sampled()) {
      law_.A.topLeftCorner(m, m) = one;
      law_.D += pid.integral * T * one;
    }
  }
  if (of_derivative > 0) set_derivative(pid, integrals);
}

/// Sets the derivative part of a pid; its states begin at `at`.
void ControlLoop::set_derivative(const PidLaw& pid, int at) {
  const int m = inputs();
  const double T = controller_.period;
  const MatrixXd one = MatrixXd::Identity(m, m);
  if (is_sampled()) {  // states d and the error before
    const double stays = pid.filter > 0 ? std::exp(-T / pid.filter) : 0;
    const double per_change = (1 - stays) / T;
    law_.A.block(at, at, m, m) = stays * one;
    law_.A.block(at, at + m, m, m) = -per_change * one;
    law_.B.middleRows(at, m) = per_change * one;
    law_.B.middleRows(at + m, m) = one;
    law_.C.middleCols(at, m) = pid.derivative * stays * one;
    law_.C.middleCols(at + m, m) = -pid.derivative * per_change * one;
    law_.D += pid.derivative * per_change * one;
  } else {  // state f
    law_.A.block(at, at, m, m) = -1 / pid.filter * one;
    law_.B.middleRows(at, m) = 1 / pid.filter * one;
    law_.C.middleCols(at, m) = -pid.derivative / pid.filter * one;
    law_.D += pid.derivative / pid.filter * one;
  }
}

void ControlLoop::set_delay() {
  constexpr double rounding = 1e-9;
  const double periods = controller_.delay / controller_.period;
  const double whole = std::floor(periods + rounding);
  const double rest = periods - whole;
  waiting_ = static_cast<int>(whole);
  if (rest <= rounding) return;
  waiting_ += 1;
  late_.emplace(controller_.first + rest * controller_.period, controller_.period);
}

int ControlLoop::states() const {
  return callable_ ? callable_->memory : static_cast<int>(law_.A.rows());
}

int ControlLoop::memory_size() const {
  return is_sampled() ? states() + (waiting_ + 1) * outputs() : states();
}

bool ControlLoop::reads_accelerations() const {
  return std::any_of(controller_.reads.begin(), controller_.reads.end(), [](const Reading& r) {
    return std::holds_alternative<Accelerometer>(r.sensor) ||
           (std::holds_alternative<PointSensor>(r.sensor) && r.component >= 6);
  });
}

bool ControlLoop::reads_bodies() const {
  return std::any_of(controller_.reads.begin(), controller_.reads.end(), [](const Reading& r) {
    return !std::holds_alternative<JointSensor>(r.sensor);
  });
}

bool ControlLoop::has_corners() const {
  return !is_sampled() && is_linear() &&
         std::any_of(controller_.limit.begin(), controller_.limit.end(),
                     [](double limit) { return std::isfinite(limit); });
}

VectorOn<AlongOne> ControlLoop::corner_functions(const MovingLoop& loop) const {
  VectorOn<AlongOne> u;
  VectorOn<AlongOne> dx;
  apply_law(loop.t, loop.errors, loop.memory, u, dx);
  std::vector<AlongOne> all;
  for (int i = 0; i < outputs(); ++i) {
    const double limit = controller_.limit[static_cast<std::size_t>(i)];
    if (!std::isfinite(limit)) continue;
    all.insert(all.end(), {u[i] - limit, u[i] + limit});
    if (integral_ == 0) continue;
    const double faded = limit * (1 + fading);
    all.insert(all.end(), {u[i] - faded, u[i] + faded});
    if (loop.errors.size() > 0) all.push_back(loop.errors[i]);
  }
  return Eigen::Map<VectorOn<AlongOne>>(all.data(), static_cast<Eigen::Index>(all.size()));
}

double ControlLoop::corner_rounding(const MovingLoop& loop) const {
  double sum = 0;
  for (Eigen::Index k = 0; k < loop.memory.size(); ++k) {
    sum += law_.C.col(k).cwiseAbs().sum() * std::abs(loop.memory[k].value());
  }
  for (Eigen::Index k = 0; k < loop.errors.size(); ++k) {
    // An error is the difference of the reference and a reading.
    double size = std::abs(loop.errors[k].value());
    if (!controller_.reference.empty()) {
      const Signal<double>& reference = controller_.reference[static_cast<std::size_t>(k)];
      size += 2 * std::abs(reference(loop.t.value()));
    }
    sum += (1 + law_.D.col(k).cwiseAbs().sum()) * size;
  }
  constexpr double digits = 1e-14;
  return digits * sum;
}

std::vector<Corner> ControlLoop::corners(const MovingLoop& along, const MovingLoop& in_time) const {
  const VectorOn<AlongOne> functions = corner_functions(along);
  const VectorOn<AlongOne> at_rest = corner_functions(in_time);
  const double rounding = corner_rounding(along);
  std::vector<Corner> result;
  for (Eigen::Index i = 0; i < functions.size(); ++i) {
    result.push_back({functions[i].value(), functions[i].derivatives()[0],
                      at_rest[i].derivatives()[0], rounding});
  }
  return result;
}

VectorXd ControlLoop::initial() const {
  const VectorXd& given = callable_ ? callable_->initial : law_.initial;
  const Eigen::Index n = given.size() > 0 ? given.size() : states();
  VectorXd memory = VectorXd::Zero(n + memory_size() - states());
  memory.head(given.size()) = given;
  return memory;
}

std::vector<std::string> ControlLoop::memory_names() const {
  std::vector<std::string> names;
  for (int i = 1; i <= states(); ++i) names.push_back(name() + " state " + std::to_string(i));
  if (!is_sampled()) return names;
  for (int k = 1; k <= waiting_; ++k) {
    for (const Actuator& actuator : actuators_) {
      names.push_back(name() + " waiting " + std::to_string(k) + " for " + short_name(actuator));
    }
  }
  for (const Actuator& actuator : actuators_) {
    names.push_back(name() + " output " + short_name(actuator));
  }
  return names;
}

void ControlLoop::append_sample_times(double begin, double end, std::vector<double>& times) const {
  if (!is_sampled()) return;
  reads_at_.append(begin, end, times);
  if (late_) late_->append(begin, end, times);
}

}  // namespace kreisel::detail
