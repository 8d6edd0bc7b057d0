#include <Eigen/Core>

#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

#include <dynamics/step/radau_coefficients.hpp>
#include <motor/complex.hpp>
#include <motor/double_double_functions.hpp>

namespace kreisel {

namespace detail::radau {

using Real = DoubleDouble;
using Value = ComplexOf<Real>;
using Reals = std::vector<Real>;

[[nodiscard]] inline Real number(std::size_t i) { return Real(i); }

/// Legendre's P_n and P_n-1 at x, n > 0.
[[nodiscard]] inline std::array<Real, 2> legendre(std::size_t n, Real x) {
  Real before = 1, P = x;
  for (std::size_t k = 1; k < n; ++k) {
    const Real next = (number(2 * k + 1) * x * P - number(k) * before) / number(k + 1);
    before = std::exchange(P, next);
  }
  return {P, before};
}

/// The zeros of P_s - P_s-1, mapped from [-1, 1] to [0, 1]; the last is 1.
[[nodiscard]] inline Reals nodes(std::size_t s) {
  Reals c(s, Real(1));
  for (std::size_t i = 0; i + 1 < s; ++i) {
    Real x = -cos(std::numbers::pi_v<Real> * (number(i) + 0.75) / number(s));
    for (int iteration = 0; iteration < 12; ++iteration) {
      const auto [P, before] = legendre(s, x);
      const Real beyond =
          (number(2 * s - 1) * x * before - number(s) * P) / number(s - 1);  // P_s-2
      const auto slope = [&x](std::size_t n, Real P_n, Real P_below) {
        return number(n) * (x * P_n - P_below) / (x * x - 1);
      };
      x -= (P - before) / (slope(s, P, before) - slope(s - 1, before, beyond));
    }
    c[i] = (1 + x) / 2;
  }
  return c;
}

/// The derivatives at x, from the 0th on, of (x - root_1) ... (x - root_count).
[[nodiscard]] inline Reals derivatives(const Reals& roots, std::size_t count, Real x) {
  Reals p{1};  // in powers of the increment of x
  for (std::size_t i = 0; i < count; ++i) {
    p.insert(p.begin(), Real(0));
    for (std::size_t k = 0; k + 1 < p.size(); ++k) p[k] += (x - roots[i]) * p[k + 1];
  }
  Real factorial = 1;
  for (std::size_t k = 1; k <= count; ++k) p[k] *= factorial *= number(k);
  return p;
}

/// sum_k derivative_k lambda^(n - k), with n the last k
[[nodiscard]] inline Value homogeneous(const Reals& derivative, const Value& lambda) {
  Value sum = Real(0);
  for (const Real d : derivative) sum = sum * lambda + d;
  return sum;
}

/// The zeros of homogeneous(derivative, lambda), by the method of Durand and Kerner.
[[nodiscard]] inline std::vector<Value> zeros(const Reals& derivative) {
  const std::size_t s = derivative.size() - 1;
  std::vector<Value> z(s);
  for (std::size_t i = 0; i < s; ++i) {
    const Real angle = 2 * std::numbers::pi_v<Real> * (number(i) + 0.3) / number(s);
    z[i] = number(s) * Value(cos(angle), sin(angle));
  }
  for (int iteration = 0; iteration < 100; ++iteration) {
    for (std::size_t i = 0; i < s; ++i) {
      Value change = homogeneous(derivative, z[i]) / derivative[0];
      for (std::size_t j = 0; j < s; ++j) {
        if (j != i) change /= z[i] - z[j];
      }
      z[i] -= change;
    }
  }
  return z;
}

}  // namespace detail::radau

RadauCoefficients::RadauCoefficients(int stages)
    : node(stages), inverse(stages, stages), error(stages) {
  using namespace detail::radau;
  const auto s = static_cast<std::size_t>(stages);
  const auto at = [](std::size_t i) { return static_cast<Eigen::Index>(i); };

  const Reals c = nodes(s);
  Reals weight(s);  // b of the quadrature
  for (std::size_t i = 0; i < s; ++i) {
    const Real P = legendre(s, 2 * c[i] - 1)[1];
    weight[i] = s == 1 ? 1 : c[i] / (number(s * s) * P * P);
    node[at(i)] = static_cast<double>(c[i]);
  }

  // Barycentric weights of Lagrange's polynomials through 0 and the nodes: 1/(c_j prod (c_j -
  // c_i)).
  Reals barycentric(s);
  for (std::size_t j = 0; j < s; ++j) {
    barycentric[j] = 1 / c[j];
    for (std::size_t i = 0; i < s; ++i) {
      if (i != j) barycentric[j] /= c[j] - c[i];
    }
  }
  std::vector<Reals> slope(s, Reals(s));  // derivative of the j-th at c_i: A^-1
  for (std::size_t i = 0; i < s; ++i) {
    slope[i][i] = 1 / c[i];
    for (std::size_t j = 0; j < s; ++j) {
      if (j == i) continue;
      slope[i][i] += 1 / (c[i] - c[j]);
      slope[i][j] = barycentric[j] / barycentric[i] / (c[i] - c[j]);
    }
    for (std::size_t j = 0; j < s; ++j) inverse(at(i), at(j)) = static_cast<double>(slope[i][j]);
  }

  Real real_value = 0;
  for (const Value& lambda : zeros(derivatives(c, s, 0))) {
    const bool is_real = abs(lambda.imag()) < 1e-12 * abs(lambda);
    if (!is_real && lambda.imag() < 0) continue;
    std::vector<Value> v(s), w(s);
    Value product = Real(0);
    for (std::size_t i = 0; i < s; ++i) {
      v[i] = homogeneous(derivatives(c, s, c[i]), lambda);
      w[i] = weight[i] * homogeneous(derivatives(c, s - 1, c[i]), -lambda);
      product += w[i] * v[i];
    }
    const auto fill = [&]<class Number>(Mode<Number>& mode, const auto& in_double) {
      mode.eigenvalue = in_double(lambda);
      mode.vector.resize(stages);
      mode.covector.resize(stages);
      for (std::size_t i = 0; i < s; ++i) {
        mode.vector[at(i)] = in_double(v[i]);
        mode.covector[at(i)] = in_double(w[i] / product);
      }
    };
    if (is_real) {
      real_value = lambda.real();
      fill(real, [](const Value& z) { return static_cast<double>(z.real()); });
    } else {
      fill(pairs.emplace_back(), [](const Value& z) {
        return std::complex<double>(static_cast<double>(z.re), static_cast<double>(z.im));
      });
    }
  }

  // A second formula of order s, which gives f(y) the weight 1/real eigenvalue.
  Reals second = weight;
  for (std::size_t j = 0; j < s; ++j) {
    Real at_0 = 1;  // value of Lagrange's polynomial through the nodes alone
    for (std::size_t i = 0; i < s; ++i) {
      if (i != j) at_0 *= c[i] / (c[i] - c[j]);
    }
    second[j] -= at_0 / real_value;
  }
  for (std::size_t j = 0; j < s; ++j) {
    Real e = j + 1 == s ? -1 : 0;
    for (std::size_t i = 0; i < s; ++i) e += second[i] * slope[i][j];
    error[at(j)] = static_cast<double>(real_value * e);
  }
}

}  // namespace kreisel
