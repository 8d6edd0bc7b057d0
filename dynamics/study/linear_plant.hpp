#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <complex>
#include <cstddef>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <dynamics/control/controlled_system.hpp>
#include <dynamics/study/linearize.hpp>
#include <dynamics/study/sampled_transition.hpp>
#include <motor/api.hpp>

namespace kreisel {

/// An influence on a plant.
struct PlantInput {
  struct Reference {
    std::size_t controller = 0;
    int component = 0;
  };
  /// A small rotation of the guide about one of its axes, with its rate and acceleration: the input
  /// is the angle, or, for `is_rate`, its rate.
  struct GuideTurn {
    int axis = 0;
    bool is_rate = false;
  };
  /// The inertial acceleration of the guide's origin along one of the guide's axes.
  struct GuideAcceleration {
    int axis = 0;
  };

  std::string name = {};
  std::string unit = {};
  std::variant<Actuator, Reference, GuideTurn, GuideAcceleration> kind = Actuator{};
};

/// A number that a plant shows.
struct PlantOutput {
  /// An output of a controller.
  struct OfController {
    std::size_t controller = 0;
    int component = 0;
  };

  std::string name = {};
  std::string unit = {};
  std::variant<Reading, OfController> kind = Reading{};
};

/// The linear equations of a system with inputs and outputs about a steady state, eta being small
/// deviations (study/tangent.hpp):
///
///   eta' = A eta + sum_j B_j d^p u/dt^p,   y = C eta + sum_j D_j d^p u/dt^p
///
/// An input may have several columns, for its derivatives and its integral: an angle of the guide
/// acts by itself, its rate (p = 1) and its acceleration (p = 2).
///
/// With sampled controllers, eta jumps at sample times:  eta+ = J eta + sum_j G_j d^p u/dt^p.
///
/// Units : those of the state, the inputs and the outputs, SI and radian
struct LinearPlant {
  struct Column {
    int input = 0;
    int power = 0;  ///< p; -1: the integral of the input
    Eigen::VectorXd B = {};
    Eigen::VectorXd D = {};
    std::vector<Eigen::VectorXd> G = {};  ///< for each sample
  };
  /// A jump at a time since the begin of the period, 0 < time <= period.
  struct Sample {
    double time = 0;
    Eigen::MatrixXd J = {};
  };

  std::vector<std::string> names = {};  ///< of eta: components that constraints leave free
  std::vector<PlantInput> inputs = {};
  std::vector<PlantOutput> outputs = {};
  Eigen::MatrixXd A = {};
  Eigen::MatrixXd C = {};
  std::vector<Column> columns = {};
  double period = 0;  ///< of samples; 0: none
  std::vector<Sample> samples = {};

  /// The response to u = e^(i w t): the factor of e^(i w t) in the outputs, a row for each output
  /// and a column for each input. With samples it is the first harmonic: the mean over a period of
  /// y e^(-i w t) in the periodic regime.
  ///
  /// Error  : rounding times the condition of i w - A
  /// Throws : InvalidInput for w <= 0; ComputationFailed at an undamped resonance
  KREISEL_API [[nodiscard]] Eigen::MatrixXcd response(double w) const;
};

/// The matrices of a plant whose inputs are the columns of the plant, but for integrals.
///
/// With samples it is the transition over a period, x_k+1 = A x_k + B u_k, from just after the
/// samples; inputs are held in between. Else it is  x' = A x + B u.
struct StateSpace {
  struct Input {
    std::string name;
    std::string unit;  ///< of the input, not of its derivative
    int power;
  };
  std::vector<Input> inputs = {};
  Eigen::MatrixXd A = {};
  Eigen::MatrixXd B = {};
  Eigen::MatrixXd D = {};
};

KREISEL_API [[nodiscard]] StateSpace state_space(const LinearPlant& plant);

namespace detail {

/// The part of an input's influence that a column of the plant describes.
template <class N>
void seed(const PlantInput& input, int power, const N& unit, ControlDisturbance<N>& outside) {
  const auto set = [&](const auto& kind) {
    using Kind = std::decay_t<decltype(kind)>;
    if constexpr (std::is_same_v<Kind, Actuator>) {
      detail::add(kind, unit, outside.bodies.forces);
    } else if constexpr (std::is_same_v<Kind, PlantInput::Reference>) {
      outside.references[kind.controller][kind.component] += unit;
    } else if constexpr (std::is_same_v<Kind, PlantInput::GuideTurn>) {
      outside.bodies.moves_guide = true;
      const int order = power + (kind.is_rate ? 1 : 0);
      Vector3<N>* const parts[] = {&outside.bodies.guide_turn, &outside.bodies.guide_rate,
                                   &outside.bodies.guide_angular_acceleration};
      (*parts[order])[kind.axis] += unit;
    } else {
      outside.bodies.moves_guide = true;
      outside.bodies.guide_acceleration[kind.axis] += unit;
    }
  };
  std::visit(set, input.kind);
}

/// The columns of all inputs, without their numbers.
[[nodiscard]] KREISEL_API std::vector<LinearPlant::Column> columns_of(
    const std::vector<PlantInput>& inputs);

/// Derivatives of functions of state and disturbance along the moves E and the columns of a plant.
template <class M>
class PlantDerivatives {
  static constexpr int at_once = directions<ControlledSystem<M>>;
  using N = Duals<at_once>;

