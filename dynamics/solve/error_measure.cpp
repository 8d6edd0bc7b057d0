#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include <dynamics/solve/error_measure.hpp>
#include <dynamics/step/accuracy.hpp>

namespace kreisel::detail {

double BlockDistance::operator()(std::span<const double> a, std::span<const double> b) {
  using Components = Eigen::Map<const Eigen::VectorXd>;
  const auto count = static_cast<Eigen::Index>(a.size());
  const Components y(b.data(), count);
  difference_ = Components(a.data(), count) - y;
  const auto attitude_at = [](std::span<const double> v, int begin) {
    return Eigen::Vector4d(v.data() + begin);
  };
  double worst = 0;
  int begin = 0;
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    const int n = blocks_[i];
    const bool attitude = n == 4;
    if (attitude) {
      const Eigen::Vector4d p = attitude_at(a, begin);
      const Eigen::Vector4d q = attitude_at(b, begin);
      // For unit quaternions |p -+ q| / 2 is the sine of a quarter of the angle between them.
      const Eigen::Vector4d unit_p = p.stableNormalized();
      Eigen::Vector4d unit_q = q.stableNormalized();
      if (unit_p.dot(unit_q) < 0) unit_q = -unit_q;
      worst = max_or_nan(worst, 4 * std::asin(std::min(1.0, (unit_p - unit_q).norm() / 2)));
    } else {
      const double off = norm(difference_, begin, n);
      size_[i] = std::max(size_[i], norm(y, begin, n));
      worst = max_or_nan(worst, off == 0 ? 0 : off / size_[i]);
    }
    begin += n;
  }
  return worst;
}

}  // namespace kreisel::detail
