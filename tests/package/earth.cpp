// Normal gravity at the equator, by the library behind kreisel::earth.
#include <iostream>

#include <dynamics/guide/normal_gravity.hpp>

int main() {
  const double g = kreisel::normal_gravity({}).magnitude;
  std::cout << g << '\n';
  return g > 9.780 && g < 9.781 ? 0 : 1;
}
