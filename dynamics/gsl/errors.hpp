#pragma once

#include <gsl/gsl_errno.h>

namespace kreisel::detail {

/// Scope in which GSL returns its error codes instead of ending the program. GSL has one handler
/// for all threads.
class GslErrorsReturned {
 public:
  GslErrorsReturned() : previous_(gsl_set_error_handler_off()) {}
  ~GslErrorsReturned() { gsl_set_error_handler(previous_); }
  GslErrorsReturned(const GslErrorsReturned&) = delete;
  GslErrorsReturned& operator=(const GslErrorsReturned&) = delete;

 private:
  gsl_error_handler_t* previous_;
};

}  // namespace kreisel::detail
