#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include <dynamics/file/constraint_keys.hpp>
#include <dynamics/file/joints.hpp>
#include <dynamics/file/pair_keys.hpp>
#include <dynamics/file/quoted.hpp>
#include <dynamics/tree/body_system.hpp>

namespace kreisel::detail {

namespace {

using Eigen::Quaterniond;

/// The poses of all bodies in the guide at the start.
class StartPoses {
 public:
  explicit StartPoses(const SceneFile& scene)
      : system_(RestingFrame<>{}, scene.bodies), workspace_(system_.workspace()) {
    const JointState start = start_of(scene);
    y_ = decltype(system_)::to_vector({start.coordinates, start.rates});
  }

  /// The pose of a body; index 0 is the guide.
  Pose<double> operator()(int index) {
    if (index == 0) return {};
    return system_.situation(0, y_, index - 1, workspace_).X.value;
  }

 private:
  BodySystem<RestingFrame<>> system_;
  BodyWorkspace workspace_;
  Eigen::VectorXd y_;
};

class ConstraintReader {
 public:
  /// poses : null if the bodies have mistakes
  ConstraintReader(const PairKeys& pairs, StartPoses* poses) : pairs_(pairs), poses_(poses) {}

  /// Reads the keys of a constraint; nothing if the kind is wrong.
  std::optional<Constraint> read(Section& section, const std::string& name) {
    const std::string kind =
        section.required_choice("kind", {"point", "revolute", "universal", "fixed", "prismatic",
                                         "distance", "gear", "rolling", "blade"});
    if (section.peek("kind") != kind) return std::nullopt;
    if (kind == "gear") return gear(section, name);
    if (kind == "rolling") return rolling(section, name);
    if (kind == "blade") return blade(section, name);
    return joint(section, name, kind);
  }

 private:
  /// The constraints with the keys `between` and `at`.
  Constraint joint(Section& section, const std::string& name, const std::string& kind) {
    const auto [first, second] = pairs_.ends(section);
    Constraint result{name, first.body, second.body};
    const constraint::Point centre{first.at, second.at};
    if (kind == "point") result.kind = centre;
    if (kind == "distance") {
      const double length = section.required_number("length", dimension::length, Range::positive);
      result.kind = constraint::Distance{centre, length};
    }
    if (kind == "revolute") {
      const auto [one, other] = axes(section, first, second);
      result.kind = constraint::Revolute{centre, one, other};
    }
    if (kind == "universal") result.kind = universal(section, centre);
    const Quaterniond kept = attitude(first, second);
    if (kind == "fixed") result.kind = constraint::Fixed{centre, kept};
    if (kind == "prismatic") {
      const Vector3<double> axis = direction(section, "axis");
      result.kind = constraint::Prismatic{centre, axis, kept};
    }
    return result;
  }

  /// The attitude of the second body to the first at the start.
  Quaterniond attitude(const ElementEnd& first, const ElementEnd& second) {
    if (poses_ == nullptr) return Quaterniond::Identity();
    const Matrix3<double> one = (*poses_)(pairs_.index(first.body)).rotation;
    const Matrix3<double> other = (*poses_)(pairs_.index(second.body)).rotation;
    return Quaterniond(Matrix3<double>(one.transpose() * other));
  }

  /// The axis on the first body's axes, and the same at the start on the second's; or one on each.
  std::pair<Vector3<double>, Vector3<double>> axes(Section& section, const ElementEnd& first,
                                                   const ElementEnd& second) {
    if (const auto both = two_directions(section)) return *both;
    const Vector3<double> one = direction(section, "axis");
    return {one, attitude(first, second).conjugate() * one};
  }

  constraint::Universal universal(Section& section, const constraint::Point& centre) {
    if (const auto both = two_directions(section)) return {centre, both->first, both->second};
    section.refuse("axis", "must be two axes: one on the first body's axes, one on the second's");
    return {centre};
  }

  /// The value of `axis` if it is a list of two directions.
  static std::optional<std::pair<Vector3<double>, Vector3<double>>> two_directions(
      Section& section) {
    const toml::node* const node = section.find("axis");
    const toml::array* const list = node == nullptr ? nullptr : node->as_array();
    if (list == nullptr || list->size() != 2) return std::nullopt;
    std::array<Vector3<double>, 2> both;
    for (const std::size_t i : {std::size_t(0), std::size_t(1)}) {
      both[i] = section.vector_at("axis", i, *list->get(i), dimension::number)
                    .value_or(Vector3<double>::UnitZ());
      refuse_zero(section, "axis", both[i]);
    }
    return std::pair{both[0], both[1]};
  }

  static Vector3<double> direction(Section& section, const char* key) {
    const Vector3<double> result = section.required_vector(key, dimension::number);
    if (section.has(key)) refuse_zero(section, key, result);
    return result.norm() > 0 ? result : Vector3<double>(Vector3<double>::UnitZ());
  }

  static void refuse_zero(Section& section, const char* key, const Vector3<double>& v) {
    if (!(v.norm() > 0)) section.refuse(key, "is 0 and has no direction");
  }

