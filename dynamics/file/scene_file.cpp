#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include <dynamics/file/columns.hpp>
#include <dynamics/file/constraint_keys.hpp>
#include <dynamics/file/controller_keys.hpp>
#include <dynamics/file/element_keys.hpp>
#include <dynamics/file/scene_file.hpp>
#include <dynamics/file/scene_guide.hpp>
#include <dynamics/file/scene_section.hpp>
#include <dynamics/file/scene_signal.hpp>
#include <dynamics/file/sensor_keys.hpp>
#include <dynamics/file/setting_keys.hpp>
#include <dynamics/file/signal_log.hpp>
#include <dynamics/file/text_file.hpp>
#include <dynamics/file/toml_text.hpp>
#include <dynamics/inertia.hpp>
#include <dynamics/load/drag.hpp>
#include <dynamics/load/magnet.hpp>
#include <dynamics/load/signal_load.hpp>
#include <dynamics/tree/joint/list.hpp>
#include <motor/error.hpp>

namespace kreisel {

namespace {

using detail::Dimension;
using detail::joint_force;
using detail::KeyDimension;
using detail::Mistakes;
using detail::Range;
using detail::Section;
namespace dimension = detail::dimension;

constexpr std::size_t most_outputs = 10'000'000;

/// The dimension of each number.
std::vector<Dimension> dimensions(const std::vector<JointQuantity>& quantities) {
  std::vector<Dimension> result;
  for (const JointQuantity& quantity : quantities) {
    result.insert(result.end(), static_cast<std::size_t>(quantity.count()),
                  detail::dimension_of(quantity.unit));
  }
  return result;
}

/// The dimensions of stiffness or damping: joint forces per unit of the quantities.
std::vector<Dimension> forces_by(const std::vector<JointQuantity>& quantities) {
  std::vector<Dimension> result = dimensions(quantities);
  for (Dimension& of : result) of = joint_force(of) / of;
  return result;
}

/// The message of a library check, without the prefix that names the object.
std::string reason(const InvalidInput& error) {
  const std::string text = error.what();
  const std::size_t colon = text.find(": ");
  return colon == std::string::npos ? text : text.substr(colon + 2);
}

class SceneReader {
 public:
  SceneReader(const toml::table& root, const std::filesystem::path& path,
              const SolveRequest& request, Mistakes& mistakes, detail::SignalLogs& logs)
      : root_(root, "", mistakes, &logs),
        path_(path),
        request_(request),
        mistakes_(mistakes),
        logs_(logs) {}

  SceneFile read() {
    scene_.title = root_.text("title").value_or("");
    read_solve();
    logs_.set_run({scene_.t_begin, scene_.t_end});
    detail::GuideSection guide =
        detail::read_guide(root_, path_, scene_.t_begin, scene_.t_end, mistakes_);
    scene_.discontinuities = std::move(guide.discontinuities);
    read_gravity(guide);
    detail::give_gravity_to_rates(guide, scene_.gravity);
    scene_.guide = std::move(guide.links);
    read_bodies();
    scene_.elements = detail::read_elements(root_, scene_, mistakes_.none());
    for (const Element& element : scene_.elements) {
      if (const auto* const rope = std::get_if<RopeElement>(&element)) note(rope->length);
    }
    detail::read_constraints(root_, assembles_, mistakes_.none(), scene_);
    scene_.sensors = detail::read_sensors(root_, scene_, mistakes_.none());
    detail::read_controllers(root_, mistakes_.none(), scene_);
    for (const Controller& controller : scene_.controllers) {
      for (const Signal<double>& reference : controller.reference) note(reference);
    }
    read_report();
    put_discontinuities_in_order();
    add_samples();
    if (mistakes_.none()) scene_.columns = detail::read_output(root_, columns(scene_));
    (void)root_.has("output");
    root_.finish();
    scene_.signal_logs = logs_.read();
    scene_.frequencies = logs_.frequencies();
    mistakes_.throw_any();
    return std::move(scene_);
  }

 private:
  void read_solve() {
    auto solve = root_.section("solve");
    if (!solve) {
      if (!root_.has("solve") && !request_.t_end) {
        root_.refuse_all("the table [solve] with its key 't_end' is missing");
      }
      scene_.t_end = request_.t_end.value_or(1);
      if (!(scene_.t_end > 0)) root_.refuse_all("the run must end after t = 0 s");
      if (mistakes_.none()) set_times({}, {});
      return;
    }
    read_begin_and_end(*solve);
    if (const auto tolerance = solve->number("tolerance", dimension::number)) {
      if (*tolerance >= 1e-15 && *tolerance <= 1e-2) {
        scene_.tolerance = *tolerance;
      } else {
        solve->refuse("tolerance", "lies outside [1e-15, 1e-2], what double precision can promise");
      }
    }
    scene_.tolerance = request_.tolerance.value_or(scene_.tolerance);
    const std::string method =
        solve->choice("method", {"auto", "automatic", "closed form", "verner98", "gauss16",
                                 "radau13", "splitting", "taylor"});
    scene_.method = request_.method.value_or(*method_named(method));
    read_model(*solve);
    const auto step = solve->number("output_step", dimension::time, Range::positive);
    const auto times = solve->numbers("output_times", dimension::time);
    if (step && times) {
      solve->refuse("output_times", "is given beside 'output_step'; one of them says when");
    }
    if (step && scene_.duration() / *step > most_outputs) {
      solve->refuse("output_step", "asks for more than ten million rows");
    }
    if (times) check_times(*solve, *times);
    assembles_ = solve->flag("assemble");
    solve->finish();
    if (mistakes_.none()) set_times(step, times);
  }

