#pragma once

#include <Eigen/Core>

#include <cmath>

#include <dynamics/inertia.hpp>
#include <dynamics/load/load.hpp>

namespace kreisel {

/// The terms of a body's size, to be added to the gravitation at its centre of mass.
///
/// Units  : N, N m (about the centre of mass), J
template <class N>
struct SizeTerms {
  Vector3<N> force;
  Vector3<N> torque;
  N energy;  ///< to be subtracted from the potential energy
};

/// The gravitation of a planet with the first term of its flattening, J2.
///
///   U(p) = mu/r [1 - J2 (R/r)^2 (3 z^2/r^2 - 1)/2],   z = p.k,   g = grad U
///
/// N may be double, a dual number or a PowerSeries.
///
/// Frame  : any axes with the planet's centre as origin, the same for all arguments and results
/// Units  : m^3/s^2, m^5/s^2
template <class N = double>
struct PlanetField {
  N parameter;      ///< mu
  N oblateness;     ///< c = (3/2) mu J2 R^2
  Vector3<N> pole;  ///< k, of length 1
  bool is_oblate;   ///< false: `oblateness` is 0 and its terms are not computed

  [[nodiscard]] Vector3<N> acceleration(const Vector3<N>& p) const {
    const Powers i(p);
    const Vector3<N> sphere = -(parameter * i.r3) * p;
    return is_oblate ? Vector3<N>(sphere + flattening(p)) : sphere;
  }

  /// The part of J2:  c [(5 z^2/r^7 - 1/r^5) p - 2 z/r^5 k].
  [[nodiscard]] Vector3<N> flattening(const Vector3<N>& p) const {
    const Powers i(p);
    const N z = pole.dot(p);
    return oblateness * ((N(5) * z * z * i.r7 - i.r5) * p - (N(2) * z * i.r5) * pole);
  }

  [[nodiscard]] N potential(const Vector3<N>& p) const {
    const Powers i(p);
    const N sphere = parameter * i.r1;
    if (!is_oblate) return sphere;
    const N z = pole.dot(p);
    return sphere + oblateness * (i.r3 / N(3) - z * z * i.r5);
  }

  /// g(p + d) - g(p), computed from the small d and not as a difference of two accelerations.
  ///
  /// With q = d.(d + 2p)/p^2 and m = sqrt(1 + q) = |p + d|/|p| the powers differ by
  /// m^n - 1 = (m - 1)(1 + m + .. + m^(n-1)),  m - 1 = q/(1 + m).
  ///
  /// Source : R. H. Battin, An Introduction to the Mathematics and Methods of Astrodynamics, 8.4
  /// Error  : <= 16u of the result for |d| <= |p|/2         (tests/dynamics/load/orbit_gravitation)
  [[nodiscard]] Vector3<N> tide(const Vector3<N>& p, const Vector3<N>& d) const {
    const Powers i(p);
    const Ratio m(p, d);
    const N f3 = m.lost(3);
    const Vector3<N> sphere = -(parameter * i.r3) * (d - f3 * (p + d));
    if (!is_oblate) return sphere;
    const N f5 = m.lost(5), f7 = m.lost(7);
    const N s5 = i.r5 * (N(1) - f5), s7 = i.r7 * (N(1) - f7);
    const N z = pole.dot(p), dz = pole.dot(d);
    const N there = z + dz;
    const N of_place = N(5) * there * there * s7 - s5;
    const N of_place_change = N(5) * (dz * (z + there) * s7 - z * z * i.r7 * f7) + i.r5 * f5;
    const N of_pole_change = N(-2) * (dz * s5 - z * i.r5 * f5);
    return sphere + oblateness * (of_place * d + of_place_change * p + of_pole_change * pole);
  }

  /// U(p + d) - U(p) - g(p).d; the sphere's part from the small d, the part of J2 as a difference.
  [[nodiscard]] N tidal_potential(const Vector3<N>& p, const Vector3<N>& d) const {
    const Powers i(p);
    const Ratio m(p, d);
    const N along = d.dot(p) * i.r2;
    const N square = d.dot(d) * i.r2;
    const N m1 = N(1) + m.m;
    const N sphere = parameter * i.r1 * (along * m.q * (m.m + N(2)) / m1 - square) / (m.m * m1);
    if (!is_oblate) return sphere;
    const auto flat = [this](const Vector3<N>& at) -> N {
      const Powers j(at);
      const N z = pole.dot(at);
      return oblateness * (j.r3 / N(3) - z * z * j.r5);
    };
    return sphere + (flat(p + d) - flat(p) - flattening(p).dot(d));
  }

