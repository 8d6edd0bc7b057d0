#include <cmath>
#include <cstddef>
#include <span>

#include <dynamics/solve/rounding_growth.hpp>

namespace kreisel::detail {

RoundingGrowth::RoundingGrowth(const RunMaker& maker, const Levels& levels, double accuracy)
    : stop_(maker.options().stop),
      calm_(maker.stepped(levels, {accuracy})),
      calm_state_(maker.start()),
      perturbed_state_(maker.start()),
      distance_(maker.scene().blocks(), maker.options().absolute_scale) {
  calm_->cross_corners_by(rules::corner_width_perturbed);
  double digits = rules::perturbed_digits;
  for (auto& run : perturbed_) {
    run = maker.stepped(levels, {.accuracy = accuracy, .perturbed = digits});
    digits += 1;  // other digits, another direction
  }
}

double RoundingGrowth::at(double t, double end) {
  if (gave_up_) return 0;
  try {
    const double off = distance_at(t, end);
    gave_up_ = !std::isfinite(off);
    return gave_up_ ? 0 : Levels::rounding_of(off);
  } catch (const StopRequested&) {
    throw;
  } catch (...) {  // an exception of a load or guide here must not end the run
    gave_up_ = true;
    return 0;
  }
}

double RoundingGrowth::distance_at(double t, double end) {
  while (!calm_->covers(t)) {
    stop_if_requested(stop_);
    calm_->step(end, t);
    for (const auto& run : perturbed_) run->follow(*calm_);
  }
  calm_->read(t, calm_state_.data());
  const auto components = [](const Eigen::VectorXd& y) {
    return std::span<const double>(y.data(), static_cast<std::size_t>(y.size()));
  };
  double off = 0;
  for (const auto& run : perturbed_) {
    run->read(t, perturbed_state_.data());
    off = max_or_nan(off, distance_(components(calm_state_), components(perturbed_state_)));
  }
  return off;
}

double RoundingGrowth::evaluations() const {
  double sum = calm_->effort().evaluations;
  for (const auto& run : perturbed_) sum += run->effort().evaluations;
  return sum;
}

void RoundingGrowth::pass(Checkpoint& checkpoint) {
  checkpoint(distance_, gave_up_);
  calm_->pass(checkpoint);
  for (const auto& run : perturbed_) run->pass(checkpoint);
}

}  // namespace kreisel::detail