  void read_begin_and_end(Section& solve) {
    scene_.t_begin = solve.number("t_begin", dimension::time).value_or(0);
    const auto end = solve.number("t_end", dimension::time);
    if (!request_.t_end && !solve.has("t_end")) solve.refuse_missing("t_end");
    const bool has_begin = scene_.t_begin != 0;
    if (end && !(*end > scene_.t_begin)) {
      solve.refuse("t_end", detail::shown_time(*end) +
                                (has_begin ? " s must be after t_begin, " +
                                                 detail::shown_time(scene_.t_begin) + " s"
                                           : " must be above 0"));
    }
    if (request_.t_end && !(*request_.t_end > scene_.t_begin)) {
      solve.refuse(has_begin ? "t_begin" : "t_end",
                   "the run must end after t = " + detail::shown_time(scene_.t_begin) +
                       " s, not at the " + detail::shown_time(*request_.t_end) +
                       " s that were asked for");
    }
    scene_.t_end = request_.t_end.value_or(end.value_or(scene_.t_begin + 1));
  }

  void read_model(Section& solve) {
    using enum SceneModel;
    const SceneModel models[] = {exact, linear, small, precession, foeppl, fuchs_weigand};
    std::vector<std::string> names;
    for (const SceneModel model : models) names.emplace_back(name(model));
    const std::string chosen = solve.choice("model", names);
    for (const SceneModel model : models) {
      if (chosen == name(model)) scene_.model = model;
    }
    scene_.compare = solve.flag("compare");
    if (scene_.compare && scene_.model == exact) {
      solve.refuse("compare", "compares an approximation with the exact motion; give a 'model'");
    }
  }

  void check_times(Section& solve, const std::vector<double>& times) const {
    if (times.empty()) solve.refuse("output_times", "is empty");
    double before = 0;
    for (std::size_t i = 0; i < times.size(); ++i) {
      if (times[i] < scene_.t_begin) {
        solve.refuse("output_times", "begins before t = " + detail::shown_time(scene_.t_begin));
        return;
      }
      if (i > 0 && !(times[i] > before)) {
        solve.refuse("output_times", "does not increase at number " + std::to_string(i + 1));
        return;
      }
      before = times[i];
    }
    if (!times.empty() && !request_.t_end && times.back() > scene_.t_end) {
      solve.refuse("output_times", "goes on after t_end");
    }
  }

  void set_times(const std::optional<double>& given_step,
                 const std::optional<std::vector<double>>& given) {
    const double end = scene_.t_end;
    outputs_are_given_ = given || given_step;
    if (given) {
      std::copy_if(given->begin(), given->end(), std::back_inserter(scene_.output_times),
                   [end](double t) { return t <= end; });
      return;
    }
    scene_.output_times =
        detail::output_grid(scene_.t_begin, end, given_step.value_or(scene_.duration() / 500));
  }

  /// Notes that forces change, and the times within the run at which the signal is discontinuous.
  template <class Value>
  void note(const Signal<Value>& signal) {
    if (signal.is_constant()) return;
    scene_.forces_change = true;
    for (const double t : signal.discontinuities()) {
      if (t > scene_.t_begin && t <= scene_.t_end) scene_.discontinuities.push_back(t);
    }
  }

  /// Makes the samples of sensors rows of the run. They replace the default rows.
  void add_samples() {
    std::vector<double>& times = scene_.output_times;
    const bool none = std::none_of(scene_.sensors.begin(), scene_.sensors.end(),
                                   [](const SceneSensor& sensor) { return sensor.period > 0; });
    if (none || !mistakes_.none()) return;
    if (!outputs_are_given_) times = {scene_.t_end};
    times = with_samples(times, scene_.sensors, scene_.t_begin, scene_.t_end);
  }

  void put_discontinuities_in_order() {
    auto& times = scene_.discontinuities;
    std::sort(times.begin(), times.end());
    times.erase(std::unique(times.begin(), times.end()), times.end());
  }

