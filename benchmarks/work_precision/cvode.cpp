#include "cvode.hpp"

#include <algorithm>
#include <cstdlib>
#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <stdexcept>
#include <string>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <utility>

namespace work_precision {

namespace {

void require(bool good, const char* what) {
  if (!good) throw std::runtime_error(std::string("CVODE: ") + what);
}

}  // namespace

struct Cvode::Memory {
  CvodeTask task;
  SUNContext context = nullptr;
  N_Vector y = nullptr;
  N_Vector absolute = nullptr;
  SUNMatrix matrix = nullptr;
  SUNLinearSolver solver = nullptr;
  void* cvode = nullptr;
  double evaluations = 0;

  explicit Memory(CvodeTask what) : task(std::move(what)) {}
  ~Memory() {
    if (cvode) CVodeFree(&cvode);
    if (solver) SUNLinSolFree(solver);
    if (matrix) SUNMatDestroy(matrix);
    if (absolute) N_VDestroy(absolute);
    if (y) N_VDestroy(y);
    if (context) SUNContext_Free(&context);
  }
  Memory(const Memory&) = delete;
  Memory& operator=(const Memory&) = delete;

  static int field(realtype t, N_Vector y, N_Vector rate, void* self) {
    auto& memory = *static_cast<Memory*>(self);
    if (++memory.evaluations > memory.task.most_evaluations) return -1;
    memory.task.field(t, N_VGetArrayPointer(y), N_VGetArrayPointer(rate));
    return 0;
  }

  static int jacobian(realtype t, N_Vector y, N_Vector, SUNMatrix J, void* self, N_Vector, N_Vector,
                      N_Vector) {
    static_cast<Memory*>(self)->task.jacobian(t, N_VGetArrayPointer(y), SUNDenseMatrix_Data(J));
    return 0;
  }
};

Cvode::Cvode(CvodeTask task) : memory_(std::make_unique<Memory>(std::move(task))) {
  Memory& m = *memory_;
  const auto n = static_cast<sunindextype>(m.task.start.size());
  require(SUNContext_Create(nullptr, &m.context) == 0, "no context");
  m.y = N_VNew_Serial(n, m.context);
  m.absolute = N_VNew_Serial(n, m.context);
  m.matrix = SUNDenseMatrix(n, n, m.context);
  require(m.y && m.absolute && m.matrix, "no memory");
  std::copy(m.task.start.begin(), m.task.start.end(), N_VGetArrayPointer(m.y));
  std::copy(m.task.absolute.begin(), m.task.absolute.end(), N_VGetArrayPointer(m.absolute));
  m.solver = SUNLinSol_Dense(m.y, m.matrix, m.context);
  m.cvode = CVodeCreate(m.task.method == CvodeMethod::adams ? CV_ADAMS : CV_BDF, m.context);
  require(m.solver && m.cvode, "no memory");
  CVodeSetErrFile(m.cvode, nullptr);  // what it says is thrown
  require(CVodeInit(m.cvode, &Memory::field, 0, m.y) == CV_SUCCESS &&
              CVodeSetUserData(m.cvode, &m) == CV_SUCCESS &&
              CVodeSVtolerances(m.cvode, m.task.relative, m.absolute) == CV_SUCCESS &&
              CVodeSetLinearSolver(m.cvode, m.solver, m.matrix) == CV_SUCCESS &&
              CVodeSetMaxNumSteps(m.cvode, -1) == CV_SUCCESS,
          "refuses the task");
  if (m.task.jacobian) require(CVodeSetJacFn(m.cvode, &Memory::jacobian) == CV_SUCCESS, "Jacobian");
}

Cvode::~Cvode() = default;

const double* Cvode::advance_to(double end) {
  Memory& m = *memory_;
  double t = 0;
  const int flag = CVode(m.cvode, end, m.y, &t, CV_NORMAL);
  require(m.evaluations <= m.task.most_evaluations, "evaluations are spent");
  if (flag < 0) {
    char* name = CVodeGetReturnFlagName(flag);
    const std::string text = name;
    std::free(name);
    require(false, text.c_str());
  }
  return N_VGetArrayPointer(m.y);
}

double Cvode::evaluations() const { return memory_->evaluations; }

}  // namespace work_precision
