// The Python module kreisel: scene files and their motion as numpy arrays.

#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <future>
#include <iomanip>
#include <iterator>
#include <memory>
#include <optional>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>
#include <sstream>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include <dynamics/file/columns.hpp>
#include <dynamics/file/model.hpp>
#include <dynamics/file/readings.hpp>
#include <motor/error.hpp>

using namespace kreisel;

namespace py = pybind11;
using namespace py::literals;

namespace {

/// The text of a scene, so that every run can override its end, tolerance and method.
struct Scene {
  std::string text;
  std::filesystem::path path;
};

struct Run {
  std::string title;
  std::string model;
  std::vector<std::string> columns;
  py::array_t<double> rows;
  py::dict coordinates;
  py::dict rates;
  py::dict reactions;
  py::dict elements;
  py::dict constraints;
  py::dict sensors;
  py::array_t<double> errors;
  std::vector<kreisel::Term> terms;
  kreisel::RunReport report;
};

Scene scene_of_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file || std::filesystem::is_directory(path)) {
    throw kreisel::InvalidInput(path.string() + ": cannot be read");
  }
  Scene scene{{std::istreambuf_iterator<char>(file), {}}, path};
  static_cast<void>(kreisel::parse_scene(scene.text, scene.path));
  return scene;
}

Scene scene_of_text(std::string text, std::filesystem::path path) {
  static_cast<void>(kreisel::parse_scene(text, path));
  return {std::move(text), std::move(path)};
}

/// A text quoted as in TOML.
std::string quoted(const std::string& text) {
  std::ostringstream out;
  out << '"' << std::hex << std::setfill('0');
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7F) {
      out << "\\u" << std::setw(4) << static_cast<int>(byte);
    } else {
      if (c == '"' || c == '\\') out << '\\';
      out << c;
    }
  }
  return out.str() + '"';
}

/// A key of TOML, quoted if necessary.
std::string key_of(const std::string& word) {
  const bool bare =
      !word.empty() && word.find_first_not_of("abcdefghijklmnopqrstuvwxyz_") == std::string::npos;
  return bare ? word : quoted(word);
}

std::string toml_of(const std::string& key, const py::handle& value);

/// A list as TOML, with `between` between its entries.
std::string toml_list(const std::string& key, const py::handle& values,
                      const std::string& between) {
  std::string text = "[" + between;
  int i = 0;
  for (const py::handle item : values) {
    text += toml_of(key + "[" + std::to_string(i) + "]", item) + "," + between;
    ++i;
  }
  return text + "]";
}

std::string toml_table(const std::string& key, const py::dict& table) {
  std::string text = "{";
  for (const auto& [name, value] : table) {
    if (!py::isinstance<py::str>(name)) throw py::type_error(key + ": keys must be text");
    const auto word = name.cast<std::string>();
    if (text.size() > 1) text += ", ";
    text += key_of(word) + " = " + toml_of(key + "." + word, value);
  }
  return text + "}";
}

/// A Python value as TOML; numbers keep all their digits.
/// Throws : TypeError naming the key, for a value that TOML does not have
std::string toml_of(const std::string& key, const py::handle& value) {
  if (py::hasattr(value, "tolist")) return toml_of(key, value.attr("tolist")());  // numpy's
  if (py::hasattr(value, "__fspath__")) return toml_of(key, value.attr("__fspath__")());
  if (py::isinstance<py::bool_>(value)) return value.cast<bool>() ? "true" : "false";
  if (py::isinstance<py::int_>(value))
    return py::str(py::int_(py::reinterpret_borrow<py::object>(value)));
  if (py::isinstance<py::float_>(value)) return py::repr(py::float_(value.cast<double>()));
  if (py::isinstance<py::str>(value)) return quoted(value.cast<std::string>());
  if (py::isinstance<py::dict>(value)) return toml_table(key, value.cast<py::dict>());
  if (py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value)) {
    return toml_list(key, value, "");
  }
  throw py::type_error(key + ": a scene has no value of type " +
                       py::str(py::type::handle_of(value).attr("__name__")).cast<std::string>());
}