  void read_gravity(const detail::GuideSection& guide) {
    scene_.gravity = scene_gravity::None{};
    if (!root_.has("gravity")) {
      scene_.gravity = guide.gravity;
      return;
    }
    auto gravity = root_.section("gravity");
    if (!gravity) return;
    if (!gravity->has("kind")) {
      gravity->refuse("kind",
                      "is missing: give none, uniform, inertial, earth, point, j2 or orbit");
      gravity->ignore_rest();
    }
    const std::string kind =
        gravity->choice("kind", {"none", "uniform", "inertial", "earth", "point", "j2", "orbit"});
    if (gravity->has("kind") && gravity->text("kind").value_or("") != kind) gravity->ignore_rest();
    if (kind == "uniform") {
      scene_.gravity =
          UniformGravity<Guide>{gravity->required_vector("vector", dimension::acceleration)};
    }
    if (kind == "inertial") {
      scene_.gravity =
          UniformGravity<Inertial>{gravity->required_vector("vector", dimension::acceleration)};
    }
    const bool on_earth = std::holds_alternative<scene_guide::Earth>(guide.links.front()) ||
                          std::holds_alternative<scene_guide::Course>(guide.links.front());
    if (kind == "earth") {
      scene_.gravity = scene_gravity::Ellipsoid{};
      if (gravity->choice("field", {"normal", "j2"}) == "j2")
        scene_.gravity = OblateGravitation<>{};
      if (!on_earth) {
        gravity->refuse("kind",
                        "'earth' needs a guide of kind 'earth' or 'course', or a chain that "
                        "begins with one");
      }
    }
    if (kind == "point" || kind == "j2") scene_.gravity = read_planet(*gravity, kind == "j2");
    if (kind == "orbit") {
      const bool gradient = !gravity->has("gradient") || gravity->flag("gradient");
      scene_.gravity = scene_gravity::OnOrbit{gradient};
      const bool on_orbit = std::holds_alternative<scene_guide::Orbit>(guide.links.front());
      if (!on_orbit) {
        gravity->refuse("kind",
                        "'orbit' needs a guide of kind 'orbit', or a chain that begins with one");
      }
    }
    const bool number = std::holds_alternative<scene_gravity::AtSite>(guide.gravity);
    if (number) {
      gravity->refuse("kind", "'" + kind +
                                  "' gives gravity a second time; guide.gravity is a "
                                  "number already");
    }
    gravity->finish();
  }

  static OblateGravitation<> read_planet(Section& gravity, bool oblate) {
    OblateGravitation<> planet;
    planet.parameter = gravity.required_number("mu", dimension::gravitation, Range::positive);
    planet.j2 = oblate ? gravity.required_number("j2", dimension::number) : 0;
    if (oblate)
      planet.radius = gravity.required_number("radius", dimension::length, Range::positive);
    planet.centre = gravity.vector("centre", dimension::length).value_or(planet.centre);
    if (const auto pole = oblate ? gravity.vector("pole", dimension::number) : std::nullopt) {
      if (pole->isZero(0)) gravity.refuse("pole", "is 0 and has no direction");
      planet.pole = pole->normalized();
    }
    planet.gradient = gravity.flag("gradient");
    return planet;
  }

  void read_bodies() {
    if (!root_.has("body")) {
      root_.refuse_all("no [[body]] is given");
      return;
    }
    std::vector<Section> bodies = root_.sections("body");
    if (bodies.empty() && root_.find("body")->is_array()) root_.refuse("body", "is empty");
    std::vector<std::string> names;
    for (const Section& body : bodies) {
      names.push_back(Section(body).peek("name"));
    }
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      if (!names[i].empty()) bodies[i].rename("body '" + names[i] + "'");
      read_body(bodies[i], i, names);
      bodies[i].finish();
    }
  }

  void read_body(Section& section, std::size_t i, const std::vector<std::string>& names) {
    BodyDescription body;
    body.name = section.required_text("name");
    check_name(section, i, names);
    body.parent = section.text("parent").value_or("guide");
    check_parent(section, body.parent, i, names);
    const std::optional<Joint> joint = read_joint(section);
    read_inertia(section, body);
    scene_.points.push_back(detail::read_points(section));
    if (!joint) {  // the other keys of the body cannot be checked
      section.ignore_rest();
      scene_.bodies.push_back(std::move(body));
      scene_.start.emplace_back();
      return;
    }
    body.joint = *joint;
    read_forces(section, body);
    const std::optional<Drive> drive = read_drive(section, body);
    const bool held = section.flag("hold");
    if (drive && held) section.refuse("hold", "and 'drive' exclude each other");
    if (drive) body.rule = JointRule::driven;
    if (held) body.rule = JointRule::held;
    JointStart start = read_start(section, body);
    if (drive) start_drive(section, *drive, body, start);
    const bool turns =
        std::any_of(start.rates.begin(), start.rates.end(), [](double rate) { return rate != 0; });
    if (held && turns) section.refuse("hold", "locks a joint whose initial rate is not 0");
    read_loads(section, body);
    read_rotor(section, body, start);
    scene_.bodies.push_back(std::move(body));
    scene_.start.push_back(std::move(start));
  }