  Constraint gear(Section& section, const std::string& name) const {
    Constraint result{name, {}, {}, constraint::Gear{}};
    const auto joints = pairs_.joints(section);
    const bool fits = joints && poses_ != nullptr &&
                      pairs_.has_one_coordinate(section, (*joints)[0]) &&
                      pairs_.has_one_coordinate(section, (*joints)[1]);
    if (!fits) {
      section.ignore_rest();  // units of numbers are not known
      return result;
    }
    result.first = pairs_.name((*joints)[0]);
    result.second = pairs_.name((*joints)[1]);
    const Dimension moved = pairs_.coordinate((*joints)[0]);
    constraint::Gear gear;
    gear.ratio = section.required_number("ratio", moved / pairs_.coordinate((*joints)[1]));
    const bool turns = moved == dimension::angle;
    gear.offset =
        (turns ? section.angle("offset", moved) : section.number("offset", moved)).value_or(0);
    result.kind = gear;
    return result;
  }

  Constraint rolling(Section& section, const std::string& name) const {
    constraint::Rolling kind;
    const int body = pairs_.body(section, "body", true);
    const int on = pairs_.body(section, "on", false);
    kind.centre = pairs_.point(section, body);
    kind.radius = section.required_number("radius", dimension::length, Range::positive);
    if (section.has("axis")) kind.axis = direction(section, "axis");
    kind.tube = section.number("tube", dimension::length, Range::not_negative).value_or(0);
    if (kind.tube > 0 && !kind.axis) {
      section.refuse("tube", "is for a wheel: give its 'axis', too");
    }
    if (auto plane = section.required_section("plane")) {
      kind.point = plane->vector("point", dimension::length).value_or(kind.point);
      kind.normal = direction(*plane, "normal");
      plane->finish();
    }
    return {name, pairs_.name(on), pairs_.name(body), kind};
  }

  Constraint blade(Section& section, const std::string& name) const {
    constraint::Blade kind;
    const int body = pairs_.body(section, "body", true);
    kind.at = pairs_.point(section, body);
    kind.direction = direction(section, "direction");
    return {name, "guide", pairs_.name(body), kind};
  }

  const PairKeys& pairs_;
  StartPoses* poses_;
};

/// Makes the start fulfil the constraints.
class Assembly {
 public:
  Assembly(const SceneFile& scene)
      : system_(RestingFrame<>{}, scene.bodies, {}, {}, scene.constraints) {
    const JointState start = start_of(scene);
    state_ = {start.coordinates, start.rates};
  }

  /// Refuses a start that is off, in the constraints' own sections.
  bool refuse_gaps(const std::vector<std::pair<std::string, Section>>& sections) {
    bool fits = true;
    for (const ConstraintGap& gap : system_.constraint_gaps(state_)) {
      const bool is_off = gap.relative > slack;
      const bool moves = gap.rate > slack * (1 + state_.rates.norm());
      if (!is_off && !moves) continue;
      fits = false;
      for (auto [name, section] : sections) {
        if (name != gap.name) continue;
        char text[200];
        std::snprintf(text, sizeof text,
                      "the start is off by %.3g %s; correct 'initial', or let 'assemble = true' in "
                      "[solve] find the nearest one",
                      is_off ? gap.position : gap.rate,
                      is_off ? "(m or rad)" : "(m/s or rad/s) in its rate");
        section.refuse_all(text);
      }
    }
    return fits;
  }

  /// Writes the nearest start that fulfils the constraints into the scene.
  void assemble(SceneFile& scene) {
    const auto found = system_.assembled(state_);
    for (std::size_t i = 0; i < scene.start.size(); ++i) {
      const JointPlace place = system_.tree().place(static_cast<int>(i));
      const auto put = [](std::vector<double>& to, const Eigen::VectorXd& from, int begin) {
        for (std::size_t k = 0; k < to.size(); ++k) to[k] = from[begin + static_cast<int>(k)];
      };
      put(scene.start[i].coordinates, found.coordinates, place.q);
      put(scene.start[i].rates, found.rates, place.v);
    }
    scene.redundant_constraints = system_.redundant_constraints(found);
  }

 private:
  static constexpr double slack = 1e-9;

  BodySystem<RestingFrame<>> system_;
  decltype(system_)::State state_;
};

}  // namespace

void read_constraints(Section& root, bool assemble, bool sound, SceneFile& scene) {
  if (!root.has("constraint") || scene.bodies.empty()) return;
  const PairKeys pairs(scene);
  std::optional<StartPoses> poses;
  if (sound) poses.emplace(scene);
  ConstraintReader reader(pairs, poses ? &*poses : nullptr);
  std::vector<std::string> names;
  for (const Element& element : scene.elements) names.push_back(kreisel::name(element));
  std::vector<std::pair<std::string, Section>> sections;
  const std::size_t before = root.mistakes();
  for (Section& section : root.sections("constraint")) {
    const std::string name = section.required_text("name");
    pairs.check_name(section, name, names);
    names.push_back(name);
    if (!name.empty()) section.rename("constraint '" + name + "'");
    auto constraint = reader.read(section, name);
    if (!constraint) section.ignore_rest();
    section.finish();
    if (!constraint) continue;
    scene.constraints.push_back(std::move(*constraint));
    sections.emplace_back(name, section);
  }
  if (!sound || root.mistakes() != before) return;
  try {
    Assembly assembly(scene);
    if (assemble || assembly.refuse_gaps(sections)) assembly.assemble(scene);
  } catch (const Error& error) {
    const std::string text = error.what();
    for (auto& [name, section] : sections) {
      const std::string head = "constraint '" + name + "': ";
      if (!text.starts_with(head)) continue;
      section.refuse_all(text.substr(head.size()));
      return;
    }
    root.refuse("constraint", text);
  }
}

}  // namespace kreisel::detail