  /// The terms of second order in the size of a body with the tensor of inertia T about its
  /// centre of mass. Force and torque come from one potential,  W = -(1/2) G : T,  G = grad
  /// grad U, so energy and angular momentum are conserved:
  ///
  ///   force = grad W,   torque_i = e_ikj (G T)_kj;   without J2  3 mu/r^5 p x (T p)
  ///
  /// The first neglected torque and force are at most 2.07 mu M3/r^4 and 4 mu M3/r^5, where M3 is
  /// the integral of |x|^3 dm over the body. They vanish for bodies that are symmetric about their
  /// centre of mass. For these the next terms are below 3.2 mu M4/r^5 and 5 mu M4/r^6.
  ///
  /// Source : MacCullagh's potential, differentiated; bounds from the Legendre polynomials P3, P4
  [[nodiscard]] SizeTerms<N> size_terms(const Vector3<N>& p, const Symmetric3<N>& T) const {
    const Powers i(p);
    const Vector3<N> T_p = T * p;
    const N trace = T.xx + T.yy + T.zz;
    const N p_T_p = p.dot(T_p);
    // G = E 1 + X p p^t + Y (p k^t + k p^t) + Z k k^t
    N E = -parameter * i.r3;
    N X = N(3) * parameter * i.r5;
    N dX = N(-15) * parameter * i.r7;
    if (!is_oblate) {
      return {N(-0.5) * (N(2) * X * T_p + (p_T_p * dX + trace * X) * p), X * p.cross(T_p),
              N(-0.5) * (X * p_T_p + E * trace)};
    }
    const N r9 = i.r7 * i.r2;
    const N z = pole.dot(p);
    const Vector3<N> T_k = T * pole;
    const N& c = oblateness;
    E += c * (N(5) * z * z * i.r7 - i.r5);
    X += c * (N(5) * i.r7 - N(35) * z * z * r9);
    dX += c * (N(315) * z * z * r9 * i.r2 - N(35) * r9);
    const N Y = N(10) * c * z * i.r7;
    const N dY = N(-70) * c * z * r9;  // of X along k, of Y along p
    const N Z = N(-2) * c * i.r5;
    const N dZ = N(10) * c * i.r7;  // of Y along k, of Z along p
    const N p_T_k = p.dot(T_k), k_T_k = pole.dot(T_k);
    const N along_p = p_T_p * dX + N(2) * p_T_k * dY + k_T_k * dZ + trace * X;
    const N along_k = p_T_p * dY + N(2) * p_T_k * dZ + trace * Y;
    return {N(-0.5) * (N(2) * X * T_p + N(2) * Y * T_k + along_p * p + along_k * pole),
            X * p.cross(T_p) + Y * (p.cross(T_k) + pole.cross(T_p)) + Z * pole.cross(T_k),
            N(-0.5) * (X * p_T_p + N(2) * Y * p_T_k + Z * k_T_k + E * trace)};
  }

 private:
  /// Negative powers of |p|.
  struct Powers {
    explicit Powers(const Vector3<N>& p) {
      using std::sqrt;
      r2 = N(1) / p.dot(p);
      r1 = sqrt(r2);
      r3 = r1 * r2;
      r5 = r3 * r2;
      r7 = r5 * r2;
    }
    N r1, r2, r3, r5, r7;
  };

  /// m = |p + d|/|p|.
  struct Ratio {
    Ratio(const Vector3<N>& p, const Vector3<N>& d)
        : q(d.dot(Vector3<N>(d + N(2) * p)) / p.dot(p)) {
      using std::sqrt;
      m = sqrt(N(1) + q);
    }

    /// 1 - m^-n
    [[nodiscard]] N lost(int n) const {
      N sum(1);
      N power = m;
      for (int k = 1; k < n; ++k) {
        sum += power;
        power *= m;
      }
      return q / (N(1) + m) * sum / power;
    }

    N q, m;
  };
};

namespace detail {

/// The tensor of inertia about the centre of mass.
template <class N>
[[nodiscard]] Symmetric3<N> central_tensor(const Inertia<N>& T) {
  const Vector3<N> half = T.first_moment / (N(2) * T.mass);
  return T.tensor - offset_product(half, T.first_moment);
}

/// Force and torque about O' of the gravitation g at the centre of mass, on body axes. With `sized`
/// the terms of the body's size are added. `planet` and the centre of mass p are then also on body
/// axes.
template <class N>
[[nodiscard]] Force<Body, N> gravitation_on(const LoadContext<N>& s, const Vector3<N>& g,
                                            bool sized, const PlanetField<N>& planet,
                                            const Vector3<N>& p) {
  const Inertia<N>& T = s.inertia.value;
  Vector3<N> force = T.mass * g;
  Vector3<N> torque = Vector3<N>::Zero();
  if (sized) {
    const SizeTerms<N> terms = planet.size_terms(p, central_tensor(T));
    force += terms.force;
    torque = terms.torque;
  }
  return {{force, torque + s.centre().cross(force)}};
}

}  // namespace detail

}  // namespace kreisel