  /// A prescribed motion of a joint: a coordinate or its rate as a function of time.
  struct Drive {
    std::optional<Signal<double>> motion = std::nullopt;  ///< none: at a constant rate
    bool is_rate = false;
    std::string key = {};
  };

  std::optional<Drive> read_drive(Section& section, const BodyDescription& body) {
    const toml::node* const node = section.find("drive");
    if (node == nullptr) return std::nullopt;
    std::optional<Drive> drive;
    if (node->is_table()) {
      drive = read_prescribed(*section.section("drive"), body.joint.kind);
    } else if (section.choice("drive", {"none", "constant-rate"}) == "constant-rate") {
      drive.emplace();
    }
    if (drive && !joint_type(body.joint.kind).can_be_driven()) {
      section.refuse("drive", "is for a revolute, prismatic or screw joint");
    }
    return drive;
  }

  std::optional<Drive> read_prescribed(Section section, JointKind kind) {
    const std::string coordinate = kind == JointKind::prismatic ? "displacement" : "angle";
    Drive drive;
    for (const std::string& key : {coordinate, std::string("rate")}) {
      const bool given = section.has(key) || section.has(key + "_deg");
      if (!given) continue;
      if (drive.motion) {
        section.refuse(key, "is given beside '" + drive.key + "'; one of them is the motion");
        continue;
      }
      drive.key = section.has(key) ? key : key + "_deg";
      drive.is_rate = key == "rate";
      const JointType& type = joint_type(kind);
      const Dimension of = dimensions(drive.is_rate ? type.rates : type.coordinates).front();
      drive.motion = kind == JointKind::prismatic ? detail::read_signal<double>(section, key, of)
                                                  : detail::read_angle_signal(section, key, of);
      if (drive.motion) check_drive(section, drive);
    }
    if (drive.key.empty()) {
      section.refuse_all("is the motion of the joint: give '" + coordinate + "' or 'rate'");
    }
    section.finish();
    return drive.motion ? std::optional(drive) : std::nullopt;
  }

  /// A jump of the rate would take an infinite force.
  void check_drive(Section& section, const Drive& drive) {
    const Signal<double>& motion = *drive.motion;
    note(motion);
    if (drive.is_rate ? !motion.jumps() : motion.is_smooth()) return;
    section.refuse(drive.key, "jumps, or its rate does, at t = " +
                                  detail::shown_time(motion.discontinuities().front()) +
                                  " s, which takes an infinite force; give " +
                                  (drive.is_rate ? "'points'" : "'constant', 'rate' and 'terms'"));
  }

  /// Sets the start to the prescribed motion. A start in the file must not contradict it.
  void start_drive(Section& section, const Drive& drive, BodyDescription& body,
                   JointStart& start) const {
    if (!drive.motion || start.coordinates.size() != 1) return;
    const Signal<double>& motion = *drive.motion;
    auto initial = section.section("initial");
    const auto set = [&](double& number, double value, const std::string& key) {
      const bool is_given = initial && (initial->has(key) || initial->has(key + "_deg"));
      if (is_given && number != value) {
        initial->refuse(initial->has(key) ? key : key + "_deg",
                        "differs from 'drive' at t = " + detail::shown_time(scene_.t_begin));
      }
      number = value;
    };
    const JointType& type = joint_type(body.joint.kind);
    if (!drive.is_rate)
      set(start.coordinates.front(), motion(scene_.t_begin), type.coordinates[0].key);
    set(start.rates.front(), motion.derivative(scene_.t_begin, drive.is_rate ? 0 : 1),
        type.rates[0].key);
    if (!motion.is_constant()) body.acceleration = TimeFunction(motion, drive.is_rate ? 1 : 2);
  }

  static void check_name(Section& section, std::size_t i, const std::vector<std::string>& names) {
    const std::string& name = names[i];
    if (name.empty()) {
      if (section.has("name") && section.find("name")->is_string()) {
        section.refuse("name", "is empty");
      }
      return;
    }
    if (name == "guide") section.refuse("name", "'guide' is reserved for the guide frame");
    const auto end = names.begin() + static_cast<std::ptrdiff_t>(i);
    if (std::find(names.begin(), end, name) != end) {
      section.refuse("name", "is used by an earlier body; a body has one joint to one parent");
    }
  }

  void check_parent(Section& section, const std::string& parent, std::size_t i,
                    const std::vector<std::string>& names) const {
    if (parent == "guide") return;
    const auto here = names.begin() + static_cast<std::ptrdiff_t>(i);
    const auto found = std::find(names.begin(), here, parent);
    if (found != here) {
      const auto k = static_cast<std::size_t>(found - names.begin());
      if (scene_.bodies[k].rotor) {
        section.refuse("parent", "'" + parent + "' is a rotor, which can carry nothing");
      }
      return;
    }
    if (parent == names[i]) {
      section.refuse("parent", "is the body itself");
    } else if (std::find(here, names.end(), parent) != names.end()) {
      section.refuse("parent", "'" + parent + "' comes later; parents come before children");
    } else {
      std::vector<std::string> known(names.begin(), here);
      known.emplace_back("guide");
      section.refuse("parent", "'" + parent + "' is no body" + detail::did_you_mean(parent, known));
    }
  }