 public:
  PlantDerivatives(const ControlledSystem<M>& system, const Eigen::VectorXd& y,
                   const Eigen::MatrixXd& E, const LinearPlant& plant)
      : system_(system), y_(y), moves_(E), plant_(plant) {}

  /// function(state, outside) -> numbers; the result has a column for each move, then for each
  /// column of the plant.
  template <class F>
  [[nodiscard]] Eigen::MatrixXd of(Eigen::Index count, const F& function) const {
    const Eigen::Index columns = moves_.cols() + static_cast<Eigen::Index>(plant_.columns.size());
    Eigen::MatrixXd result(count, columns);
    for (Eigen::Index begin = 0; begin < columns; begin += at_once) {
      VectorOn<N> state(y_.size());
      for (Eigen::Index i = 0; i < y_.size(); ++i) state[i] = N(y_[i]);
      ControlDisturbance<N> outside = undisturbed();
      const Eigen::Index end = std::min<Eigen::Index>(begin + at_once, columns);
      for (Eigen::Index k = begin; k < end; ++k) move(k, k - begin, state, outside);
      const VectorOn<N> numbers = function(state, outside);
      for (Eigen::Index k = begin; k < end; ++k) {
        for (Eigen::Index i = 0; i < count; ++i) {
          result(i, k) = numbers[i].derivatives()[k - begin];
        }
      }
    }
    return result;
  }

 private:
  [[nodiscard]] ControlDisturbance<N> undisturbed() const {
    ControlDisturbance<N> outside;
    outside.bodies.forces.joint_force = VectorOn<N>::Constant(system_.tree().rates(), N(0));
    for (const ControlLoop& loop : system_.loops()) {
      outside.references.push_back(VectorOn<N>::Constant(loop.inputs(), N(0)));
    }
    return outside;
  }

  void move(Eigen::Index column, Eigen::Index derivative, VectorOn<N>& state,
            ControlDisturbance<N>& outside) const {
    if (column < moves_.cols()) {
      for (Eigen::Index i = 0; i < y_.size(); ++i) {
        state[i].derivatives()[derivative] = moves_(i, column);
      }
      return;
    }
    const auto& own = plant_.columns[static_cast<std::size_t>(column - moves_.cols())];
    N unit(0);
    unit.derivatives()[derivative] = 1;
    seed(plant_.inputs[static_cast<std::size_t>(own.input)], own.power, unit, outside);
  }

