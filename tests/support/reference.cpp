#include <boost/multiprecision/cpp_bin_float.hpp>

#include <string>
#include <vector>

#include <support/cast.hpp>
#include <support/json.hpp>
#include <support/reference.hpp>

namespace kreisel::test {

namespace {

/// Numbers are strings of 25 and more decimal digits.
Digits50 digits(const Json& text) { return Digits50(text.get<std::string>()); }

Vector3<Digits50> vector(const Json& list) {
  return {digits(list.at(0)), digits(list.at(1)), digits(list.at(2))};
}

Matrix3<Digits50> matrix(const Json& rows) {
  Matrix3<Digits50> m;
  m << vector(rows.at(0)), vector(rows.at(1)), vector(rows.at(2));
  return m.transpose();
}

Motor<Digits50> motor(const Json& m) { return {vector(m.at("res")), vector(m.at("mom"))}; }

Motor<Digits50> couple(const Json& moment) { return {Vector3<Digits50>::Zero(), vector(moment)}; }

Wave wave(const Json& w) {
  return {digits(w.at("c0")), digits(w.at("c1")), digits(w.at("c2")),
          digits(w.at("A")),  digits(w.at("w")),  digits(w.at("p"))};
}

Motion motion(const Json& m) {
  return {wave(m.at("yaw")), wave(m.at("pitch")), wave(m.at("roll")),
          wave(m.at("x")),   wave(m.at("y")),     wave(m.at("z"))};
}

std::vector<PointMass> masses(const Json& list) {
  std::vector<PointMass> masses;
  for (const Json& point : list) {
    const Vector3<Digits50> place = vector(point.at(1));
    masses.push_back({static_cast<double>(digits(point.at(0))), cast<double>(place)});
  }
  return masses;
}

ReferenceCase reference_case(const Json& c) {
  const Json& motors = c.at("derivative_motors");
  const Json& plain = c.at("plain_vector_derivatives_at_moving_Oprime");
  return {
      c.at("name").get<std::string>(),
      motion(c.at("guide")),
      motion(c.at("rel")),
      digits(c.at("t")),
      masses(c.at("point_masses")),
      digits(c.at("mass")),
      vector(c.at("r_s")),
      matrix(c.at("Theta_O")),
      motor(c.at("F")),
      motor(c.at("Vrel")),
      {motor(motors.at("F_star")), motor(motors.at("F_ring")), motor(motors.at("F_dot"))},
      {motor(motors.at("Vrel_star")), motor(motors.at("Vrel_ring")), motor(motors.at("Vrel_dot"))},
      {couple(plain.at("v_star")), couple(plain.at("v_ring")), couple(plain.at("v_dot"))},
      {couple(plain.at("vrel_star")), couple(plain.at("vrel_ring")), couple(plain.at("vrel_dot"))},
      motor(c.at("momentum_abs")),
      {vector(c.at("force_motor").at("P")), vector(c.at("force_motor").at("M"))}};
}

}  // namespace

std::vector<ReferenceCase> reference_cases() {
  const Json file = reference_file("inverse-dynamics.json");
  std::vector<ReferenceCase> cases;
  for (const Json& c : file.at("cases")) cases.push_back(reference_case(c));
  if (cases.size() != 2) throw std::runtime_error("inverse-dynamics.json should have two cases");
  return cases;
}

HandExampleK hand_example_K() {
  const Json file = reference_file("inverse-dynamics.json");
  const Json& K = file.at("hand_example_K");
  const Json& misread = K.at("force_if_Tafel1_columns_misread");
  return {K.at("true_force_x").get<double>(), misread.at("So").get<double>(),
          misread.at("S'").get<double>(), misread.at("plain derivatives in (6)").get<double>()};
}

}  // namespace kreisel::test