  static std::vector<std::string> joint_names() {
    std::vector<std::string> names;
    for (const JointType& type : joint_types()) names.push_back(type.name);
    return names;
  }

  static void read_axes(Section& section, const JointType& type, Joint& joint) {
    joint.kind = type.kind;
    const auto axis = [&section](std::string_view key, JointType::Axis need, Vector3<double>& a) {
      const bool optional = need == JointType::Axis::optional && section.has(key);
      if (need != JointType::Axis::required && !optional) return false;
      a = section.required_vector(key, dimension::number);
      if (!(a.norm() > 0)) section.refuse(key, "is 0 and has no direction");
      return true;
    };
    axis("axis", type.axis, joint.axis);
    if (type.has_pitch) {
      joint.pitch = section.required_number("pitch", dimension::length / dimension::angle);
      if (joint.pitch == 0 && section.has("pitch")) {
        section.refuse("pitch", "is 0: the joint does not advance; take 'revolute'");
      }
    }
    if (!axis("second_axis", type.second_axis, joint.second_axis)) return;
    if (!(joint.axis.normalized().cross(joint.second_axis.normalized()).norm() > 1e-12)) {
      section.refuse("second_axis", "is parallel to 'axis'");
    }
  }

  /// Reads the joint; nothing if its kind is missing or unknown.
  static std::optional<Joint> read_joint(Section& body) {
    Joint joint;
    auto section = body.required_section("joint");
    if (!section) return {};
    const std::string kind = section->required_choice("kind", joint_names());
    for (const JointType& type : joint_types()) {
      if (type.name == kind) read_axes(*section, type, joint);
    }
    joint.position =
        section->vector("position", dimension::length).value_or(Vector3<double>::Zero());
    joint.orientation =
        quaternion(*section, "orientation").value_or(Eigen::Quaterniond::Identity());
    if (section->text("kind").value_or("") != kind) return {};
    section->finish();
    return joint;
  }

  static void read_inertia(Section& section, BodyDescription& body) {
    const double mass = section.required_number("mass", dimension::mass, Range::not_negative);
    const Vector3<double> centre =
        section.vector("centre", dimension::length).value_or(Vector3<double>::Zero());
    if (!section.has("inertia")) section.refuse_missing("inertia");
    const auto numbers = section.numbers("inertia", dimension::inertia);
    if (!numbers) return;
    if (numbers->size() != 3 && numbers->size() != 6) {
      section.refuse("inertia", "must be 3 numbers, or 6 (xx, yy, zz, xy, xz, yz), not " +
                                    std::to_string(numbers->size()));
      return;
    }
    std::vector<double> t = *numbers;
    t.resize(6, 0);
    const Symmetric3<double> tensor{t[0], t[1], t[2], t[3], t[4], t[5]};
    try {
      body.inertia =
          InertiaTensor<Body>::about_centre(mass, centre, tensor.matrix(), Mass::zero_allowed);
    } catch (const InvalidInput& error) {
      section.refuse("inertia", reason(error));
    }
  }

  void read_given_forces(Section& section, const JointType& type, std::vector<JointForce>& forces) {
    std::vector<Dimension> each = dimensions(type.coordinates);
    for (Dimension& of : each) of = joint_force(of);
    const auto signals = detail::read_signals(section, "force", each);
    for (std::size_t k = 0; k < signals.size(); ++k) {
      note(signals[k]);
      if (signals[k].is_constant()) {
        forces[k].constant = signals[k](0.0);
      } else {
        forces[k].in_time = signals[k];
      }
    }
  }

