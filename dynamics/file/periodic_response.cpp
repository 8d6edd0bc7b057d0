#include <algorithm>
#include <cstddef>
#include <string>

#include <dynamics/file/periodic_response.hpp>
#include <dynamics/file/steady_motions.hpp>
#include <dynamics/study/harmonic_response.hpp>

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
    for (const Eigen::VectorXd& y : states_of(system, motion, parts)) {
      const double share = static_cast<double>(samples.size()) / parts;
      samples.push_back(without(
          system.plant(system.begin() + share * motion.period, y, {input}, {output}), given));
    }
    Values values = values_of(PeriodicPlant(motion.period, samples), frequencies);
    if (parts > 16) response.error = difference(response.values, values);
    response.values = std::move(values);
    if (parts > 16 && response.error < 1e-9) break;
  }
  return response;
}

}  // namespace kreisel
