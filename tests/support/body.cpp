#include <Eigen/Geometry>
#include <boost/multiprecision/cpp_bin_float.hpp>

#include <vector>

#include <support/body.hpp>
#include <support/cast.hpp>

namespace kreisel::test {

namespace {

template <class S, class To>
Typed<S> typed(const MovingBody& body, const To& to) {
  const Derivatives& V = body.truth.V_rel.T;
  const Derivatives& F = body.truth.F.T;
  return {{to(body.T)},
          {to(body.truth.V_rel.value)},
          {to(body.truth.F.value)},
          {{to(V.body)}, {to(V.guide)}, {to(V.inertial)}},
          {{to(F.body)}, {to(F.guide)}, {to(F.inertial)}}};
}

}  // namespace

Typed<double> MovingBody::numbers() const {
  return typed<double>(*this, [](const auto& x) { return cast<double>(x); });
}

Typed<Terms> MovingBody::terms() const {
  return typed<Terms>(*this, [](const auto& x) {
    const auto size = test::terms(cast<double>(x));
    if constexpr (requires { size.moment; }) {
      const Vector3<Terms> zero = Vector3<Terms>::Constant(1e-30);
      return size + Motor<Terms>{zero, zero};
    } else {
      return size;
    }
  });
}

Motor<> MovingBody::force() const { return cast<double>(truth.force); }

MovingBody moving_body(unsigned seed) {
  Sample sample(seed);
  const std::vector<PointMass> masses = sample.solid_masses();
  return {masses, truth(sample, masses), inertia<Digits50>(masses)};
}

MovingBody moving_body(const ReferenceCase& c) {
  return {c.masses, truth(c.guide, c.relative, c.t, c.masses), inertia<Digits50>(c.masses)};
}

}  // namespace kreisel::test
