#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <stop_token>
#include <utility>
#include <variant>

#include <dynamics/file/log_error.hpp>
#include <dynamics/file/measured.hpp>
#include <dynamics/guide/log_noise.hpp>
#include <dynamics/solve/error_measure.hpp>
#include <dynamics/step/stop.hpp>
#include <motor/error.hpp>

namespace kreisel {

using Eigen::VectorXd;

namespace {

/// The end of a run.
struct End {
  JointState state;
  JointReactions reactions;
};

LogError::Joint joint_distance(const BodyTree& tree, int body, const End& a, const End& b) {
  const auto [q, q_count, v, v_count] = tree.place(body);
  LogError::Joint off;
  if (q_count < 4) {
    for (int k = 0; k < q_count; ++k) {
      off.coordinates.push_back(std::abs(a.state.coordinates[q + k] - b.state.coordinates[q + k]));
      off.rates.push_back(std::abs(a.state.rates[v + k] - b.state.rates[v + k]));
    }
  } else {
    off.coordinates.push_back(
        attitude(tree, body, a.state).angularDistance(attitude(tree, body, b.state)));
    off.rates.push_back((a.state.rates - b.state.rates).segment<3>(v).norm());
    if (q_count == 7) {
      off.coordinates.push_back((place(tree, body, a.state) - place(tree, body, b.state)).norm());
      off.rates.push_back((a.state.rates - b.state.rates).segment<3>(v + 3).norm());
    }
  }
  const auto i = static_cast<std::size_t>(body);
  const auto force = a.reactions.on_body[i].value - b.reactions.on_body[i].value;
  off.force = force.resultant.norm();
  off.torque = force.moment.norm();
  return off;
}

/// Calls `visit` with each number of an error, in a fixed order.
template <class Visit>
void visit_numbers(LogError& error, const Visit& visit) {
  visit(error.worst);
  for (LogError::Joint& joint : error.joints) {
    for (double& x : joint.coordinates) visit(x);
    for (double& x : joint.rates) visit(x);
    visit(joint.force);
    visit(joint.torque);
  }
}

VectorXd numbers_of(LogError error) {
  std::vector<double> numbers;
  visit_numbers(error, [&](double& x) { numbers.push_back(x); });
  return Eigen::Map<VectorXd>(numbers.data(), static_cast<Eigen::Index>(numbers.size()));
}

void set_numbers(LogError& error, const VectorXd& numbers) {
  Eigen::Index next = 0;
  visit_numbers(error, [&](double& x) { x = numbers[next++]; });
}

/// Computes runs along other readings of the logs and compares their ends with the given run.
class Beside {
 public:
  Beside(const SceneSolver& model, const Trajectory<JointState>& run, std::stop_token stop)
      : model_(model),
        run_(run),
        stop_(std::move(stop)),
        end_{run.states.back(), model.reactions(run.times.back(), run.states.back())} {}

  /// The end of a run along another guide.
  [[nodiscard]] End end_of(const SceneFile& scene, double tolerance) const {
    const std::unique_ptr<SceneSolver> other = make_model(scene);
    SolveOptions options;
    options.begin = scene.t_begin;
    options.output_times = {run_.times.back()};
    options.tolerance = tolerance;
    options.discontinuities = scene.discontinuities;
    options.method = method_named(run_.report.method).value_or(Method::automatic);
    options.stop = stop_;
    const auto beside = other->solve(options, start_of(scene));
    if (stop_.stop_requested()) throw StopRequested{};
    if (beside.report.status != RunStatus::complete) {
      throw ComputationFailed("error of the log: a run beside failed: " + beside.report.message);
    }
    const JointState& state = beside.states.back();
    return {state, other->reactions(options.output_times.back(), state)};
  }

  /// The distance between two ends.
  [[nodiscard]] LogError distance(const End& a, const End& b) const {
    ErrorMeasure<Measured> measure({model_.tree().blocks()}, 1e-3);
    for (const JointState& passed : run_.states) (void)measure(joined(passed), joined(passed));
    LogError error;
    if (joined(a.state).size() > 0) error.worst = measure(joined(a.state), joined(b.state));
    for (int i = 0; i < static_cast<int>(end_.reactions.on_body.size()); ++i) {
      error.joints.push_back(joint_distance(model_.tree(), i, a, b));
    }
    return error;
  }

  [[nodiscard]] const End& end() const { return end_; }

 private:
  const SceneSolver& model_;
  const Trajectory<JointState>& run_;
  std::stop_token stop_;
  End end_;
};

/// Squares of the errors due to the log of one link; nothing if the link follows no log.
std::optional<VectorXd> squares_of_link(const SceneFile& scene, std::size_t i, const Beside& beside,
                                        double tolerance) {
  const auto along = [&](const auto& link) -> std::optional<VectorXd> {
    if constexpr (requires { link.log; }) {
      const VectorXd error = error_of_log(
          link.log, link.spline, beside.end(),
          [&](const auto& log, const LogSpline& spline) {
            auto other_link = link;
            other_link.log = log;
            other_link.spline = spline;
            SceneFile other = scene;
            other.guide[i] = other_link;
            return beside.end_of(other, tolerance);
          },
          [&](const End& a, const End& b) { return numbers_of(beside.distance(a, b)); });
      return error.cwiseAbs2();
    } else {
      return std::nullopt;
    }
  };
  return std::visit(along, scene.guide[i]);
}

/// Squares of the errors due to the log of one function of time.
VectorXd squares_of_signal(const SceneFile& scene, std::size_t i, const Beside& beside,
                           double tolerance) {
  const auto follow = [&](const ValueLog& log, const LogSpline& spline) {
    std::vector<SceneSignalLog> logs = scene.signal_logs;
    logs[i].log = log;
    logs[i].spline = spline;
    return beside.end_of(scene.with_signal_logs(std::move(logs)), tolerance);
  };
  const SceneSignalLog& own = scene.signal_logs[i];
  return error_of_log(own.log, own.spline, beside.end(), follow,
                      [&](const End& a, const End& b) { return numbers_of(beside.distance(a, b)); })
      .cwiseAbs2();
}

}  // namespace

std::optional<LogError> error_of_logs(const SceneFile& scene, const SceneSolver& model,
                                      const Trajectory<JointState>& run,
                                      const std::stop_token& stop) {
  if (!scene.follows_log()) return LogError{};
  const Beside beside(model, run, stop);
  LogError error = beside.distance(beside.end(), beside.end());
  // A large error shows at a coarse tolerance as well.
  constexpr double coarse = 1e-6;
  double tolerance = std::max(coarse, scene.tolerance);
  try {
    while (true) {
      VectorXd squares = VectorXd::Zero(numbers_of(error).size());
      for (std::size_t i = 0; i < scene.guide.size(); ++i) {
        const auto of_link = squares_of_link(scene, i, beside, tolerance);
        if (of_link) squares += *of_link;
      }
      for (std::size_t i = 0; i < scene.signal_logs.size(); ++i) {
        squares += squares_of_signal(scene, i, beside, tolerance);
      }
      set_numbers(error, squares.cwiseSqrt());
      const bool moves = model.tree().rates() > 0;
      if (!moves || error.worst > 30 * tolerance || tolerance == scene.tolerance) return error;
      tolerance = scene.tolerance;
    }
  } catch (const StopRequested&) {
    return std::nullopt;
  }
}

}  // namespace kreisel
