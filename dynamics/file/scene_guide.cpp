#include <algorithm>
#include <cmath>
#include <utility>

#include <dynamics/file/log_options.hpp>
#include <dynamics/file/motion_log.hpp>
#include <dynamics/file/rates_log.hpp>
#include <dynamics/file/scene_guide.hpp>
#include <dynamics/file/scene_signal.hpp>
#include <dynamics/guide/log_noise.hpp>
#include <motor/error.hpp>

namespace kreisel::detail {

namespace {

Vector3<double> three(const std::vector<double>& x) { return {x[0], x[1], x[2]}; }

class GuideReader {
 public:
  GuideReader(std::filesystem::path folder, double t_begin, double t_end, const Mistakes& mistakes)
      : folder_(std::move(folder)), t_begin_(t_begin), t_end_(t_end), mistakes_(mistakes) {}

  GuideSection read(Section& root) {
    if (auto guide = root.section("guide")) read_links(*guide, 0);
    if (guide_.links.empty()) guide_.links.emplace_back(scene_guide::Resting{});
    return std::move(guide_);
  }

 private:
  void read_links(Section& guide, int depth) {
    const std::vector<std::string> kinds{"inertial", "rotating", "harmonic", "earth",  "table",
                                         "rates",    "motion",   "orbit",    "course", "chain"};
    const std::string kind =
        depth == 0 ? guide.choice("kind", kinds) : guide.required_choice("kind", kinds);
    if (!guide.has("kind") || guide.find("kind")->as_string() == nullptr ||
        guide.find("kind")->as_string()->get() != kind) {
      // The other keys of an unknown kind cannot be checked.
      if (guide.has("kind") || depth > 0) guide.ignore_rest();
    }
    if (kind == "inertial") guide_.links.emplace_back(scene_guide::Resting{});
    if (kind == "rotating") {
      if (!guide.has("angular_velocity") && !guide.has("angular_velocity_deg")) {
        guide.refuse_missing("angular_velocity");
      }
      const auto turning = guide.angles("angular_velocity", 3, dimension::angular_rate);
      guide_.links.emplace_back(scene_guide::Rotating{
          turning ? three(*turning) : Vector3<double>(Vector3<double>::UnitX()),
          guide.vector("origin_acceleration", dimension::acceleration)
              .value_or(Vector3<double>::Zero()),
          read_frame_start(guide)});
    }
    if (kind == "harmonic") {
      const bool turns = guide.has("angular_velocity") || guide.has("angular_velocity_deg");
      if (!turns && !guide.has("origin_acceleration")) guide.refuse_missing("angular_velocity");
      scene_guide::Harmonic link;
      link.angular_velocity =
          read_angular_series(guide, "angular_velocity", dimension::angular_rate);
      link.origin_acceleration = read_series(guide, "origin_acceleration", dimension::acceleration);
      link.start = read_frame_start(guide);
      check_length(guide, link);
      if (t_begin_ < 0) {
        guide.refuse("kind", "'harmonic' is given by its start at t = 0; solve.t_begin is earlier");
      }
      guide_.links.emplace_back(std::move(link));
    }
    if (kind == "earth") read_earth(guide);
    if (kind == "table") read_table(guide);
    if (kind == "rates") read_rates(guide);
    if (kind == "motion") read_motion(guide);
    if (kind == "orbit") read_orbit(guide);
    if (kind == "course") read_course(guide);
    if (kind == "chain") {
      constexpr int deepest = 8;
      if (!guide.has("links")) guide.refuse_missing("links");
      std::vector<Section> links = guide.sections("links");
      if (guide.has("links") && links.empty() && guide.find("links")->is_array()) {
        guide.refuse("links", "is empty");
      }
      if (depth == deepest) {
        guide.refuse("links", "is a chain in a chain, nine deep");
        links.clear();
      }
      for (Section& link : links) read_links(link, depth + 1);
    }
    guide.finish();
  }

