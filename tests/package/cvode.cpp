// An exponential decay by CVODE's steps.
#include <cmath>
#include <iostream>

#include <dynamics/step/cvode.hpp>

int main() {
  using Vector = Eigen::Matrix<double, 1, 1>;
  const auto decays = [](double, const Vector& y) { return Vector(-y); };
  kreisel::CvodeSteps steps(kreisel::CvodeMethod::bdf, decays, 0.0, Vector(1.0),
                            {.relative = 1e-8});
  const double left = steps.advance_to(1)[0];
  std::cout << left << '\n';
  return std::abs(left - std::exp(-1)) < 1e-6 ? 0 : 1;
}
