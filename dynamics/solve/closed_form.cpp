#include <cmath>
#include <limits>
#include <optional>

#include <dynamics/exact/free_top.hpp>
#include <dynamics/exact/gyrostat.hpp>
#include <dynamics/exact/lagrange_top.hpp>
#include <dynamics/solve/closed_form.hpp>

namespace kreisel {

std::optional<ClosedForm<EulerTop::State>> closed_form(const EulerTop& top, double begin,
                                                       const EulerTop::State& start) {
  const Vector3<double>& I = top.moments();
  const Vector3<double>& k = top.weight_moment();
  const Vector3<double>& h = top.rotor_momentum();
  const Eigen::Quaterniond& q = start.attitude;
  const Vector3<double>& w = start.angular_velocity;
  const bool free = k.isZero(0);
  const bool rotor = !h.isZero(0);
  const bool symmetric = I.x() == I.y();
  const auto along_z = [](const Vector3<double>& v) { return v.x() == 0 && v.y() == 0; };

  const auto made = [&](const char* name, const auto& motion, double taken_off = 0) {
    // The angle of rotation is rate times time, with the least moment of inertia.
    const double rate =
        (I.cwiseProduct(w) + h).norm() / I.minCoeff() + std::sqrt(k.norm() / I.minCoeff());
    return ClosedForm<EulerTop::State>{
        name,
        [motion, begin](double t) {
          const exact::TopMotion m = motion.at(t - begin);
          return EulerTop::State{m.attitude, m.angular_velocity};
        },
        [rate, begin, taken_off](double t, double /*smallest*/) {
          constexpr double u = std::numeric_limits<double>::epsilon() / 2;
          const double angle = rate * std::abs(t - begin) + taken_off;
          return 3 * u + 0x1p-67 * angle;
        }};
  };
  if (free && !rotor) return made("free top, elliptic functions", exact::FreeTop(I, w, q));
  const bool rotor_on_an_axis = (h.array() != 0).count() == 1;
  if (free && rotor_on_an_axis) {
    return made("gyrostat, elliptic functions", exact::Gyrostat(I, h, w, q));
  }
  if (!rotor && symmetric && along_z(k) && k.z() > 0) {
    const exact::LagrangeTop motion(I.x(), I.z(), k.z(), w, q);
    const double taken_off = 8 * motion.starting_angle();
    return made("Lagrange's top, elliptic functions", motion, taken_off);
  }
  return std::nullopt;
}

}  // namespace kreisel
