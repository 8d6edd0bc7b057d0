#include <dynamics/file/rates_log.hpp>

namespace kreisel {

namespace {

std::vector<Vector3<double>> vectors(const Log& log, const char* x, const char* y, const char* z) {
  const std::vector<double>& first = log.column(x).values;
  const std::vector<double>& second = log.column(y).values;
  const std::vector<double>& third = log.column(z).values;
  std::vector<Vector3<double>> result;
  for (std::size_t i = 0; i < log.size(); ++i) {
    result.emplace_back(first[i], second[i], third[i]);
  }
  return result;
}

}  // namespace

std::vector<LogRequest> rates_log_columns() {
  const LogColumnGroup rates{LogQuantity::angular_rate,
                             {"wx", "wy", "wz"},
                             {{"w_x", "w_y", "w_z"},
                              {"gx", "gy", "gz"},
                              {"gyro_x", "gyro_y", "gyro_z"},
                              {"w_RS_S_x", "w_RS_S_y", "w_RS_S_z"}}};
  const LogColumnGroup accelerations{
      LogQuantity::acceleration,
      {"ax", "ay", "az"},
      {{"a_x", "a_y", "a_z"}, {"acc_x", "acc_y", "acc_z"}, {"a_RS_S_x", "a_RS_S_y", "a_RS_S_z"}}};
  return {{"angular velocity", {rates}, true}, {"acceleration", {accelerations}, false}};
}

RatesLog read_rates_log(const std::filesystem::path& path, const LogOptions& options) {
  const Log log = read_log(path, rates_log_columns(), options);
  RatesLog result;
  result.times = log.column("t").values;
  result.late = log.late;
  result.angular_velocities = vectors(log, "wx", "wy", "wz");
  if (log.has("ax")) result.accelerations = vectors(log, "ax", "ay", "az");
  if (log.size() < 4) {
    throw InvalidInput(path.string() + ": " + std::to_string(log.size()) +
                       " rows where a motion needs 4 or more");
  }
  return result;
}

}  // namespace kreisel