  static HarmonicSeries<double> read_series(Section& guide, std::string_view key,
                                            const KeyDimension& of) {
    HarmonicSeries<double> series;
    auto section = guide.section(key);
    if (!section) return series;
    series.constant =
        three(section->numbers("constant", 3, of).value_or(std::vector<double>(3, 0)));
    for (Section& term : section->sections("terms")) {
      if (!term.has("amplitude")) term.refuse_missing("amplitude");
      const auto amplitude = term.numbers("amplitude", 3, of);
      const auto frequency = term.angle("frequency", dimension::angular_rate);
      if (!term.has("frequency") && !term.has("frequency_deg")) term.refuse_missing("frequency");
      series.terms.push_back({amplitude ? three(*amplitude) : Vector3<double>::UnitX(),
                              frequency.value_or(1),
                              term.angle("phase", dimension::angle).value_or(0)});
      term.finish();
    }
    section->finish();
    return series;
  }

  /// Reads a series in radian, or in degrees if the key ends in _deg.
  static HarmonicSeries<double> read_angular_series(Section& guide, const std::string& key,
                                                    const Dimension& of) {
    const std::string in_degrees = key + "_deg";
    if (!guide.has(in_degrees)) return read_series(guide, key, of);
    if (guide.has(key)) guide.refuse(in_degrees, "is given in radian too, as '" + key + "'");
    HarmonicSeries<double> series = read_series(guide, in_degrees, std::nullopt);
    series.constant *= radian_per_degree;
    for (auto& term : series.terms) term.amplitude *= radian_per_degree;
    return series;
  }

  /// Checks the memory of HarmonicFrame: a piece of 1 kB for each 1/(2 Omega).
  void check_length(Section& guide, const scene_guide::Harmonic& link) const {
    double turning = link.angular_velocity.constant.norm();
    double frequency = 0;
    for (const auto* const series : {&link.angular_velocity, &link.origin_acceleration}) {
      for (const auto& term : series->terms) {
        if (series == &link.angular_velocity) turning += term.amplitude.norm();
        frequency = std::max(frequency, std::abs(term.frequency));
      }
    }
    constexpr double most_pieces = 1e6;
    if (2 * (turning / 2 + frequency) * t_end_ > most_pieces) {
      guide.refuse("kind",
                   "'harmonic' turns too fast for so long a run: over half a million radian");
    }
  }

  static scene_guide::Start read_frame_start(Section& guide) {
    const Vector3<double> zero = Vector3<double>::Zero();
    return {quaternion(guide, "attitude").value_or(Eigen::Quaterniond::Identity()),
            guide.vector("origin_position", dimension::length).value_or(zero),
            guide.vector("origin_velocity", dimension::velocity).value_or(zero)};
  }

  void read_earth(Section& guide) {
    scene_guide::Earth link;
    link.site.latitude = guide.required_number("latitude_deg", std::nullopt);
    link.site.height = guide.required_number("height", dimension::length);
    link.site.azimuth = guide.required_number("azimuth_deg", std::nullopt);
    link.site.rotation_rate =
        guide.angle("rate", dimension::angular_rate).value_or(link.site.rotation_rate);
    if (!guide_.links.empty()) {
      guide.refuse("kind",
                   "'earth' must be the first link: the earth moves against no frame but "
                   "the inertial one");
    }
    link.gravity = read_gravity(guide);
    try {
      check(link.site);
    } catch (const InvalidInput& error) {
      const std::string text = error.what();
      const char* const key = text.starts_with("latitude")  ? "latitude_deg"
                              : text.starts_with("azimuth") ? "azimuth_deg"
                              : text.starts_with("height")  ? "height"
                                                            : "rate";
      guide.refuse(key, text.substr(text.find("= ") + 2));
    }
    guide_.links.emplace_back(link);
  }