  void read_forces(Section& section, BodyDescription& body) {
    const bool asked = section.has("spring") || section.has("damping") || section.has("force");
    if (!asked) return;
    const JointType& type = joint_type(body.joint.kind);
    const auto n = static_cast<std::size_t>(type.rate_count());
    std::vector<JointForce> forces(n);
    const auto set = [&](double JointForce::*part, const std::optional<std::vector<double>>& from) {
      for (std::size_t k = 0; from && k < n; ++k) {
        forces[k].*part = (*from)[from->size() == 1 ? 0 : k];
      }
    };
    if (type.rates.empty() || (type.has_attitude() && type.rates.size() > 1)) {
      for (const char* const key : {"spring", "damping", "force"}) {
        if (section.has(key)) section.refuse(key, "has no single coordinate in this kind of joint");
      }
      return;
    }
    if (type.has_attitude()) {
      for (const char* const key : {"spring", "force"}) {
        if (section.has(key)) {
          section.refuse(key, "needs a single coordinate, which a " + type.name + " joint has not");
        }
      }
    } else {
      if (auto spring = section.section("spring")) {
        set(&JointForce::stiffness,
            spring->number_or_list("stiffness", forces_by(type.coordinates)));
        if (!spring->has("stiffness")) spring->refuse_missing("stiffness");
        const bool slides = std::any_of(type.coordinates.begin(), type.coordinates.end(),
                                        [](const auto& quantity) { return quantity.unit == "m"; });
        set(&JointForce::rest, slides ? spring->number_or_list("rest", dimensions(type.coordinates))
                                      : spring->angle_or_list("rest", n, dimension::angle));
        spring->finish();
      }
      read_given_forces(section, type, forces);
    }
    std::vector<Dimension> per_rate = forces_by(type.rates);
    if (type.has_attitude()) per_rate.resize(1);
    const auto damping = section.number_or_list("damping", per_rate);
    if (damping && *std::min_element(damping->begin(), damping->end()) < 0) {
      section.refuse("damping", "must not be below 0");
    }
    set(&JointForce::damping, damping);
    body.forces = std::move(forces);
  }

  static JointStart read_start(Section& body_section, const BodyDescription& body) {
    const JointType& type = joint_type(body.joint.kind);
    JointStart start{std::vector<double>(static_cast<std::size_t>(type.coordinate_count())),
                     std::vector<double>(static_cast<std::size_t>(type.rate_count()))};
    if (type.has_attitude()) start.coordinates[3] = 1;
    auto initial = body_section.section("initial");
    if (!initial) return start;
    auto at = start.coordinates.begin();
    for (const JointQuantity& quantity : type.coordinates) {
      read_quantity(*initial, quantity, body.joint, at);
      at += quantity.count();
    }
    at = start.rates.begin();
    for (const JointQuantity& quantity : type.rates) {
      read_quantity(*initial, quantity, body.joint, at);
      at += quantity.count();
    }
    initial->finish();
    return start;
  }

  static void read_quantity(Section& initial, const JointQuantity& quantity, const Joint& joint,
                            std::vector<double>::iterator at) {
    const auto count = static_cast<std::size_t>(quantity.count());
    if (quantity.meaning == JointQuantity::Meaning::attitude) {
      if (const auto q = quaternion(initial, quantity.key)) {
        // The file's attitude is relative to the parent, the coordinate relative to the joint.
        const Eigen::Quaterniond own = joint.orientation.conjugate() * *q;
        std::copy_n(own.coeffs().data(), 4, at);
      }
      return;
    }
    const bool turns = quantity.unit == "rad" || quantity.unit == "rad/s";
    const Dimension of = detail::dimension_of(quantity.unit);
    auto numbers = turns        ? initial.angles(quantity.key, count, of)
                   : count == 1 ? initial.single(quantity.key, of)
                                : initial.numbers(quantity.key, count, of);
    if (!numbers) return;
    if (quantity.meaning == JointQuantity::Meaning::place) {
      for (std::size_t k = 0; k < 3; ++k) (*numbers)[k] -= joint.position[Eigen::Index(k)];
    }
    std::copy(numbers->begin(), numbers->end(), at);
  }

  void read_rotor(Section& section, BodyDescription& body, JointStart& start) {
    auto rotor = section.section("rotor");
    if (!rotor) return;
    const std::string mode = rotor->required_choice("mode", {"free", "regulated", "torque"});
    const auto speed = detail::read_angle_signal(*rotor, "speed", dimension::angular_rate);
    const auto torque = detail::read_signal<double>(*rotor, "torque", dimension::torque);
    rotor->finish();
    if (body.joint.kind != JointKind::revolute) {
      section.refuse("rotor", "is for a revolute joint");
      return;
    }
    for (const char* const key : {"drive", "hold", "spring"}) {
      const bool off = std::string_view(key) == "hold" && !section.flag(key);
      if (section.has(key) && !off) section.refuse(key, "does not go with a rotor");
    }
    const double rate = start.rates.front();
    if (speed && rate != 0 && (*speed)(scene_.t_begin) != rate) {
      rotor->refuse("speed", "differs from initial.rate");
    }
    if (!speed && rate == 0 && mode != "torque") rotor->refuse_missing("speed");
    if (speed) start.rates.front() = (*speed)(scene_.t_begin);
    if (speed && !speed->is_constant()) check_speed(*rotor, *speed, mode, body);
    const bool acts = torque && !(torque->is_constant() && (*torque)(0.0) == 0);
    if (acts && mode != "torque") rotor->refuse("torque", "is for mode = 'torque'");
    if (!torque && mode == "torque") rotor->refuse_missing("torque");
    if (!check_balance(section, body)) return;
    set_rotor(body, mode);
    if (torque) set_torque(*rotor, *torque, body);
    if (speed) set_speed(*speed, body);
  }

