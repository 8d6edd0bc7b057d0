#pragma once

#include <Eigen/Core>
#include <boost/test/unit_test.hpp>

#include <string>

#include <support/sample.hpp>
#include <support/worst.hpp>

namespace kreisel::test {

/// Compares a scene's series with its field, which is independent of it. At a part s of the unit of
/// time sum k c_k s^(k-1) = h rates(t + s h, sum c_k s^k). With order 24 and s = 1/4 the truncation
/// error is below rounding.
template <class Scene>
void hold_series(const std::string& what, const Scene& scene, const typename Scene::Vector& y,
                 double h = 0.25, double bound = 2e-15) {
  using Vector = typename Scene::Vector;
  auto series = scene.series();
  constexpr int order = decltype(scene.series())::most_order;
  Eigen::Matrix<double, Vector::RowsAtCompileTime, order + 1> c(y.size(), order + 1);
  const double t = 0.7;
  c.setConstant(1e300);
  c.col(0) = y;
  series(t, h, order, c);
  double worst = 0;
  for (const double s : {0.0, -0.25, 0.125, 0.25}) {
    Vector state = Vector::Zero(y.size());
    Vector slope = Vector::Zero(y.size());
    for (int k = order; k >= 0; --k) {
      slope = slope * s + state;
      state = state * s + c.col(k);
    }
    const Vector rate = h * scene.rates(t + s * h, state);
    worst = worst_of(worst, (slope - rate).norm() / (rate.norm() + h));
  }
  BOOST_TEST_MESSAGE(what << ": " << worst);
  BOOST_TEST(worst <= bound);
}

template <class Scene>
void hold_samples(const std::string& what, const Scene& scene) {
  for (unsigned seed = 0; seed < 4; ++seed) {
    Sample sample(seed);
    typename Scene::Vector y;
    for (int i = 0; i < y.size(); ++i) y[i] = sample.uniform(-1.5, 1.5);
    hold_series(what, scene, y);
  }
}

}  // namespace kreisel::test
