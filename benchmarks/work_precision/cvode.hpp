#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

namespace work_precision {

enum class CvodeMethod { adams, bdf };

/// What CVODE is to integrate. A Jacobian is wanted column by column; without one CVODE takes
/// differences.
struct CvodeTask {
  CvodeMethod method;
  std::function<void(double t, const double* y, double* rate)> field;
  std::function<void(double t, const double* y, double* columns)> jacobian;
  std::vector<double> start;
  std::vector<double> absolute;  ///< tolerance of each component
  double relative;
  double most_evaluations;
};

/// SUNDIALS' solver of variable order: serial vectors, Newton's method with a dense matrix.
///
/// Throws : std::runtime_error where it gives up
class Cvode {
 public:
  explicit Cvode(CvodeTask task);
  ~Cvode();
  Cvode(const Cvode&) = delete;
  Cvode& operator=(const Cvode&) = delete;

  const double* advance_to(double end);
  [[nodiscard]] double evaluations() const;

 private:
  struct Memory;
  std::unique_ptr<Memory> memory_;
};

}  // namespace work_precision