/// The scene from keyword arguments, with a line for each keyword and for each body, element,
/// constraint and sensor.
Scene scene_of_keywords(const py::kwargs& keywords) {
  std::string text;
  for (const auto& [name, value] : keywords) {
    const auto key = name.cast<std::string>();
    const bool list =
        (key == "body" || key == "sensor" || key == "element" || key == "constraint") &&
        (py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value));
    text += key_of(key) + " = " + (list ? toml_list(key, value, "\n") : toml_of(key, value)) + "\n";
  }
  return scene_of_text(std::move(text), "keywords");
}

/// Calls `work(stop)` in a thread of its own, without Python's lock. Checks Python's signals ten times a
/// second; a signal requests the stop.
///
/// Throws : the exceptions of the work; the exception of the signal
template <class Work>
void run_interruptibly(const Work& work) {
  std::stop_source source;
  bool interrupted = false;
  {
    const py::gil_scoped_release released;
    auto done = std::async(std::launch::async, [&] { work(source.get_token()); });
    while (!interrupted &&
           done.wait_for(std::chrono::milliseconds(100)) != std::future_status::ready) {
      const py::gil_scoped_acquire lock;
      interrupted = PyErr_CheckSignals() != 0;
    }
    if (interrupted) {
      source.request_stop();
      done.wait();
    } else {
      done.get();
    }
  }
  if (interrupted) throw py::error_already_set();
}

kreisel::SceneFile requested(const Scene& scene, std::optional<double> t_end,
                             const std::optional<double>& tolerance,
                             const std::optional<std::string>& method,
                             const std::optional<std::vector<double>>& times) {
  if (times && t_end)
    throw kreisel::InvalidInput("t_end and times exclude each other: give one of them");
  if (times && times->empty()) throw kreisel::InvalidInput("times must not be empty");
  if (times) t_end = times->back();
  if (t_end && !std::isfinite(*t_end)) {
    throw kreisel::InvalidInput("t_end must be a finite number");
  }
  kreisel::SolveRequest request{t_end, tolerance, {}};
  if (method) {
    request.method = kreisel::method_named(*method);
    if (!request.method) throw kreisel::InvalidInput("method '" + *method + "' is unknown");
  }
  kreisel::SceneFile file = kreisel::parse_scene(scene.text, scene.path, request);
  if (times && times->front() < file.t_begin) {
    throw kreisel::InvalidInput("times must not begin before t_begin of the scene");
  }
  if (times) {
    file.output_times = with_samples(*times, file.sensors, file.t_begin, file.t_end);
  }
  if (file.output_times.empty() || file.output_times.back() < file.t_end) {
    file.output_times.push_back(file.t_end);
  }
  return file;
}

/// Columns [begin, begin + count) of the rows, or the one column as a vector.
py::object part(const py::array_t<double>& rows, std::size_t begin, int count) {
  const py::slice all{std::nullopt, std::nullopt, std::nullopt};
  if (count == 1) return rows[py::make_tuple(all, begin)];
  const auto first = static_cast<py::ssize_t>(begin);
  return rows[py::make_tuple(all, py::slice(first, first + count, 1))];
}

/// Issues a RuntimeWarning if the tolerance was not reached. Throws if Python treats warnings as
/// errors.
void warn_if_missed(const kreisel::RunReport& report) {
  if (report.tolerance_kept) return;
  std::ostringstream text;
  text << "the tolerance " << report.tolerance << " was not reached, the error is about "
       << report.error_estimate;
  if (PyErr_WarnEx(PyExc_RuntimeWarning, text.str().c_str(), 1) != 0) {
    throw py::error_already_set();
  }
}