  /// Reads gravity on the earth, as a number or by name. Returns the number.
  std::optional<double> read_gravity(Section& guide) {
    const toml::node* const gravity = guide.find("gravity");
    if (gravity == nullptr) return std::nullopt;
    if (guide.has_number("gravity")) {
      const auto number = guide.number("gravity", dimension::acceleration, Range::positive);
      if (number) guide_.gravity = scene_gravity::AtSite{*number};
      return number;
    }
    if (guide.choice("gravity", {"normal", "none"}) == "normal") {
      guide_.gravity = scene_gravity::Ellipsoid{};
    }
    return std::nullopt;
  }

  void read_course(Section& guide) {
    if (!guide_.links.empty()) {
      guide.refuse("kind",
                   "'course' must be the first link: the earth moves against no frame but the "
                   "inertial one");
    }
    if (t_begin_ < 0) {
      guide.refuse("kind", "'course' is given by its start at t = 0; solve.t_begin is earlier");
    }
    const std::size_t before = mistakes_.count();
    CoursePlan plan;
    plan.latitude = read_degrees(guide, "latitude", true);
    plan.longitude = read_degrees(guide, "longitude", false);
    plan.heading = read_degrees(guide, "heading", true);
    plan.height = guide.number("height", dimension::length).value_or(0);
    plan.speed = guide.required_number("speed", dimension::velocity);
    plan.turn_rate =
        read_angle_signal(guide, "turn_rate", dimension::angular_rate).value_or(plan.turn_rate);
    plan.acceleration = read_signal<double>(guide, "acceleration", dimension::acceleration)
                            .value_or(plan.acceleration);
    plan.climb = read_signal<double>(guide, "climb", dimension::velocity).value_or(plan.climb);
    read_bank(guide, plan);
    plan.gravity = read_gravity(guide);
    if (mistakes_.count() == before && t_end_ > 0) check_course(guide, plan);
    guide_.discontinuities = plan.discontinuities(t_end_);
    guide_.links.emplace_back(scene_guide::Course{std::move(plan)});
  }

  /// An angle in degrees: the value of key_deg, or of the key in radian.
  static double read_degrees(Section& guide, const std::string& key, bool is_required) {
    const std::string in_degrees = key + "_deg";
    if (guide.has(in_degrees)) {
      if (guide.has(key)) guide.refuse(in_degrees, "is given in radian too, as '" + key + "'");
      return guide.number(in_degrees, std::nullopt).value_or(0);
    }
    if (is_required && !guide.has(key)) guide.refuse_missing(in_degrees);
    return guide.number(key, dimension::angle).value_or(0) / radian_per_degree;
  }

  static void read_bank(Section& guide, CoursePlan& plan) {
    const std::string word = guide.peek("bank");
    const bool is_angle = word.find_first_of("+-.0123456789") == 0 || word.empty();
    if (is_angle) {
      plan.bank = read_angle_signal(guide, "bank", dimension::angle).value_or(plan.bank);
      return;
    }
    plan.is_coordinated = guide.choice("bank", {"none", "coordinated"}) == "coordinated";
    if (guide.has("bank_deg")) guide.refuse("bank_deg", "is given beside 'bank'");
  }

  void check_course(Section& guide, const CoursePlan& plan) const {
    const auto given = [&guide](const std::string& key) {
      return guide.has(key + "_deg") ? key + "_deg" : key;
    };
    if (const auto jump = impact(plan, t_end_)) {
      const bool is_bank = jump->key == std::string_view("bank");
      guide.refuse(
          given(jump->key),
          "jumps, or its rate does, at t = " + shown_time(jump->t) +
              " s, which takes an infinite " +
              (plan.is_coordinated ? "torque beside bank = 'coordinated'" : "force") +
              (is_bank || plan.is_coordinated ? "; give 'constant', 'rate' and 'terms', or 'file'"
                                              : "; give 'points'") +
              (plan.is_coordinated ? ", or an angle of bank" : ""));
      return;
    }
    try {
      check(plan, t_end_);
    } catch (const InvalidInput& error) {
      const std::string text = error.what();
      const std::size_t end = text.find(" = ");
      guide.refuse(given(text.substr(0, end)), text.substr(end + 3));
    }
  }

