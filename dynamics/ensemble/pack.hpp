#pragma once

#include <Eigen/Core>

#include <cmath>
#include <type_traits>

#include <motor/lanes.hpp>
#include <motor/simd.hpp>

namespace kreisel {

/// Several numbers side by side, one in each lane, for SIMD arithmetic. With this number type a
/// scene moves for several members of an ensemble at once. Eigen accepts it as a scalar.
///
/// Comparisons give a mask with one bool for each lane. Code that branches on a number does not
/// compile for packs; detail::any, detail::all or detail::select state the intention.
///
/// Operations are always inlined. As separate functions, which g++ makes of them in large programs,
/// they pass packs through memory, and that costs more than the operations.
///
/// Error  : sine and cosine <= 1.2 * 2^-53 up to arguments of 1e9, root and the four operations as
///         those of double
template <int count = detail::native_lanes>
class BasicPack {
 public:
  using Numbers = detail::LanesOfDouble<count>;

  /// One bool for each lane.
  class Mask {
   public:
    using Bools = detail::LanesOfBool<count>;

    Mask(const Bools& bools) : bools_(bools) {}
    [[nodiscard]] const Bools& bools() const { return bools_; }

    friend Mask operator&&(const Mask& a, const Mask& b) { return a.bools_ & b.bools_; }
    friend Mask operator||(const Mask& a, const Mask& b) { return a.bools_ | b.bools_; }
    friend Mask operator!(const Mask& a) { return ~a.bools_; }
    friend bool all(const Mask& a) { return detail::all_lanes(a.bools_); }
    friend bool any(const Mask& a) { return !detail::all_lanes(Bools(~a.bools_)); }

    template <class Bool>
    requires std::is_same_v<Bool, bool>
    operator Bool() const {
      static_assert(!std::is_same_v<Bool, bool>,
                    "this code branches on a number, but a pack has several: use any(), "
                    "all() or select() (motor/lanes.hpp), or run the members one by one: "
                    "ensemble<double>(...)");
      return false;
    }

   private:
    Bools bools_;
  };

  static constexpr int lanes = count;

  BasicPack() = default;
  BasicPack(double x) : x_(detail::same_in_all_lanes<count>(x)) {}  ///< the same in all lanes
  BasicPack(const Numbers& x) : x_(x) {}

  [[nodiscard]] const Numbers& numbers() const { return x_; }
  [[nodiscard]] double lane(int i) const { return x_[i]; }
  void set_lane(int i, double x) { x_[i] = x; }

  BasicPack& operator+=(const BasicPack& b) { return *this = *this + b; }
  BasicPack& operator-=(const BasicPack& b) { return *this = *this - b; }
  BasicPack& operator*=(const BasicPack& b) { return *this = *this * b; }
  BasicPack& operator/=(const BasicPack& b) { return *this = *this / b; }

  [[gnu::always_inline]] friend BasicPack operator-(const BasicPack& a) { return -a.x_; }
  [[gnu::always_inline]] friend BasicPack operator+(const BasicPack& a, const BasicPack& b) {
    return a.x_ + b.x_;
  }
  [[gnu::always_inline]] friend BasicPack operator-(const BasicPack& a, const BasicPack& b) {
    return a.x_ - b.x_;
  }
  [[gnu::always_inline]] friend BasicPack operator*(const BasicPack& a, const BasicPack& b) {
    return a.x_ * b.x_;
  }
  [[gnu::always_inline]] friend BasicPack operator/(const BasicPack& a, const BasicPack& b) {
    return a.x_ / b.x_;
  }

  [[gnu::always_inline]] friend Mask operator<(const BasicPack& a, const BasicPack& b) {
    return Mask(a.x_ < b.x_);
  }
  [[gnu::always_inline]] friend Mask operator>(const BasicPack& a, const BasicPack& b) {
    return Mask(a.x_ > b.x_);
  }
  [[gnu::always_inline]] friend Mask operator<=(const BasicPack& a, const BasicPack& b) {
    return Mask(a.x_ <= b.x_);
  }
  [[gnu::always_inline]] friend Mask operator>=(const BasicPack& a, const BasicPack& b) {
    return Mask(a.x_ >= b.x_);
  }
  [[gnu::always_inline]] friend Mask operator==(const BasicPack& a, const BasicPack& b) {
    return Mask(a.x_ == b.x_);
  }
  [[gnu::always_inline]] friend Mask operator!=(const BasicPack& a, const BasicPack& b) {
    return Mask(a.x_ != b.x_);
  }

  [[gnu::always_inline]] friend BasicPack sin(const BasicPack& a) { return on_circle(a).sine; }
  [[gnu::always_inline]] friend BasicPack cos(const BasicPack& a) { return on_circle(a).cosine; }
  [[gnu::always_inline]] friend BasicPack sqrt(const BasicPack& a) {
    return detail::lanes_sqrt(a.x_);
  }
  [[gnu::always_inline]] friend BasicPack abs(const BasicPack& a) {
    return detail::lanes_abs(a.x_);
  }