  /// Checks a speed that changes with time.
  static void check_speed(Section& rotor, const Signal<double>& speed, const std::string& mode,
                          const BodyDescription& body) {
    const char* const key = rotor.has("speed") ? "speed" : "speed_deg";
    if (mode != "regulated") {
      rotor.refuse(key, "changes with time, which is for mode = 'regulated'");
    } else if (!body.loads.empty()) {
      rotor.refuse(key, "changes with time, which a rotor with a load cannot");
    }
    if (speed.jumps()) {
      rotor.refuse(key, "jumps at t = " + detail::shown_time(speed.discontinuities().front()) +
                            " s, which takes an infinite torque; give 'points'");
    }
  }

  static void set_rotor(BodyDescription& body, const std::string& mode) {
    if (!body.loads.empty()) {
      // A load may depend on the rotor's angle, so the rotor is treated as an ordinary body.
      if (mode == "regulated") body.rule = JointRule::driven;
      return;
    }
    const bool turned = std::any_of(body.forces.begin(), body.forces.end(), [](const auto& f) {
      return f.damping != 0 || f.constant != 0 || f.in_time;
    });
    body.rotor = Rotor{};
    if (mode == "regulated") body.rotor->mode = RotorMode::regulated;
    if (mode == "torque" || (mode == "free" && turned)) body.rotor->mode = RotorMode::torque;
  }

  void set_torque(Section& rotor, const Signal<double>& torque, BodyDescription& body) {
    note(torque);
    if (body.rotor && torque.is_constant()) {
      body.rotor->torque = torque(0.0);
      return;
    }
    if (body.forces.empty()) body.forces.resize(1);
    JointForce& force = body.forces.front();
    if (torque.is_constant()) {
      force.constant += torque(0.0);
    } else if (force.in_time) {
      rotor.refuse("torque", "changes with time beside 'force'; one of them may");
    } else {
      force.in_time = torque;
    }
  }

  void set_speed(const Signal<double>& speed, BodyDescription& body) {
    note(speed);
    if (speed.is_constant() || !body.rotor) return;
    body.rotor->acceleration = TimeFunction(speed, 1);
  }

  /// True if a rotor's mass is distributed symmetrically about its axis.
  static bool check_balance(Section& section, const BodyDescription& body) {
    constexpr double slack = 32 * std::numeric_limits<double>::epsilon();  // as in BodyTree
    const Inertia<double>& T = body.inertia.value;
    const Vector3<double> axis = body.joint.orientation.conjugate() * body.joint.axis.normalized();
    const Matrix3<double> tensor = T.tensor.matrix();
    const double trace = tensor.trace();
    const double about = axis.dot(tensor * axis);
    const double across = (trace - about) / 2;
    const Matrix3<double> even =
        across * Matrix3<double>::Identity() + (about - across) * axis * axis.transpose();
    const auto refuse = [&section](const char* why) {
      section.refuse("rotor", std::string(why) + "; leave 'rotor' out and it is an ordinary body");
      return false;
    };
    if (T.first_moment.cross(axis).norm() > slack * std::sqrt(T.mass * trace)) {
      return refuse("is unbalanced: its centre of mass lies off the axis");
    }
    if ((tensor - even).norm() > slack * trace) return refuse("is not symmetric about its axis");
    return about > slack * trace || refuse("has no moment of inertia about its axis");
  }

  void read_loads(Section& section, BodyDescription& body) {
    const toml::node* const node = section.find("load");
    if (node == nullptr) return;
    std::vector<Section> loads;
    if (node->is_array()) {
      loads = section.sections("load");
    } else if (auto load = section.section("load")) {
      loads.push_back(*load);
    }
    for (Section& load : loads) {
      const std::string kind = load.choice("kind", {"force", "drag", "magnet"});
      if (load.has("kind") && load.peek("kind") != kind) {  // the other keys cannot be checked
        load.ignore_rest();
        continue;
      }
      if (kind == "force") read_force(load, body);
      if (kind == "drag") body.loads.emplace_back(read_drag(load));
      if (kind == "magnet") body.loads.emplace_back(read_magnet(load));
      load.finish();
    }
  }

  void read_force(Section& load, BodyDescription& body) {
    if (!load.has("force") && !load.has("torque")) load.refuse_missing("force");
    const Vector3<double> zero = Vector3<double>::Zero();
    const auto force =
        detail::read_signal<Vector3<double>>(load, "force", dimension::force).value_or(zero);
    const auto torque =
        detail::read_signal<Vector3<double>>(load, "torque", dimension::torque).value_or(zero);
    const Vector3<double> point = load.vector("point", dimension::length).value_or(zero);
    const std::string axes = load.choice("axes", {"body", "guide", "inertial"});
    if (axes == "body") add_load<Body>(body, force, torque, point);
    if (axes == "guide") add_load<Guide>(body, force, torque, point);
    if (axes == "inertial") add_load<Inertial>(body, force, torque, point);
  }