  void read_motion(Section& guide) {
    PoseSignals pose;
    const auto take = [](Section& from, const std::string& key, const auto& signal, auto& to) {
      if (!signal) return;
      const auto jumps = signal->discontinuities();
      if (!jumps.empty()) {
        from.refuse(from.has(key) ? key : key + "_deg",
                    "jumps, or its rate does, at t = " + shown_time(jumps.front()) +
                        " s, which takes an infinite force; give 'constant', 'rate' and 'terms'");
        return;
      }
      to = *signal;
    };
    if (!guide.has("position") && !guide.has("angles")) guide.refuse_missing("position");
    take(guide, "position", read_signal<Vector3<double>>(guide, "position", dimension::length),
         pose.position);
    if (auto angles = guide.section("angles")) {
      take(*angles, "yaw", read_angle_signal(*angles, "yaw", dimension::angle), pose.yaw);
      take(*angles, "pitch", read_angle_signal(*angles, "pitch", dimension::angle), pose.pitch);
      take(*angles, "roll", read_angle_signal(*angles, "roll", dimension::angle), pose.roll);
      angles->finish();
    }
    guide_.links.emplace_back(scene_guide::Motion{std::move(pose)});
  }

  void read_orbit(Section& guide) {
    if (!guide_.links.empty()) {
      guide.refuse("kind",
                   "'orbit' must be the first link: it is about a planet's centre, which rests "
                   "inertially");
    }
    OrbitElements<> orbit;
    orbit.semi_major_axis =
        guide.required_number("semi_major_axis", dimension::length, Range::positive);
    orbit.eccentricity = guide.number("eccentricity", dimension::number).value_or(0);
    if (!(orbit.eccentricity >= 0 && orbit.eccentricity < 1)) {
      guide.refuse("eccentricity", "must be from 0 to below 1: an orbit is an ellipse");
    }
    orbit.inclination = guide.angle("inclination", dimension::angle).value_or(0);
    orbit.node = guide.angle("node", dimension::angle).value_or(0);
    orbit.perigee = guide.angle("perigee", dimension::angle).value_or(0);
    orbit.anomaly = guide.angle("anomaly", dimension::angle).value_or(0);
    orbit.parameter =
        guide.number("mu", dimension::gravitation, Range::positive).value_or(orbit.parameter);
    if (guide.flag("j2")) orbit.j2 = OblateGravitation<>{}.j2;
    guide_.links.emplace_back(scene_guide::Orbit{orbit});
  }

  /// A log's file and its options; nothing if they are wrong.
  struct LogPlace {
    std::string name;
    std::filesystem::path file;
    LogOptions options;
  };

  std::optional<LogPlace> read_log_place(Section& guide, const std::vector<LogRequest>& columns) {
    const std::size_t before = mistakes_.count();
    const std::string name = guide.required_text("file");
    const LogOptions options = read_log_options(guide, columns, {t_begin_, t_end_});
    if (name.empty() && guide.has("file") && guide.find("file")->is_string()) {
      guide.refuse("file", "is empty");
    }
    if (mistakes_.count() > before) return std::nullopt;
    return LogPlace{name, folder_ / name, options};
  }

  void read_table(Section& guide) {
    (void)guide.has("sigma");  // read with the log; a known key also if that fails
    const auto place = read_log_place(guide, motion_log_columns());
    if (!place) return;
    try {
      MotionLog<double> log = read_motion_log(place->file, place->options).motion;
      check_covers_run(guide, place->name, place->options, log.times, {t_begin_, t_end_});
      const LogSpline spline = read_smoothing(guide, log, {dimension::number, dimension::length});
      guide_.links.emplace_back(scene_guide::Table{place->file, std::move(log), spline});
    } catch (const InvalidInput& error) {
      guide.refuse("file", error.what());
    }
  }

