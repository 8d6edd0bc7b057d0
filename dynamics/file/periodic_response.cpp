#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include <dynamics/file/periodic_response.hpp>
#include <dynamics/file/steady_motions.hpp>
#include <dynamics/study/free_directions.hpp>
#include <dynamics/study/harmonic_response.hpp>
#include <motor/error.hpp>

namespace kreisel {

namespace {

using Values = std::vector<std::vector<std::complex<double>>>;

/// The plant without the named components of the state. Nothing may act on them.
LinearPlant without(LinearPlant plant, const std::vector<std::string>& names) {
  std::vector<int> kept;
  std::vector<std::string> kept_names;
  for (int i = 0; i < static_cast<int>(plant.names.size()); ++i) {
    const std::string& name = plant.names[static_cast<std::size_t>(i)];
    if (std::find(names.begin(), names.end(), name) != names.end()) continue;
    kept.push_back(i);
    kept_names.push_back(name);
  }
  plant.names = kept_names;
  plant.A = plant.A(kept, kept).eval();
  plant.C = plant.C(Eigen::all, kept).eval();
  for (LinearPlant::Column& column : plant.columns) column.B = column.B(kept).eval();
  return plant;
}

Values values_of(const PeriodicPlant& plant, const std::vector<double>& frequencies) {
  Values values;
  for (const double w : frequencies) {
    values.emplace_back();
    for (const auto& H : plant.response(w, HarmonicResponse::harmonics)) {
      values.back().push_back(H(0, 0));
    }
  }
  return values;
}

/// The greatest difference, relative to the greatest value of the same frequency.
double difference(const Values& a, const Values& b) {
  double worst = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    double size = 0;
    double change = 0;
    for (std::size_t k = 0; k < a[i].size(); ++k) {
      size = std::max(size, std::abs(b[i][k]));
      change = std::max(change, std::abs(a[i][k] - b[i][k]));
    }
    if (size > 0) worst = std::max(worst, change / size);
  }
  return worst;
}

/// The dependent components of a constrained system that the others determine best, all along a motion.
///
/// Throws : InvalidInput if each choice has a dead centre
class SteadyChoice {
 public:
  SteadyChoice(const StudySystem& system, const std::vector<Eigen::VectorXd>& states)
      : system_(system), tangent_(steady_motion::tangent_of(system, states.front())) {
    if (!detail::is_constrained(system)) return;
    constexpr double least = 1e-6;
    double best = least;
    for (const Eigen::VectorXd& y : states) {
      const FreeDirections free = detail::free_directions(system, y, tangent_.basis(y));
      const double worst = worst_determination(states, free.dependent);
      if (worst <= best) continue;
      best = worst;
      dependent_ = free.dependent;
    }
    if (best > least) return;
    throw InvalidInput(
        "periodic plant: constraints leave no coordinate free all along the motion, each has a "
        "dead centre; choose joints so that fewer constraints are needed");
  }

  [[nodiscard]] FreeDirections at(const Eigen::VectorXd& y) const {
    if (!detail::is_constrained(system_)) return {};
    return detail::free_directions(slopes(y), dependent_);
  }

 private:
  [[nodiscard]] Eigen::MatrixXd slopes(const Eigen::VectorXd& y) const {
    return system_.constraint_slopes(y, tangent_.basis(y));
  }
  [[nodiscard]] double worst_determination(const std::vector<Eigen::VectorXd>& states,
                                           const std::vector<int>& dependent) const {
    double worst = 1;
    for (const Eigen::VectorXd& y : states) {
      worst = std::min(worst, detail::determination(slopes(y), dependent));
    }
    return worst;
  }

  const StudySystem& system_;
  Tangent tangent_;
  std::vector<int> dependent_ = {};
};

}  // namespace

HarmonicResponse harmonic_response(const StudySystem& system, const FloquetMotion& motion,
                                   const PlantInput& input, const PlantOutput& output,
                                   const std::vector<double>& frequencies) {
  std::vector<std::string> given;
  for (const int i : steady_motion::list(steady_motion::Directions(system).given)) {
    given.push_back(motion.names[static_cast<std::size_t>(i)]);
  }
  HarmonicResponse response;
  response.period = motion.period;
  for (int parts = 16; parts <= 128; parts *= 2) {
    std::vector<LinearPlant> samples;
    const std::vector<Eigen::VectorXd> states = states_of(system, motion, parts);
    const SteadyChoice choice(system, states);
    for (const Eigen::VectorXd& y : states) {
      const double share = static_cast<double>(samples.size()) / parts;
      samples.push_back(without(
          system.plant(system.begin() + share * motion.period, y, {input}, {output}, choice.at(y)),
          given));
    }
    Values values = values_of(PeriodicPlant(motion.period, samples), frequencies);
    if (parts > 16) response.error = difference(response.values, values);
    response.values = std::move(values);
    if (parts > 16 && response.error < 1e-9) break;
  }
  return response;
}

}  // namespace kreisel