  [[gnu::always_inline]] friend BasicPack select(const Mask& condition, const BasicPack& yes,
                                                 const BasicPack& no) {
    return detail::lanes_select(condition.bools(), yes.x_, no.x_);
  }
  friend double greatest_lane(const BasicPack& a) {
    double most = a.lane(0);
    for (int i = 1; i < lanes; ++i) most = a.lane(i) <= most || most != most ? most : a.lane(i);
    return most;
  }

 private:
  struct OnCircle {
    BasicPack sine;
    BasicPack cosine;
  };

  /// Sine and cosine of an angle. Computing both together costs little more than one.
  ///
  /// Works on the angle reduced by quarter turns, |x| <= pi/4. The minimax polynomials of degrees
  /// 13 and 14 err by 2^-56.
  [[nodiscard, gnu::always_inline]] static OnCircle on_circle(const BasicPack& angle) {
    constexpr double furthest = 1e9;
    constexpr double quarters_a_radian = 0.6366197723675814;
    // pi/2 = a + b + c. a and b have so few digits that their products with `quarters` are exact.
    constexpr double a = 0x1.921fb4p0;
    constexpr double b = 0x1.4442dp-24;
    constexpr double c = 0x1.8469898cc517p-48;
    const BasicPack quarters = whole(quarters_a_radian * angle);
    const BasicPack x = ((angle - a * quarters) - b * quarters) - c * quarters;
    const BasicPack z = x * x;
    const BasicPack zz = z * z;
    const BasicPack of_sine = (-0.1666666666666663 + 0.008333333333322118 * z) +
                              zz * ((-0.00019841269829589468 + 2.755731362136662e-06 * z) +
                                    zz * (-2.5050747760399178e-08 + 1.5896230034286184e-10 * z));
    const BasicPack of_cosine = (0.0416666666666666 - 0.0013888888888874138 * z) +
                                zz * ((2.480158728949167e-05 - 2.7557314355199066e-07 * z) +
                                      zz * (2.0875723678804126e-09 - 1.1359669581281035e-11 * z));
    const BasicPack half = 0.5 * z;
    const BasicPack nearly = 1 - half;
    const BasicPack sine = x + x * z * of_sine;
    const BasicPack cosine = nearly + (((1 - nearly) - half) + zz * of_cosine);
    // The quarter, -2 to 1. Odd quarters swap sine and cosine.
    const BasicPack quarter = quarters - 4 * whole(0.25 * quarters + 0.125);
    const Mask odd = quarter * quarter == 1;
    const BasicPack up = select(odd, cosine, sine);
    const BasicPack along = select(odd, sine, cosine);
    const OnCircle result{select(quarter < 0, -up, up),
                          select(abs(quarter + 0.5) > 1, -along, along)};
    return all(abs(angle) <= furthest) ? result : one_by_one(angle);
  }

  /// Also for angles that are infinite or NaN.
  [[nodiscard, gnu::noinline, gnu::cold]] static OnCircle one_by_one(const BasicPack& angle) {
    OnCircle result;
    for (int i = 0; i < lanes; ++i) {
      result.sine.set_lane(i, std::sin(angle.lane(i)));
      result.cosine.set_lane(i, std::cos(angle.lane(i)));
    }
    return result;
  }

  /// The nearest whole number; |x| <= 2^51.
  [[nodiscard, gnu::always_inline]] static BasicPack whole(const BasicPack& x) {
    constexpr double no_room_for_fractions = 0x1.8p52;
    return (x + no_room_for_fractions) - no_room_for_fractions;
  }

  Numbers x_;
};

using Pack = BasicPack<>;

}  // namespace kreisel

namespace Eigen {

template <int lanes>
struct NumTraits<kreisel::BasicPack<lanes>> : GenericNumTraits<kreisel::BasicPack<lanes>> {
  using Pack = kreisel::BasicPack<lanes>;
  using Real = Pack;
  using NonInteger = Pack;
  using Nested = Pack;
  using Literal = double;
  enum {
    IsComplex = 0,
    IsInteger = 0,
    IsSigned = 1,
    RequireInitialization = 0,
    ReadCost = 1,
    AddCost = 1,
    MulCost = 1
  };
};

template <int lanes, class Op>
struct ScalarBinaryOpTraits<kreisel::BasicPack<lanes>, double, Op> {
  using ReturnType = kreisel::BasicPack<lanes>;
};
template <int lanes, class Op>
struct ScalarBinaryOpTraits<double, kreisel::BasicPack<lanes>, Op> {
  using ReturnType = kreisel::BasicPack<lanes>;
};

}  // namespace Eigen
