// A pendulum that swings through a right angle on each side; its elliptic integral is GSL's.
#include <iostream>
#include <numbers>

#include <dynamics/gsl/pendulum.hpp>

int main() {
  const double period = kreisel::exact::PlainPendulum(std::numbers::pi / 2, 1).period();
  std::cout << period << '\n';
  return period > 7.4162 && period < 7.4163 ? 0 : 1;
}
