#pragma once

#include <Eigen/Core>

#include <experimental/simd>

#include <dynamics/step/lanes.hpp>

namespace kreisel {

/// Several numbers side by side, one a lane, that the processor calculates with at once: the number
/// type of a scene that moves for as many members of an ensemble. Eigen takes it as a scalar.
///
/// Comparisons give a mask, one bool a lane, so code that branches on a number does not compile for
/// packs before it says what it means: detail::any, detail::all or detail::select.
///
/// Error : sine and cosine <= 1.4 * 2^-53 up to arguments of 1e9, root and the four operations as
///         those of double
template <class Abi = std::experimental::simd_abi::native<double>>
class BasicPack {
 public:
  using Numbers = std::experimental::simd<double, Abi>;

  /// A bool a lane.
  class Mask {
   public:
    using Bools = typename Numbers::mask_type;

    Mask(const Bools& bools) : bools_(bools) {}
    [[nodiscard]] const Bools& bools() const { return bools_; }

    friend Mask operator&&(const Mask& a, const Mask& b) { return a.bools_ && b.bools_; }
    friend Mask operator||(const Mask& a, const Mask& b) { return a.bools_ || b.bools_; }
    friend Mask operator!(const Mask& a) { return !a.bools_; }
    friend bool all(const Mask& a) { return std::experimental::all_of(a.bools_); }
    friend bool any(const Mask& a) { return std::experimental::any_of(a.bools_); }

    template <class Bool>
    requires std::is_same_v<Bool, bool>
    operator Bool() const {
      static_assert(!std::is_same_v<Bool, bool>,
                    "this code branches on a number, of which a pack has one a lane: say any(), "
                    "all() or select() (dynamics/step/lanes.hpp), or run the members one by one: "
                    "ensemble<double>(...)");
      return false;
    }

   private:
    Bools bools_;
  };

  static constexpr int lanes = static_cast<int>(Numbers::size());

  BasicPack() = default;
  BasicPack(double x) : x_(x) {}  ///< in all lanes
  BasicPack(const Numbers& x) : x_(x) {}

  [[nodiscard]] static BasicPack load(const double* from) {
    return Numbers(from, std::experimental::element_aligned);
  }
  void store(double* to) const { x_.copy_to(to, std::experimental::element_aligned); }

  [[nodiscard]] const Numbers& numbers() const { return x_; }
  [[nodiscard]] double lane(int i) const { return x_[static_cast<std::size_t>(i)]; }
  void set_lane(int i, double x) { x_[static_cast<std::size_t>(i)] = x; }

  BasicPack& operator+=(const BasicPack& b) { return *this = *this + b; }
  BasicPack& operator-=(const BasicPack& b) { return *this = *this - b; }
  BasicPack& operator*=(const BasicPack& b) { return *this = *this * b; }
  BasicPack& operator/=(const BasicPack& b) { return *this = *this / b; }

  friend BasicPack operator-(const BasicPack& a) { return -a.x_; }
  friend BasicPack operator+(const BasicPack& a, const BasicPack& b) { return a.x_ + b.x_; }
  friend BasicPack operator-(const BasicPack& a, const BasicPack& b) { return a.x_ - b.x_; }
  friend BasicPack operator*(const BasicPack& a, const BasicPack& b) { return a.x_ * b.x_; }
  friend BasicPack operator/(const BasicPack& a, const BasicPack& b) { return a.x_ / b.x_; }

  friend Mask operator<(const BasicPack& a, const BasicPack& b) { return Mask(a.x_ < b.x_); }
  friend Mask operator>(const BasicPack& a, const BasicPack& b) { return Mask(a.x_ > b.x_); }
  friend Mask operator<=(const BasicPack& a, const BasicPack& b) { return Mask(a.x_ <= b.x_); }
  friend Mask operator>=(const BasicPack& a, const BasicPack& b) { return Mask(a.x_ >= b.x_); }
  friend Mask operator==(const BasicPack& a, const BasicPack& b) { return Mask(a.x_ == b.x_); }
  friend Mask operator!=(const BasicPack& a, const BasicPack& b) { return Mask(a.x_ != b.x_); }

  friend BasicPack sin(const BasicPack& a) { return std::experimental::sin(a.x_); }
  friend BasicPack cos(const BasicPack& a) { return std::experimental::cos(a.x_); }
  friend BasicPack sqrt(const BasicPack& a) { return std::experimental::sqrt(a.x_); }
  friend BasicPack abs(const BasicPack& a) { return std::experimental::abs(a.x_); }

  friend BasicPack select(const Mask& condition, const BasicPack& yes, const BasicPack& no) {
    Numbers result = no.x_;
    where(condition.bools(), result) = yes.x_;
    return result;
  }
  friend double greatest_lane(const BasicPack& a) {
    double most = a.lane(0);
    for (int i = 1; i < lanes; ++i) most = a.lane(i) <= most || most != most ? most : a.lane(i);
    return most;
  }

 private:
  Numbers x_;
};

using Pack = BasicPack<>;

}  // namespace kreisel

namespace Eigen {

template <class Abi>
struct NumTraits<kreisel::BasicPack<Abi>> : GenericNumTraits<kreisel::BasicPack<Abi>> {
  using Pack = kreisel::BasicPack<Abi>;
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

template <class Abi, class Op>
struct ScalarBinaryOpTraits<kreisel::BasicPack<Abi>, double, Op> {
  using ReturnType = kreisel::BasicPack<Abi>;
};
template <class Abi, class Op>
struct ScalarBinaryOpTraits<double, kreisel::BasicPack<Abi>, Op> {
  using ReturnType = kreisel::BasicPack<Abi>;
};

}  // namespace Eigen
