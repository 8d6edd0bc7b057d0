// The compiled module of the package kreisel: plain functions and records, which the Python files of
// python/src/kreisel make convenient. No function computes with Python's lock.

#include <exception>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <dynamics/version.hpp>
#include <motor/error.hpp>

#include "interruptible.hpp"
#include "motors.hpp"
#include "scene.hpp"
#include "study.hpp"

using namespace kreisel;

namespace py = pybind11;
using namespace py::literals;

namespace {

/// Sets Python's error to an exception of kreisel.errors.
void set_error(const char* type, const char* message) {
  PyErr_SetString(py::module_::import("kreisel._errors").attr(type).ptr(), message);
}

void translate(std::exception_ptr thrown) {
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (const SceneMistakes& error) {
    set_error("SceneMistakes", error.what());
  } catch (const InvalidInput& error) {
    set_error("InvalidInput", error.what());
  } catch (const ComputationFailed& error) {
    set_error("ComputationFailed", error.what());
  } catch (const Error& error) {
    set_error("Error", error.what());
  }
}

/// The result of  study(stop, share)  as JSON text.
template <class Study>
std::string without_lock(const py::object& progress, const Study& study) {
  std::string result;
  run_interruptibly(progress, [&](const auto& stop, auto& share) { result = study(stop, share); });
  return result;
}

void define_records(py::module_& m) {
  py::class_<Table>(m, "Table", "A table of numbers, by the buffer protocol.",
                    py::buffer_protocol())
      .def_buffer([](Table& table) {
        const auto row = static_cast<py::ssize_t>(table.columns * sizeof(double));
        return py::buffer_info(table.numbers.data(), sizeof(double),
                               py::format_descriptor<double>::format(), 2,
                               {table.rows, table.columns}, {row, py::ssize_t(sizeof(double))});
      });
  py::class_<Group>(m, "Group", "Columns that belong together.")
      .def_readonly("kind", &Group::kind)
      .def_readonly("name", &Group::name)
      .def_readonly("part", &Group::part)
      .def_readonly("begin", &Group::begin)
      .def_readonly("count", &Group::count);
  py::class_<Motion>(m, "Motion", "A computed motion.")
      .def_readonly("title", &Motion::title)
      .def_readonly("model", &Motion::model)
      .def_readonly("columns", &Motion::columns)
      .def_readonly("groups", &Motion::groups)
      .def_readonly("rows", &Motion::rows)
      .def_readonly("part_groups", &Motion::part_groups)
      .def_readonly("parts", &Motion::parts)
      .def_readonly("errors", &Motion::errors)
      .def_readonly("error_of_log", &Motion::error_of_log)
      .def_readonly("terms", &Motion::terms)
      .def_readonly("report", &Motion::report);
  py::class_<Members>(m, "Members", "The members of an ensemble.")
      .def_readonly("keys", &Members::keys)
      .def_readonly("columns", &Members::columns)
      .def_readonly("varied", &Members::varied)
      .def_readonly("ends", &Members::ends)
      .def_readonly("errors", &Members::errors)
      .def_readonly("messages", &Members::messages)
      .def_readonly("missed", &Members::missed);
}

void define_report(py::module_& m) {
  py::class_<InvariantDrift>(m, "Invariant", "A number that should not change in a run.")
      .def_readonly("name", &InvariantDrift::name, "energy, momenta, ...")
      .def_readonly("start", &InvariantDrift::start, "in SI units")
      .def_readonly("largest_drift", &InvariantDrift::largest,
                    "greatest distance from the start, same unit");

  py::class_<Term>(m, "Term", "A term of the equation of motion.")
      .def_readonly("part", &Term::part, "relative, guide, Coriolis or load")
      .def_readonly("name", &Term::name, "its formula")
      .def_readonly("kept", &Term::kept, "whether it is computed")
      .def_readonly("why", &Term::why, "why not, or which components are not");

  using Report = RunReport;
  py::class_<Report>(m, "Report", "Error and cost of a run.")
      .def_readonly("method", &Report::method, "method of the run")
      .def_readonly("tolerance", &Report::tolerance, "requested tolerance")
      .def_readonly("error_estimate", &Report::error_estimate,
                    "of the global error: attitudes in rad, others relative to their size")
      .def_property_readonly(
          "truncation", [](const Report& report) { return report.error_parts.truncation; },
          "part of error_estimate: errors of the steps")
      .def_property_readonly(
          "rounding", [](const Report& report) { return report.error_parts.rounding; },
          "part of error_estimate: rounding and its growth")
      .def_readonly("tolerance_kept", &Report::tolerance_kept, "error_estimate <= tolerance")
      .def_readonly("all_evaluations", &Report::all_evaluations,
                    "including those for the estimate and for attempts that missed the tolerance")
      .def_readonly("run_time", &Report::run_time, "s")
      .def_readonly("invariants", &Report::invariants, "quantities that should be constant")
      .def_property_readonly(
          "steps", [](const Report& r) { return r.effort.steps; }, "accepted steps")
      .def_property_readonly(
          "rejected", [](const Report& r) { return r.effort.rejected; },
          "steps that were too long and repeated")
      .def_property_readonly(
          "evaluations", [](const Report& r) { return r.effort.evaluations; },
          "of the equations, for the returned motion");
}

void define_scene(py::module_& m) {
  py::class_<SceneSetting>(m, "Setting")
      .def(py::init([](std::string key, std::string value, std::string place) {
        return SceneSetting{std::move(key), std::move(value), std::move(place)};
      }));
  py::class_<SceneText>(m, "SceneText")
      .def(py::init(
          [](std::string text, std::filesystem::path path, std::vector<SceneSetting> settings) {
            return SceneText{std::move(text), std::move(path), std::move(settings)};
          }));
  py::class_<RunOptions>(m, "RunOptions")
      .def(py::init<>())
      .def_readwrite("t_end", &RunOptions::t_end)
      .def_readwrite("tolerance", &RunOptions::tolerance)
      .def_readwrite("method", &RunOptions::method)
      .def_readwrite("times", &RunOptions::times)
      .def_readwrite("reactions", &RunOptions::reactions)
      .def_readwrite("elements", &RunOptions::elements)
      .def_readwrite("constraints", &RunOptions::constraints)
      .def_readwrite("terms", &RunOptions::terms);
}

using Sweep = std::tuple<std::string, std::vector<double>, std::vector<double>>;
using ResponseWords = std::tuple<std::string, std::string, std::vector<double>>;

std::string analyze_scene(const SceneText& scene, const std::optional<Sweep>& campbell,
                          const std::optional<ResponseWords>& response,
                          std::optional<double> period, const py::object& progress) {
  scene_analysis::AnalysisRequest request;
  request.period = period;
  if (campbell) {
    const auto& [body, speeds, orders] = *campbell;
    request.campbell = {body, speeds, orders};
  }
  if (response) {
    const auto& [input, output, frequencies] = *response;
    request.response = {input, output, frequencies};
  }
  return without_lock(progress, [&](const std::stop_token& stop, std::atomic<double>& share) {
    request.progress = [&share](double done) { share = done; };
    return analyze(scene, request, stop);
  });
}

}  // namespace

PYBIND11_MODULE(_kreisel, m) {
  m.doc() = "The compiled part of kreisel.";
  py::register_exception_translator(&translate);
  m.def("version", &version);
  define_records(m);
  define_report(m);
  define_scene(m);
  define_motors(m);
  m.def("examine", &examine, py::call_guard<py::gil_scoped_release>());
  m.def("solve", &solve_scene);
  m.def("ensemble", &ensemble);
  m.def("analyze", &analyze_scene);
  m.def("state_space", [](const SceneText& scene) {
    return without_lock(py::none(),
                        [&](const auto& stop, auto&) { return state_space(scene, stop); });
  });
  m.def("pendulum_deviation", [](const std::map<std::string, std::string>& options) {
    return without_lock(py::none(),
                        [&](const auto&, auto&) { return pendulum_deviation(options); });
  });
}