  /// A matrix of a drag, which must not drive the body; 0 if it is missing.
  static Matrix3<double> read_resistance(Section& load, const char* key, const Dimension& of) {
    const Matrix3<double> zero = Matrix3<double>::Zero();
    const Matrix3<double> result = load.matrix(key, of).value_or(zero);
    const Matrix3<double> symmetric = (result + result.transpose()) / 2;
    constexpr double slack = 32 * std::numeric_limits<double>::epsilon();
    const double least =
        Eigen::SelfAdjointEigenSolver<Matrix3<double>>(symmetric).eigenvalues().minCoeff();
    if (!(least >= -slack * symmetric.norm())) {
      load.refuse(key, "would drive the body: its symmetric part must have no negative eigenvalue");
    }
    return result;
  }

  static Drag<> read_drag(Section& load) {
    if (!load.has("linear") && !load.has("quadratic") && !load.has("angular")) {
      load.refuse_missing("linear");
    }
    Drag<> drag;
    const Dimension per_speed = dimension::force / dimension::velocity;
    drag.linear = read_resistance(load, "linear", per_speed);
    drag.quadratic = read_resistance(load, "quadratic", per_speed / dimension::velocity);
    drag.angular = read_resistance(load, "angular", dimension::torque / dimension::angular_rate);
    drag.point = load.vector("point", dimension::length).value_or(drag.point);
    return drag;
  }

  Magnet read_magnet(Section& load) {
    if (!load.has("field")) load.refuse_missing("field");
    Magnet magnet{load.required_vector("moment", dimension::magnetic_moment)};
    const auto field = detail::read_signal<Vector3<double>>(load, "field", dimension::flux_density);
    if (field) {
      note(*field);
      magnet.field = *field;
    }
    return magnet;
  }

  template <class Axes>
  void add_load(BodyDescription& body, const Signal<Vector3<double>>& force,
                const Signal<Vector3<double>>& torque, const Vector3<double>& point) {
    note(force);
    note(torque);
    if (force.is_constant() && torque.is_constant()) {
      body.loads.emplace_back(ConstantLoad<Axes>{force(0.0), torque(0.0), point});
    } else {
      body.loads.emplace_back(SignalLoad<Axes>{force, torque, point});
    }
  }

  void read_report() {
    auto report = root_.section("report");
    if (!report) return;
    scene_.reactions = report->flag("reactions");
    scene_.element_forces = report->flag("elements");
    scene_.constraint_forces = report->flag("constraints");
    scene_.terms = report->flag("terms");
    report->finish();
  }

  Section root_;
  const std::filesystem::path& path_;
  const SolveRequest& request_;
  Mistakes& mistakes_;
  detail::SignalLogs& logs_;
  SceneFile scene_;
  bool assembles_ = false;
  bool outputs_are_given_ = false;
};

}  // namespace

bool SceneFile::rests() const {
  return std::all_of(guide.begin(), guide.end(), [](const scene_guide::Link& link) {
    return std::holds_alternative<scene_guide::Resting>(link);
  });
}

bool SceneFile::guide_follows_log() const { return log_files().size() > signal_logs.size(); }

std::vector<std::filesystem::path> SceneFile::log_files() const {
  std::vector<std::filesystem::path> files;
  for (const scene_guide::Link& link : guide) {
    std::visit(
        [&files](const auto& kind) {
          if constexpr (requires { kind.log; }) files.push_back(kind.file);
        },
        link);
  }
  for (const SceneSignalLog& log : signal_logs) files.push_back(log.file);
  return files;
}

std::optional<Method> method_named(std::string_view word) {
  if (word == "auto") return Method::automatic;
  for (const Method method :
       {Method::automatic, Method::closed_form, Method::verner98, Method::gauss16, Method::radau13,
        Method::splitting, Method::taylor}) {
    if (word == name(method)) return method;
  }
  return std::nullopt;
}

namespace {

SceneFile parse(std::string_view text, const std::filesystem::path& path,
                const SolveRequest& request, std::vector<SceneSignalLog> given) {
  Mistakes mistakes(path.string());
  toml::table root = detail::parse_toml(text, {}, mistakes);
  detail::apply_settings(request.settings, root, mistakes);
  detail::SignalLogs logs(path.parent_path(), std::move(given));
  return SceneReader(root, path, request, mistakes, logs).read();
}

}  // namespace

SceneFile parse_scene(std::string_view text, const std::filesystem::path& path,
                      const SolveRequest& request) {
  SceneFile scene = parse(text, path, request, {});
  if (scene.signal_logs.empty()) return scene;
  scene.with_signal_logs = [text = std::string(text), path,
                            request](std::vector<SceneSignalLog> given) {
    return parse(text, path, request, std::move(given));
  };
  return scene;
}

SceneFile read_scene(const std::filesystem::path& path, const SolveRequest& request) {
  return parse_scene(read_text(path, largest_scene_file), path, request);
}

}  // namespace kreisel
