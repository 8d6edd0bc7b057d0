#pragma once

#include "cases.hpp"

namespace pruning {

/// The greatest difference of two forms, relative to the greatest rate of an angle or position, or
/// of a velocity. The two halves of the states are compared apart.
[[nodiscard]] inline double difference(const Form& form, const Form& reference) {
  double worst = 0;
  const auto compare = [&worst](const auto& found, const auto& expected) {
    const double relative =
        (found - expected).cwiseAbs().maxCoeff() / expected.cwiseAbs().maxCoeff();
    if (!(relative <= worst)) worst = relative;  // a NaN too
  };
  for (std::size_t i = 0; i < inputs; ++i) {
    const Eigen::VectorXd found = form.rates(i);
    const Eigen::VectorXd expected = reference.rates(i);
    const Eigen::Index velocities = expected.size() / 2;
    compare(found.tail(velocities), expected.tail(velocities));
    const Eigen::Index places = expected.size() - velocities;
    compare(found.head(places), expected.head(places));
  }
  return worst;
}

}  // namespace pruning
