#include <ostream>
#include <sstream>

#include <dynamics/solve/report.hpp>

namespace kreisel {

namespace {

[[nodiscard]] const char* name(RunStatus status) {
  switch (status) {
    case RunStatus::complete: return "complete";
    case RunStatus::cancelled: return "cancelled";
    case RunStatus::failed: return "failed";
  }
  return "none";
}

}  // namespace

std::ostream& operator<<(std::ostream& out, const RunReport& report) {
  std::ostringstream text;
  text.precision(15);  // counts as whole numbers
  text << "method       " << (report.changes.empty() ? report.method : report.changes) << '\n'
       << "status       " << name(report.status) << '\n'
       << "steps        " << report.effort.steps << ", " << report.effort.rejected
       << " more rejected\n"
       << "evaluations  " << report.effort.evaluations << ", " << report.all_evaluations
       << " with those for the error\n";
  text.precision(1);
  text << std::scientific << "error        " << report.error_estimate << ", estimated\n"
       << "tolerance    " << report.tolerance << ", "
       << (report.tolerance_kept ? "reached" : "not reached") << '\n';
  if (!report.message.empty()) text << "message      " << report.message << '\n';
  return out << text.str();
}

}  // namespace kreisel
