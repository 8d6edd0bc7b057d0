#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <type_traits>
#include <utility>
#include <vector>

#include <dynamics/step/accuracy.hpp>
#include <dynamics/step/compensated.hpp>
#include <motor/error.hpp>

namespace kreisel::detail {

/// The numbers that integration needs to continue as if it had not stopped. Steppers pass their
/// members in one fixed order, both for saving and for restoring.
class Checkpoint {
 public:
  /// Saves.
  Checkpoint() = default;

  /// Restores.
  explicit Checkpoint(std::vector<double> numbers) : numbers_(std::move(numbers)), sets_(true) {}

  [[nodiscard]] const std::vector<double>& numbers() const { return numbers_; }

  /// Throws : InvalidInput if the numbers belong to a different stepper
  template <class... Values>
  void operator()(Values&... values) {
    (pass(values), ...);
  }

  void finish() const { require(next_ == numbers_.size()); }

 private:
  static void require(bool fits) {
    if (!fits) throw InvalidInput("the checkpoint belongs to a different run");
  }

  void pass(double& x) {
    if (!sets_) {
      numbers_.push_back(x);
      return;
    }
    require(next_ < numbers_.size());
    x = numbers_[next_++];
  }

  template <class Whole>
  requires std::is_integral_v<Whole>
  void pass(Whole& x) {
    auto number = static_cast<double>(x);
    pass(number);
    require(number >= 0 && number <= 9e15);
    x = static_cast<Whole>(number);
  }

  template <class Derived>
  void pass(Eigen::PlainObjectBase<Derived>& m) {
    Eigen::Index rows = m.rows();
    Eigen::Index columns = m.cols();
    pass(rows);
    pass(columns);
    if (sets_) {
      const auto left = static_cast<Eigen::Index>(numbers_.size() - next_);
      require(rows <= left && columns <= left);
      constexpr int fixed_rows = Derived::RowsAtCompileTime;
      constexpr int fixed_columns = Derived::ColsAtCompileTime;
      require(fixed_rows == Eigen::Dynamic || fixed_rows == rows);
      require(fixed_columns == Eigen::Dynamic || fixed_columns == columns);
      m.resize(rows, columns);
    }
    for (Eigen::Index i = 0; i < m.size(); ++i) pass(m.data()[i]);
  }

  template <class T, class Allocator>
  void pass(std::vector<T, Allocator>& list) {
    for (T& x : list) pass(x);
  }

  template <class T>
  void pass(Compensated<T>& sum) {
    pass(sum.value);
    pass(sum.rest);
  }

  void pass(IntegrationStatistics& effort) {
    (*this)(effort.steps, effort.rejected, effort.evaluations, effort.jacobians);
  }

  template <class T>
  requires requires(T& whole, Checkpoint& checkpoint) { whole.pass(checkpoint); }
  void pass(T& whole) { whole.pass(*this); }

  std::vector<double> numbers_;
  std::size_t next_ = 0;
  bool sets_ = false;
};

}  // namespace kreisel::detail
