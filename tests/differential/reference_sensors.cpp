#include "reference_numbers.hpp"
#include "reference_tree.hpp"

namespace differential::reference {

Tree::Frame Tree::at_point(int body, const Vec& at, const State& accelerations) const {
  const Pose& b = poses_[static_cast<std::size_t>(body)];
  const Vec arm = b.R * (at - parts_[static_cast<std::size_t>(body)].centre);
  const Vec dw = accelerations.segment<3>(6 * body + 3);
  const Vec a = accelerations.segment<3>(6 * body);
  return {b.R, b.x + arm, b.v + b.w.cross(arm), a + dw.cross(arm) + b.w.cross(b.w.cross(arm)),
          b.w, dw};
}

Tree::Frame Tree::frame(int index, const Motion& guide, const State& accelerations) const {
  const Vec zero = Vec::Zero();
  if (index == inertial_frame) return {Mat::Identity(), -guide.x, -guide.v, -guide.a, zero, zero};
  if (index == guide_frame) return {guide.R, zero, zero, zero, guide.w, guide.dw};
  return at_point(index, zero, accelerations);
}

std::vector<double> Tree::readings(Real t, const State& y) {
  const std::vector<double> carried = reactions(t, y);
  State rate(size_);
  rates(t, y, rate);
  const Motion guide = guide_.at(t, y, rate);
  const State accelerations = solution_.head(static_cast<Eigen::Index>(6 * poses_.size()));
  const State multipliers = solution_.tail(rows_);
  assemble(guide);
  std::vector<double> result;
  const auto put = [&result](const auto& numbers) {
    for (Eigen::Index i = 0; i < numbers.size(); ++i) {
      result.push_back(static_cast<double>(numbers[i]));
    }
  };
  for (const Sensor& sensor : scene_.sensors) {
    const Frame p = at_point(sensor.body, wide(sensor.at), accelerations);
    const Frame own = frame(sensor.body, guide, accelerations);
    const Frame seen = frame(sensor.against, guide, accelerations);
    const Mat axes = unit_quaternion(sensor.axes).toRotationMatrix().transpose();
    switch (sensor.kind) {
      case SensorKind::gyro: put(Vec(axes * (own.R.transpose() * own.w))); break;
      case SensorKind::accelerometer:
        put(Vec(axes * (own.R.transpose() * (p.a + guide.a - guide_.gravity(t, guide, p.x)))));
        break;
      case SensorKind::point: {
        // By the rates of the components r_A = R_A^t r:  W is the skew matrix of the frame.
        const Mat to_axes = frame(sensor.on, guide, accelerations).R.transpose();
        const auto skew = [](const Vec& w) {
          Mat W;
          W << 0, -w.z(), w.y(), w.z(), 0, -w.x(), -w.y(), w.x(), 0;
          return W;
        };
        const Mat W = skew(seen.w);
        const Vec r = p.x - seen.x;
        const Vec dr = p.v - seen.v;
        put(Vec(to_axes * r));
        put(Vec(to_axes * (dr - W * r)));
        put(Vec(to_axes * (p.a - seen.a - 2 * W * dr + (W * W - skew(seen.dw)) * r)));
        break;
      }
      case SensorKind::attitude: put(Quat(Mat(seen.R.transpose() * own.R)).coeffs()); break;
      case SensorKind::reaction: {
        if (sensor.element >= 0 || sensor.constraint >= 0) {
          const auto [force, torque] = sensor.element >= 0
                                           ? element_reading(sensor, y)
                                           : constraint_reading(sensor, multipliers);
          put(Vec(axes * force));
          put(Vec(axes * torque));
          break;
        }
        const double* const six = carried.data() + 6 * sensor.body;
        const Vec force(six[0], six[1], six[2]);
        const Vec torque(six[3], six[4], six[5]);
        put(Vec(axes * force));
        put(Vec(axes * (torque - wide(sensor.at).cross(force))));
      }
    }
  }
  return result;
}

}  // namespace differential::reference