  void read_rates(Section& guide) {
    if (!guide_.links.empty()) {
      guide.refuse("kind",
                   "'rates' must be the first link: gyros measure against the inertial "
                   "frame");
    }
    RatesStart start;
    start.attitude = quaternion(guide, "attitude").value_or(start.attitude);
    start.velocity = guide.vector("origin_velocity", dimension::velocity).value_or(start.velocity);
    const bool felt =
        guide.choice("acceleration", {"specific force", "kinematic"}) == "specific force";
    const auto gravity = guide.vector("gravity", dimension::acceleration);
    start.gravity = gravity.value_or(start.gravity);
    if (gravity) guide_.gravity = UniformGravity<Inertial>{*gravity};
    if (!felt && guide.has("gravity")) {
      guide.refuse("gravity", "is for acceleration = 'specific force'");
    }
    auto place = read_log_place(guide, rates_log_columns());
    if (!place) return;
    place->options.run.reset();  // the attitude belongs to the first time of the log
    try {
      RatesLog log = read_rates_log(place->file, place->options);
      check_covers_run(guide, place->name, place->options, log.times, {t_begin_, t_end_});
      if (gravity && log.accelerations.empty()) {
        guide.refuse("gravity",
                     "is what logged accelerations lack, and this log has none; leave it out");
      }
      if (felt && !log.accelerations.empty() && !guide.has("gravity")) {
        guide_.rates_without_gravity = guide;
      }
      const RatesFrame<> checked(log, start);
      const LogSpline spline =
          read_smoothing(guide, log, {dimension::angular_rate, dimension::acceleration});
      guide_.links.emplace_back(scene_guide::Rates{place->file, std::move(log), start, spline});
    } catch (const InvalidInput& error) {
      guide.refuse("file", error.what());
    }
  }

  /// The smoothing spline of a log of two quantities, attitude and position or angular rate and
  /// acceleration, of the dimensions `of`. The noise is `sigma`: one number, or one for each
  /// quantity. Without `sigma` it is estimated from the log.
  template <class Log>
  static LogSpline read_smoothing(Section& guide, const Log& log,
                                  const std::vector<Dimension>& of) {
    LogNoise::Components sigma;
    if (guide.has("sigma")) {
      const auto given = guide.number_or_list("sigma", of);
      if (!given) return {};
      if (*std::min_element(given->begin(), given->end()) < 0) {
        guide.refuse("sigma", "must not be below 0");
        return {};
      }
      sigma.head<4>().setConstant(given->front());
      sigma.tail<3>().setConstant(given->back());
    } else {
      sigma = smoothing_sigma(noise_of(log));
    }
    return smoothing(log, sigma);
  }

  std::filesystem::path folder_;  ///< of the scene's file
  double t_begin_;
  double t_end_;
  const Mistakes& mistakes_;
  GuideSection guide_ = {};
};

}  // namespace

GuideSection read_guide(Section& root, const std::filesystem::path& scene, double t_begin,
                        double t_end, const Mistakes& mistakes) {
  return GuideReader(scene.parent_path(), t_begin, t_end, mistakes).read(root);
}

void give_gravity_to_rates(GuideSection& guide, const scene_gravity::Field& gravity) {
  if (!guide.rates_without_gravity) return;
  const auto* const uniform = std::get_if<UniformGravity<Inertial>>(&gravity);
  if (uniform == nullptr) {
    guide.rates_without_gravity->refuse(
        "acceleration",
        "'specific force' needs gravity: 'gravity' = [x, y, z] in m/s^2 on inertial axes, or "
        "[gravity] kind = 'inertial'");
    return;
  }
  if (auto* const rates = std::get_if<scene_guide::Rates>(&guide.links.front())) {
    rates->start.gravity = uniform->g;
  }
}

}  // namespace kreisel::detail