Run solve_scene(const Scene& scene, std::optional<double> t_end, std::optional<double> tolerance,
                const std::optional<std::string>& method,
                const std::optional<std::vector<double>>& times, bool reactions, bool elements,
                bool constraints) {
  kreisel::SceneFile file = requested(scene, t_end, tolerance, method, times);
  file.reactions = reactions;
  file.element_forces = elements;
  file.constraint_forces = constraints;
  const std::unique_ptr<kreisel::SceneSolver> model = make_model(file);
  kreisel::SolveOptions options = options_of(file);
  options.output_times = file.output_times;
  kreisel::Trajectory<kreisel::JointState> run;
  std::vector<std::vector<double>> numbers;
  kreisel::SensorReadings readings(file);
  run_interruptibly([&](const std::stop_token& stop) {
    options.stop = stop;
    run = model->solve(options, start_of(file));
    for (std::size_t i = 0; i < run.states.size() && !stop.stop_requested(); ++i) {
      numbers.push_back(
          row(*model, run.times[i], run.states[i], {reactions, elements, constraints}));
      const std::vector<double> own = readings.row(*model, run.times[i], run.states[i]);
      numbers.back().insert(numbers.back().end(), own.begin(), own.end());
    }
  });
  if (run.report.status == kreisel::RunStatus::failed) {
    throw kreisel::ComputationFailed(run.report.message);
  }
  warn_if_missed(run.report);

  Run result;
  result.title = file.title;
  result.model = name(file.model);
  const kreisel::Terms terms = model->equation_terms();
  result.terms.assign(terms.begin(), terms.end());
  result.errors =
      py::array_t<double>(static_cast<py::ssize_t>(run.errors.size()), run.errors.data());
  result.report = run.report;
  result.columns = columns(file);
  const std::size_t width = result.columns.size();
  result.rows = py::array_t<double>({numbers.size(), width});
  auto cells = result.rows.mutable_unchecked<2>();
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    for (std::size_t k = 0; k < width; ++k) {
      cells(static_cast<py::ssize_t>(i), static_cast<py::ssize_t>(k)) = numbers[i][k];
    }
  }
  std::size_t at = 1;
  for (std::size_t i = 0; i < file.bodies.size(); ++i) {
    const auto [q, q_count, v, v_count] = model->tree().place(static_cast<int>(i));
    const py::str name(file.bodies[i].name);
    result.coordinates[name] = part(result.rows, at, q_count);
    at += static_cast<std::size_t>(q_count);
    result.rates[name] = part(result.rows, at, v_count);
    at += static_cast<std::size_t>(v_count);
  }
  for (const kreisel::BodyDescription& body : file.bodies) {
    if (!reactions) break;
    result.reactions[py::str(body.name)] =
        py::dict("force"_a = part(result.rows, at, 3), "torque"_a = part(result.rows, at + 3, 3),
                 "drive_torque"_a = part(result.rows, at + 6, 1));
    at += 7;
  }
  const auto add_force = [&](py::dict& to, const std::string& name) {
    to[py::str(name)] =
        py::dict("force"_a = part(result.rows, at, 3), "torque"_a = part(result.rows, at + 3, 3));
    at += 6;
  };
  for (const kreisel::Element& element : file.elements) {
    if (elements) add_force(result.elements, kreisel::name(element));
  }
  for (const kreisel::Constraint& constraint : file.constraints) {
    if (constraints) add_force(result.constraints, constraint.name);
  }
  for (const kreisel::SceneSensor& sensor : file.sensors) {
    py::dict reading;
    for (const kreisel::SensorPart& piece : parts(sensor, file.bodies)) {
      const auto count = static_cast<int>(piece.components.size());
      reading[py::str(piece.name)] = part(result.rows, at, count);
      at += piece.components.size();
    }
    result.sensors[py::str(sensor.name)] = std::move(reading);
  }
  return result;
}

}  // namespace

