#include <algorithm>
#include <cmath>
#include <sstream>

#include <dynamics/file/motion_log.hpp>
#include <motor/attitude.hpp>

namespace kreisel {

namespace {

void take_attitudes(const Log& log, LoggedMotion& result) {
  result.motion.attitudes.reserve(log.size());
  const auto resolution = [&log, &result](const char* name, double factor) {
    result.attitude_resolution =
        std::max(result.attitude_resolution, factor * log.column(name).resolution);
  };
  if (log.has("qw")) {
    const auto& w = log.column("qw").values;
    const auto& x = log.column("qx").values;
    const auto& y = log.column("qy").values;
    const auto& z = log.column("qz").values;
    for (std::size_t i = 0; i < log.size(); ++i) {
      result.motion.attitudes.emplace_back(w[i], x[i], y[i], z[i]);
    }
    for (const char* const name : {"qw", "qx", "qy", "qz"}) resolution(name, 1);
    return;
  }
  const auto& yaw = log.column("yaw").values;
  const auto& pitch = log.column("pitch").values;
  const auto& roll = log.column("roll").values;
  for (std::size_t i = 0; i < log.size(); ++i) {
    const YawPitchRoll<double> angles{yaw[i], pitch[i], roll[i]};
    result.motion.attitudes.emplace_back(angles.rotation());
  }
  // A rotation by a small angle changes the quaternion by half of the angle.
  for (const char* const name : {"yaw", "pitch", "roll"}) resolution(name, 0.5);
}

void take_positions(const Log& log, LoggedMotion& result) {
  if (!log.has("x")) return;
  const LogColumn& x = log.column("x");
  const LogColumn& y = log.column("y");
  const LogColumn& z = log.column("z");
  result.motion.positions.reserve(log.size());
  for (std::size_t i = 0; i < log.size(); ++i) {
    result.motion.positions.emplace_back(x.values[i], y.values[i], z.values[i]);
  }
  result.position_resolution = std::max({x.resolution, y.resolution, z.resolution});
}

void check_turns(const Log& log, const LoggedMotion& motion) {
  const auto& attitudes = motion.motion.attitudes;
  for (std::size_t i = 1; i < attitudes.size(); ++i) {
    const double cosine =
        attitudes[i].dot(attitudes[i - 1]) / (attitudes[i].norm() * attitudes[i - 1].norm());
    if (std::abs(cosine) >= 0.70710678118654752) continue;
    std::ostringstream text;
    text.precision(10);
    text << log.where(i) << ": the attitude turns by more than 90 degrees between line "
         << log.lines[i - 1] << " (t = " << motion.motion.times[i - 1] << " s) and line "
         << log.lines[i] << " (t = " << motion.motion.times[i]
         << " s): the log is too coarse; check  columns  and  angles";
    throw InvalidInput(text.str());
  }
}

}  // namespace

std::vector<LogRequest> motion_log_columns() {
  const LogColumnGroup quaternion{
      LogQuantity::quaternion,
      {"qw", "qx", "qy", "qz"},
      {{"q_w", "q_x", "q_y", "q_z"},
       {"quat_w", "quat_x", "quat_y", "quat_z"},
       {"orientation_w", "orientation_x", "orientation_y", "orientation_z"}}};
  const LogColumnGroup angles{LogQuantity::angle, {"yaw", "pitch", "roll"}, {}};
  const LogColumnGroup position{LogQuantity::length,
                                {"x", "y", "z"},
                                {{"tx", "ty", "tz"},
                                 {"px", "py", "pz"},
                                 {"p_x", "p_y", "p_z"},
                                 {"pos_x", "pos_y", "pos_z"},
                                 {"position_x", "position_y", "position_z"},
                                 {"surge", "sway", "heave"}}};
  return {{"attitude", {quaternion, angles}, true}, {"position", {position}, false}};
}

LoggedMotion read_motion_log(const std::filesystem::path& path, const LogOptions& options) {
  Log log = read_log(path, motion_log_columns(), options);
  LoggedMotion result;
  take_attitudes(log, result);
  take_positions(log, result);
  result.motion.times = log.column("t").values;
  result.motion.late = log.late;
  result.time_resolution = log.column("t").resolution;
  if (log.size() < 4) {
    throw InvalidInput(path.string() + ": " + std::to_string(log.size()) +
                       " rows where a motion needs 4 or more");
  }
  check_turns(log, result);
  result.lines = std::move(log.lines);
  return result;
}

}  // namespace kreisel
