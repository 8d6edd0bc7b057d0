// Motors, motor tensors, inertia and poses for Python. Axes and the point of reduction are the
// caller's; python/src/kreisel/motors.py adds the names of frames and observers.

#include "motors.hpp"

#include <array>
#include <cstddef>
#include <pybind11/operators.h>
#include <pybind11/stl.h>
#include <string>

#include <dynamics/law/relative.hpp>
#include <motor/displacement.hpp>
#include <motor/motor.hpp>
#include <motor/screw.hpp>
#include <motor/tensor.hpp>

using namespace kreisel;

namespace py = pybind11;
using namespace py::literals;

namespace {

using Three = std::array<double, 3>;
using Rows = std::array<Three, 3>;
using BodyInertia = InertiaTensor<Body>;

Vector3<double> vector(const Three& v) { return {v[0], v[1], v[2]}; }
Three three(const Vector3<double>& v) { return {v.x(), v.y(), v.z()}; }

Matrix3<double> matrix(const Rows& rows) {
  Matrix3<double> M;
  for (int i = 0; i < 3; ++i) M.row(i) = vector(rows[static_cast<std::size_t>(i)]);
  return M;
}

Rows rows(const Matrix3<double>& M) { return {three(M.row(0)), three(M.row(1)), three(M.row(2))}; }

std::string text(const Motor<>& a) {
  return py::str("Motor({}, {})")
      .format(py::tuple(py::cast(three(a.resultant))), py::tuple(py::cast(three(a.moment))));
}

void define_motor(py::module_& m) {
  py::class_<Motor<>>(m, "Motor")
      .def(py::init([](const Three& resultant, const Three& moment) {
             return Motor<>{vector(resultant), vector(moment)};
           }),
           "resultant"_a = Three{}, "moment"_a = Three{})
      .def_property_readonly("resultant", [](const Motor<>& a) { return three(a.resultant); })
      .def_property_readonly("moment", [](const Motor<>& a) { return three(a.moment); })
      .def("reduced_at",
           [](const Motor<>& a, const Three& p_OP) { return a.reduced_at(vector(p_OP)); })
      .def_property_readonly("length", [](const Motor<>& a) { return three(length(a)); })
      .def_property_readonly("axis_point", [](const Motor<>& a) { return three(axis_point(a)); })
      .def_property_readonly("pitch", [](const Motor<>& a) { return pitch(a); })
      .def(py::self + py::self)
      .def(py::self - py::self)
      .def(-py::self)
      .def(double() * py::self)
      .def(py::self * double())
      .def(py::self / double())
      .def(py::self == py::self)
      .def("__repr__", &text)
      .def(py::pickle(
          [](const Motor<>& a) { return py::make_tuple(three(a.resultant), three(a.moment)); },
          [](const py::tuple& parts) {
            return Motor<>{vector(parts[0].cast<Three>()), vector(parts[1].cast<Three>())};
          }));
  m.def("cross", [](const Motor<>& a, const Motor<>& b) { return cross(a, b); });
  m.def("reciprocal", [](const Motor<>& a, const Motor<>& b) { return reciprocal(a, b); });
}

void define_tensors(py::module_& m) {
  using Tensor = MotorTensor<>;
  py::class_<Tensor>(m, "MotorTensor")
      .def_static("identity", &Tensor::identity)
      .def_property_readonly("blocks",
                             [](const Tensor& T) {
                               return py::dict("rr"_a = rows(T.rr), "rm"_a = rows(T.rm),
                                               "mr"_a = rows(T.mr), "mm"_a = rows(T.mm));
                             })
      .def_property_readonly("transposed", [](const Tensor& T) { return transpose(T); })
      .def("__mul__", [](const Tensor& T, const Motor<>& a) { return T * a; })
      .def("__rmul__", [](const Tensor& T, double s) { return s * T; })
      .def("__add__", [](const Tensor& a, const Tensor& b) { return a + b; })
      .def("__sub__", [](const Tensor& a, const Tensor& b) { return a - b; });
  m.def("dyad", [](const Motor<>& a, const Motor<>& b) { return dyad(a, b); });
  m.def("cross", [](const Motor<>& a, const Tensor& T) { return cross(a, T); });
  m.def("cross", [](const Tensor& T, const Motor<>& a) { return cross(T, a); });

  py::class_<BodyInertia>(m, "Inertia")
      .def(py::init([](double mass, const Three& centre, const Rows& about_centre) {
             return BodyInertia::about_centre(mass, vector(centre), matrix(about_centre));
           }),
           "mass"_a, "centre"_a, "about_centre"_a)
      .def_property_readonly("tensor", [](const BodyInertia& T) { return T.value.motor_tensor(); })
      .def("__mul__",
           [](const BodyInertia& T, const Motor<>& a) { return T.value.motor_tensor() * a; });
}

void define_poses(py::module_& m) {
  py::class_<Pose<>>(m, "Pose")
      .def(py::init([](const std::array<double, 4>& quaternion, const Three& translation) {
             return Pose<>::from({quaternion[0], quaternion[1], quaternion[2], quaternion[3]},
                                 vector(translation));
           }),
           "quaternion"_a = std::array<double, 4>{1, 0, 0, 0}, "translation"_a = Three{})
      .def_property_readonly("rotation", [](const Pose<>& X) { return rows(X.rotation); })
      .def_property_readonly("translation", [](const Pose<>& X) { return three(X.translation); })
      .def("point", [](const Pose<>& X, const Three& p) { return three(X.point(vector(p))); })
      .def("inverse", &Pose<>::inverse)
      .def("__mul__", [](const Pose<>& X, const Pose<>& Y) { return X * Y; })
      .def("__mul__", [](const Pose<>& X, const Motor<>& a) { return X * a; })
      .def("__mul__", [](const Pose<>& X, const MotorTensor<>& T) { return X * T; });
  m.def("exp", [](const Motor<>& a) { return exp(a); });
  m.def("log", [](const Pose<>& X) { return log(X); });
}

/// The parts of the law for a rate of V' seen from OfV and a rate of F seen from OfF.
template <class OfV, class OfF>
std::array<Motor<>, 3> parts_of(const BodyInertia& T, const Motor<>& V, const Motor<>& F,
                                const Motor<>& dV, const Motor<>& dF) {
  using Relative = Velocity<Body, Guide, Body>;
  using Carrying = Velocity<Guide, Inertial, Body>;
  const auto parts = equation_of_motion(T, Relative{V}, Carrying{F}, Rate<OfV, Relative>{dV},
                                        Rate<OfF, Carrying>{dF});
  return {untagged(parts.relative), untagged(parts.guide), untagged(parts.coriolis)};
}

/// The same with observers by number: 0 body, 1 guide, 2 inertial.
std::array<Motor<>, 3> parts_of_the_law(const BodyInertia& T, const Motor<>& V, const Motor<>& F,
                                        std::size_t of_relative, const Motor<>& dV,
                                        std::size_t of_guide, const Motor<>& dF) {
  static constexpr std::array forms{
      &parts_of<Body, Body>,     &parts_of<Body, Guide>,     &parts_of<Body, Inertial>,
      &parts_of<Guide, Body>,    &parts_of<Guide, Guide>,    &parts_of<Guide, Inertial>,
      &parts_of<Inertial, Body>, &parts_of<Inertial, Guide>, &parts_of<Inertial, Inertial>};
  return forms.at(3 * of_relative + of_guide)(T, V, F, dV, dF);
}

}  // namespace

void define_motors(py::module_& m) {
  define_motor(m);
  define_tensors(m);
  define_poses(m);
  m.def("parts_of_the_law", &parts_of_the_law);
}