  const ControlledSystem<M>& system_;
  const Eigen::VectorXd& y_;
  const Eigen::MatrixXd& moves_;
  const LinearPlant& plant_;
};

/// The outputs of a plant in dual numbers.
template <class M, class N>
[[nodiscard]] VectorOn<N> plant_outputs(const ControlledSystem<M>& system,
                                        const std::vector<PlantOutput>& outputs, double t,
                                        const VectorOn<N>& y,
                                        const ControlDisturbance<N>& outside) {
  VectorOn<N> result(static_cast<Eigen::Index>(outputs.size()));
  for (Eigen::Index i = 0; i < result.size(); ++i) {
    const PlantOutput& output = outputs[static_cast<std::size_t>(i)];
    if (const auto* const reading = std::get_if<Reading>(&output.kind)) {
      result[i] = system.numbers({*reading}, N(t), y, outside)[0];
    } else {
      const auto& of = std::get<PlantOutput::OfController>(output.kind);
      result[i] = system.outputs(of.controller, N(t), y, outside)[of.component];
    }
  }
  return result;
}

}  // namespace detail

/// The linear plant of a system about a state in which steady_rates() are 0, but for cyclic
/// coordinates: exact, by dual numbers.
///
/// free   : the components of the plant's state, as of detail::free_directions()
/// Throws : as linearize() and sampled_transition()
template <class M>
[[nodiscard]] LinearPlant linear_plant(const ControlledSystem<M>& system, double t,
                                       const Eigen::VectorXd& y, std::vector<PlantInput> inputs,
                                       std::vector<PlantOutput> outputs, FreeDirections free) {
  using detail::VectorOn;
  LinearPlant plant;
  plant.inputs = std::move(inputs);
  plant.outputs = std::move(outputs);
  plant.columns = detail::columns_of(plant.inputs);
  const Tangent tangent = detail::tangent_of(system, y.size(), {});
  const detail::Reduced r =
      detail::reduced(system, t, y, tangent, detail::InTime::no, std::move(free));
  std::vector<int> kept = r.free.independent;
  Eigen::MatrixXd E = tangent.basis(y);
  if (r.free.bound()) {
    E *= r.free.N;
  } else {
    for (int i = 0; i < tangent.dimension(); ++i) kept.push_back(i);
  }
  const auto names = detail::names_of(system, tangent);
  for (const int i : kept) plant.names.push_back(names[static_cast<std::size_t>(i)]);
  plant.A = r.A(kept, kept);
  const Eigen::MatrixXd P = tangent.inverse(y)(kept, Eigen::all);
  const Eigen::Index n = E.cols();
  const detail::PlantDerivatives<M> along(system, y, E, plant);

  const Eigen::MatrixXd of_rates =
      P * along.of(y.size(), [&](const auto& state, const auto& outside) {
        using N = typename std::decay_t<decltype(state)>::Scalar;
        return system.rates(N(t), state, outside);
      });
  const auto shown = static_cast<Eigen::Index>(plant.outputs.size());
  const Eigen::MatrixXd of_outputs = along.of(shown, [&](const auto& state, const auto& outside) {
    return detail::plant_outputs(system, plant.outputs, t, state, outside);
  });
  plant.C = of_outputs.leftCols(n);
  const auto column = [n](std::size_t k) { return n + static_cast<Eigen::Index>(k); };
  for (std::size_t k = 0; k < plant.columns.size(); ++k) {
    plant.columns[k].B = of_rates.col(column(k));
    plant.columns[k].D = of_outputs.col(column(k));
  }
  if (!system.has_samples()) return plant;

  const auto [first, period] = detail::sample_period(system, t);
  plant.period = period;
  for (const double now : system.sample_times(first, first + period)) {
    const Eigen::MatrixXd of_sample = P * along.of(y.size(), [&](auto state, const auto& outside) {
      using N = typename std::decay_t<decltype(state)>::Scalar;
      system.sample(N(now), state, outside);
      return state;
    });
    plant.samples.push_back({now - first, of_sample.leftCols(n)});
    for (std::size_t k = 0; k < plant.columns.size(); ++k) {
      plant.columns[k].G.push_back(of_sample.col(column(k)));
    }
  }
  return plant;
}

/// The same with components that are free at y.
template <class M>
[[nodiscard]] LinearPlant linear_plant(const ControlledSystem<M>& system, double t,
                                       const Eigen::VectorXd& y, std::vector<PlantInput> inputs,
                                       std::vector<PlantOutput> outputs) {
  const Tangent tangent = detail::tangent_of(system, y.size(), {});
  return linear_plant(system, t, y, std::move(inputs), std::move(outputs),
                      detail::free_directions(system, y, tangent.basis(y)));
}

}  // namespace kreisel
