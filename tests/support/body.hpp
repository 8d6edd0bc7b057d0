#pragma once

#include <vector>

#include <dynamics/inertia.hpp>
#include <motor/frame.hpp>
#include <motor/rate.hpp>

#include <support/kinematics.hpp>
#include <support/reference.hpp>
#include <support/sample.hpp>
#include <support/terms.hpp>

namespace kreisel::test {

/// The arguments of the laws in any scalar: double for the law, Terms for the scale of its error.
template <class S>
struct Typed {
  using Relative = Velocity<Body, Guide, Body, S>;
  using Guiding = Velocity<Guide, Inertial, Body, S>;

  InertiaTensor<Body, S> T;
  Relative V_rel;
  Guiding F;
  struct {
    Rate<Body, Relative> body;
    Rate<Guide, Relative> guide;
    Rate<Inertial, Relative> inertial;
  } dV_rel;
  struct {
    Rate<Body, Guiding> body;
    Rate<Guide, Guiding> guide;
    Rate<Inertial, Guiding> inertial;
  } dF;
};

/// A body of point masses in motion: the truth in 50 digits, and the law's arguments, rounded from
/// it.
struct MovingBody {
  std::vector<PointMass> masses;
  Truth truth;
  Inertia<Digits50> T;

  [[nodiscard]] Typed<double> numbers() const;

  /// The sizes of the arguments; a zero's residue in 50 digits counts as 1e-30.
  [[nodiscard]] Typed<Terms> terms() const;

  [[nodiscard]] Motor<> force() const;
};

/// A random body.
[[nodiscard]] MovingBody moving_body(unsigned seed);

/// The body of a reference case.
[[nodiscard]] MovingBody moving_body(const ReferenceCase& c);

}  // namespace kreisel::test