PYBIND11_MODULE(kreisel, m) {
  m.doc() =
      "Rigid bodies, pendulums and gyros seen from moving frames.\n\n"
      "SI units and radians. Quaternions are (w, x, y, z).";

  // Python tries the latest first, so derived exceptions are registered after their base.
  const auto error = py::register_exception<kreisel::Error>(m, "Error");
  const auto invalid = py::register_exception<kreisel::InvalidInput>(m, "InvalidInput", error);
  py::register_exception<kreisel::SceneMistakes>(m, "SceneMistakes", invalid);
  py::register_exception<kreisel::ComputationFailed>(m, "ComputationFailed", error);
  m.attr("Error").attr("__doc__") = "Base class of the exceptions of this module.";
  m.attr("InvalidInput").attr("__doc__") =
      "Invalid data; the message names the value and the reason.";
  m.attr("SceneMistakes").attr("__doc__") =
      "Mistakes in a scene, a line for each: file:line:column: key: reason.";
  m.attr("ComputationFailed").attr("__doc__") = "Valid data without a computable answer.";

  py::class_<kreisel::InvariantDrift>(m, "Invariant", "A number that should not change in a run.")
      .def_readonly("name", &kreisel::InvariantDrift::name, "energy, momenta, ...")
      .def_readonly("start", &kreisel::InvariantDrift::start, "in SI units")
      .def_readonly("largest_drift", &kreisel::InvariantDrift::largest,
                    "greatest distance from the start, same unit");

  py::class_<kreisel::Term>(m, "Term", "A term of the equation of motion.")
      .def_readonly("part", &kreisel::Term::part, "relative, guide, Coriolis or load")
      .def_readonly("name", &kreisel::Term::name, "its formula")
      .def_readonly("kept", &kreisel::Term::kept, "whether it is computed")
      .def_readonly("why", &kreisel::Term::why, "why not, or which components are not");

  using Report = kreisel::RunReport;
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

  py::class_<Run>(m, "Run", "A computed motion. Arrays are by output time.")
      .def_readonly("title", &Run::title, "title of the scene")
      .def_readonly("model", &Run::model, "exact, or the requested approximation")
      .def_readonly("columns", &Run::columns, "names of the columns of rows")
      .def_readonly("rows", &Run::rows, "the numbers of simulate --csv")
      .def_property_readonly(
          "times", [](const Run& run) { return part(run.rows, 0, 1); }, "s")
      .def_readonly("coordinates", &Run::coordinates,
                    "by body: angle in rad or displacement in m; two angles; attitude against the "
                    "parent, and of a free body its position in m")
      .def_readonly("rates", &Run::rates,
                    "by body: rad/s or m/s; angular velocity on body axes, and of a free body its "
                    "velocity in m/s on the parent's axes")
      .def_readonly("reactions", &Run::reactions,
                    "by body, on request: 'force' in N and 'torque' in N m of the parent at the "
                    "joint, on body axes, and 'drive_torque' in N m")
      .def_readonly("elements", &Run::elements,
                    "by element, on request: 'force' in N and 'torque' in N m on its second body, "
                    "about its end there, on the first body's axes")
      .def_readonly(
          "constraints", &Run::constraints,
          "by constraint, on request: 'force' in N and 'torque' in N m on its second body, "
          "about its point, on the first body's axes")
      .def_readonly("sensors", &Run::sensors,
                    "by sensor a dict of its parts: 'value', with errors also 'true'; of a point "
                    "'position', 'velocity', 'acceleration'; of a reaction 'force', 'torque'")
      .def_readonly(
          "errors", &Run::errors,
          "estimates of the global error over time; Report.error_estimate is the greatest")
      .def_readonly("terms", &Run::terms, "terms of the exact equation, kept and dropped")
      .def_readonly("report", &Run::report, "error and cost of the run");

  py::class_<Scene>(m, "Scene",
                    "A mechanical system on a guide frame, described as in a scene file.")
      .def(py::init(&scene_of_file), "path"_a, "Reads a scene file (TOML).")
      .def(py::init(&scene_of_keywords),
           "Builds a scene from keyword arguments: title, guide, gravity, body, sensor, solve, "
           "report, as in a\nscene file. Tables are dicts, body and sensor are lists of dicts; "
           "numpy "
           "arrays are lists.\n\n"
           "    Scene(gravity={'kind': 'uniform', 'vector': [0, 0, -9.81]},\n"
           "          body=[{'name': 'rod', 'joint': {'kind': 'revolute', 'axis': [0, 1, 0]},\n"
           "                 'mass': 1, 'centre': [0, 0, -1], 'inertia': [0.1, 0.1, 0.1]}],\n"
           "          solve={'t_end': 2})")
      .def_readonly("text", &Scene::text, "the scene as the text of a scene file")
      .def_static(
          "from_text", &scene_of_text, "text"_a, "path"_a = "scene.toml",
          "Builds a scene from the text of a scene file. path is its name in messages; its logs "
          "are searched beside path.")
      .def("solve", &solve_scene, py::kw_only(), "t_end"_a = py::none(), "tolerance"_a = py::none(),
           "method"_a = py::none(), "times"_a = py::none(), "reactions"_a = false,
           "elements"_a = false, "constraints"_a = false,
           "Computes the motion from t = 0.\n\n"
           "t_end      s; times in s, increasing, instead of the scene's output times\n"
           "tolerance  bound of the global error, see Report.error_estimate\n"
           "method     auto, closed form, verner98, gauss16, radau13, splitting, taylor\n"
           "reactions  True: return the load of every joint\n"
           "elements   True: return the force of every element\n"
           "constraints True: return the reaction of every constraint\n\n"
           "Omitted arguments are those of the scene. Python's lock is released during the run.");
}
