#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <dynamics/guide/motion.hpp>
#include <motor/error.hpp>

namespace kreisel {

/// A quaternion and a position as polynomials of time, piece by piece.
///
/// Evaluation costs a binary search and one Horner scheme.
template <class S = double>
class PiecewisePose {
 public:
  /// Seven components: quaternion x, y, z, w (Eigen's order), position x, y, z.
  using Components = Eigen::Matrix<S, 7, 1>;

  PiecewisePose(std::string name, int degree) : name_(std::move(name)), degree_(degree) {}

  [[nodiscard]] static Components components(const Eigen::Quaternion<S>& q, const Vector3<S>& x) {
    return (Components() << q.coeffs(), x).finished();
  }

  /// Adds the piece from `begin` to the begin of the next piece or to the end. Coefficients of
  /// powers of (t - begin), lowest first.
  void append(const S& begin, const std::vector<Components>& coefficients) {
    begins_.push_back(begin);
    coefficients_.insert(coefficients_.end(), coefficients.begin(), coefficients.end());
  }

  void end_at(const S& end) { end_ = end; }

  [[nodiscard]] const S& begin() const { return begins_.front(); }
  [[nodiscard]] const S& end() const { return end_; }
  [[nodiscard]] const std::vector<S>& breakpoints() const { return begins_; }

  /// The coefficients of a piece, of powers of (t - begin) of the piece, lowest first.
  [[nodiscard]] std::span<const Components> coefficients(std::size_t piece) const {
    const auto terms = static_cast<std::size_t>(degree_) + 1;
    return {coefficients_.data() + piece * terms, terms};
  }

  /// Throws : InvalidInput outside [begin, end]: there is no extrapolation
  void require(const S& t) const {
    if (t >= begin() && t <= end_) return;
    std::ostringstream text;
    text.precision(10);
    text << name_ << ": t = " << t << " s lies outside [" << begin() << ", " << end_
         << "] s, for which the motion is known";
    throw InvalidInput(text.str());
  }

  /// Throws : as require() does
  [[nodiscard]] PoseDerivatives<S> operator()(const S& t) const {
    require(t);
    const auto next = std::upper_bound(begins_.begin() + 1, begins_.end(), t);
    const auto piece = static_cast<std::size_t>(next - begins_.begin()) - 1;
    const S s = t - begins_[piece];
    const auto terms = static_cast<std::size_t>(degree_) + 1;
    const Components* c = coefficients_.data() + piece * terms;
    Components value = c[degree_];
    Components first = Components::Zero();
    Components half_second = Components::Zero();
    for (int i = degree_ - 1; i >= 0; --i) {
      half_second = half_second * s + first;
      first = first * s + value;
      value = value * s + c[i];
    }
    const auto quaternion = [](const Components& k) {
      return Eigen::Quaternion<S>(Eigen::Matrix<S, 4, 1>(k.template head<4>()));
    };
    const auto position = [](const Components& k) { return Vector3<S>(k.template tail<3>()); };
    const Components second = S(2) * half_second;
    return {quaternion(value), quaternion(first), quaternion(second),
            position(value),   position(first),   position(second)};
  }

 private:
  std::string name_;
  int degree_;
  std::vector<S> begins_;
  std::vector<Components> coefficients_;
  S end_ = S(0);
};

}  // namespace kreisel
