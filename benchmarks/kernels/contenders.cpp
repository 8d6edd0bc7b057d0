#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <random>

#include <dynamics/inertia.hpp>
#include <motor/displacement.hpp>

#include "contender.hpp"

namespace kernels {

namespace {

/// Angles between a third of a radian and three, where no contender uses a series.
All random_numbers() {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  const auto fill = [&](auto& numbers) {
    for (double& x : numbers) x = normal(random);
  };
  const auto turn = [&](std::array<double, 6>& a) {
    do {
      fill(a);
    } while (std::abs(std::hypot(a[0], a[1], a[2]) - 1.6) > 1.3);
  };
  const auto pose = [&] {
    std::array<double, 6> a{};
    turn(a);
    const ::kreisel::Pose<> X = exp(::kreisel::Motor<>{{a[0], a[1], a[2]}, {a[3], a[4], a[5]}});
    std::array<double, 12> numbers{};
    std::copy(X.rotation.data(), X.rotation.data() + 9, numbers.begin());
    std::copy(X.translation.begin(), X.translation.end(), numbers.begin() + 9);
    return numbers;
  };
  All all;
  for (Numbers& n : all) {
    turn(n.a);
    fill(n.b);
    n.pose = pose();
    n.other = pose();
    n.mass = 2;
    fill(n.centre);
    n.tensor_about_centre = {1, 2, 2.5, 0.1, 0.2, 0.3};
    const auto& [xx, yy, zz, xy, xz, yz] = n.tensor_about_centre;
    const ::kreisel::Inertia<> T =
        ::kreisel::Pose<>{::kreisel::Matrix3<double>::Identity(),
                          {n.centre[0], n.centre[1], n.centre[2]}} *
        ::kreisel::Inertia<>{n.mass, {0, 0, 0}, {xx, yy, zz, xy, xz, yz}};
    const auto& s = T.first_moment;
    const auto& t = T.tensor;
    n.inertia = {T.mass, s.x(), s.y(), s.z(), t.xx, t.yy, t.zz, t.xy, t.xz, t.yz};
  }
  return all;
}

}  // namespace

std::vector<Contender> contenders() {
  const All numbers = random_numbers();
  std::vector<Contender> all = kreisel(numbers);
  const auto add = [&](std::vector<Contender> more) {
    std::move(more.begin(), more.end(), std::back_inserter(all));
  };
  add(by_hand(numbers));
  add(eigen(numbers));
#ifdef KERNELS_WITH_KDL
  add(kdl(numbers));
#endif
#ifdef KERNELS_WITH_SIMBODY
  add(simbody(numbers));
#endif
  return all;
}

}  // namespace kernels
