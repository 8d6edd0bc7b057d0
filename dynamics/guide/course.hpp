#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <dynamics/guide/earth.hpp>
#include <dynamics/guide/ellipsoid.hpp>
#include <dynamics/guide/motion.hpp>
#include <dynamics/guide/power_series.hpp>
#include <dynamics/guide/signal_frame.hpp>
#include <dynamics/guide/steady.hpp>
#include <dynamics/signal/signal.hpp>
#include <motor/double_double_functions.hpp>
#include <motor/error.hpp>

namespace kreisel {

/// The course of a vehicle over the WGS84 ellipsoid: its start, and its speeds as functions of time.
///
/// `speed` is that over ground at the vehicle's height, along the horizontal heading. `turn_rate`
/// is about the local vertical, positive to the right, relative to the geodesic. A vehicle with 0
/// follows a geodesic, and its heading changes by the convergence of the meridians.
///
/// Units  : degree for the three angles at the start, as in EarthSite; metre, second, radian
struct CoursePlan {
  double latitude = 0;   ///< of the ellipsoid's normal, at t = 0
  double longitude = 0;  ///< at t = 0; 0 is the meridian of inertial x at t = 0
  double height = 0;     ///< above the ellipsoid, at t = 0
  double heading = 0;    ///< at t = 0, from north through east; at a pole relative to `longitude`
  double speed = 0;      ///< at t = 0
  Signal<double> turn_rate = {};
  Signal<double> acceleration = {};  ///< rate of the speed
  Signal<double> climb = {};         ///< rate of the height
  Signal<double> bank = {};          ///< about the heading, positive: right side down
  bool is_coordinated = false;  ///< instead of `bank`: apparent gravity without a lateral component

  /// The effective gravity for a coordinated bank, along the normal; empty: WGS84 normal gravity.
  std::optional<double> gravity = {};

  /// True if the vehicle rests on the earth.
  [[nodiscard]] bool rests() const {
    const auto is_zero = [](const Signal<double>& s) { return s.is_constant() && s(0.0) == 0; };
    return speed == 0 && is_zero(turn_rate) && is_zero(acceleration) && is_zero(climb) &&
           bank.is_constant();
  }

  /// The times in (0, end) at which an acceleration, its rate or a rate of a speed jumps, in order.
  [[nodiscard]] std::vector<double> discontinuities(double end) const {
    std::vector<double> times;
    for (const auto* const signal : {&turn_rate, &acceleration, &climb}) {
      for (const double t : signal->discontinuities()) {
        if (t > 0 && t < end) times.push_back(t);
      }
    }
    std::sort(times.begin(), times.end());
    times.erase(std::unique(times.begin(), times.end()), times.end());
    return times;
  }
};

namespace detail {

/// The first time in (0, end) at which the value of a signal jumps, or with `smooth` its rate.
[[nodiscard]] inline std::optional<double> jump(const Signal<double>& signal, bool smooth,
                                                double end) {
  if (!smooth && !signal.jumps()) return std::nullopt;
  for (const double t : signal.discontinuities()) {
    if (t > 0 && t < end) return t;
  }
  return std::nullopt;
}

/// A jump in a course that would take an infinite force or torque.
struct CourseJump {
  const char* key;  ///< of CoursePlan
  double t;
};

/// The first jump of velocity or angular velocity; a coordinated bank must follow without one.
[[nodiscard]] inline std::optional<CourseJump> impact(const CoursePlan& plan, double end) {
  const bool smooth = plan.is_coordinated;
  if (const auto t = jump(plan.turn_rate, smooth, end)) return CourseJump{"turn_rate", *t};
  if (const auto t = jump(plan.climb, smooth, end)) return CourseJump{"climb", *t};
  if (const auto t = jump(plan.bank, true, end)) return CourseJump{"bank", *t};
  if (!smooth) return std::nullopt;
  if (const auto t = jump(plan.acceleration, false, end)) return CourseJump{"acceleration", *t};
  return std::nullopt;
}

/// The local level on a course, x down along the normal, z along the heading.
struct LevelAxes {};
/// The axes of the rotating earth, from its centre.
struct EarthAxes {};

/// A vehicle at one time.
struct CoursePoint {
  FrameMotion<LevelAxes, EarthAxes> level;
  double bank = 0, bank_rate = 0, bank_acceleration = 0;
};

/// A point on a course in any number type: the path's state and the signals.
template <class N>
struct CourseState {
  Vector3<N> normal, ahead;  ///< up along the normal, forwards; unit vectors on the earth's axes
  N height, speed;
  N turn_rate, acceleration, climb;

  [[nodiscard]] Vector3<N> left() const { return normal.cross(ahead); }

  /// The direction to the pole on level axes.
  [[nodiscard]] Vector3<N> pole() const {
    const N left_z = normal.x() * ahead.y() - normal.y() * ahead.x();
    return {N(0) - normal.z(), left_z, ahead.z()};
  }

  [[nodiscard]] Vector3<N> turning() const {
    return level_turning(pole(), height, speed, turn_rate);
  }

  /// The velocity against the earth, on level axes.
  [[nodiscard]] Vector3<N> velocity() const { return {N(0) - climb, N(0), speed}; }

  /// The acceleration against the earth plus Coriolis acceleration, on level axes.
  [[nodiscard]] Vector3<N> acceleration_on_earth(const N& climb_rate) const {
    const Vector3<N> spin = turning() + N(2 * Wgs84::rotation_rate) * pole();
    return Vector3<N>(N(0) - climb_rate, N(0), acceleration) + spin.cross(velocity());
  }

  /// A vector on the earth's axes, on level axes.
  [[nodiscard]] Vector3<N> on_level(const Vector3<N>& v) const {
    return {N(0) - normal.dot(v), left().dot(v), ahead.dot(v)};
  }

  /// Gravitation and centrifugal acceleration of WGS84, on level axes.
  [[nodiscard]] Vector3<N> normal_gravity() const {
    const Vector3<N> p = point_above(normal, height);
    const N spin2(Wgs84::rotation_rate * Wgs84::rotation_rate);
    return on_level(normal_gravitation(p) + Vector3<N>(spin2 * p.x(), spin2 * p.y(), N(0)));
  }
};

}  // namespace detail

/// Refuses a course until `end` that does not begin on or near the earth or is not continuous.
///
/// Throws : InvalidInput, naming key, value and range; a jump of velocity or angular velocity; a
///          signal that follows a log
inline void check(const CoursePlan& plan, double end) {
  detail::require_within("latitude", plan.latitude, -90.0, 90.0, "degrees");
  detail::require_within("longitude", plan.longitude, -360.0, 360.0, "degrees");
  detail::require_within("height", plan.height, -11000.0, 1e7, "m");
  detail::require_within("heading", plan.heading, -360.0, 360.0, "degrees");
  detail::require_within("speed", plan.speed, -1e5, 1e5, "m/s");
  if (plan.gravity) detail::require_positive("gravity", *plan.gravity, "m/s^2");
  if (!(end > 0 && end <= std::numeric_limits<double>::max())) {
    throw InvalidInput("end of the course must be a finite time after 0");
  }
  const std::pair<const char*, const Signal<double>*> signals[] = {
      {"turn_rate", &plan.turn_rate},
      {"acceleration", &plan.acceleration},
      {"climb", &plan.climb},
      {"bank", &plan.bank}};
  for (const auto& [key, signal] : signals) {
    if (signal->is_analytic()) continue;
    throw InvalidInput(std::string(key) +
                       " = a spline; a course needs steps, a broken line or oscillations");
  }
  if (const auto jump = detail::impact(plan, end)) {
    std::ostringstream text;
    text.precision(15);
    text << jump->key << " jumps, or its rate does, at t = " << jump->t
         << " s, which takes an infinite force";
    throw InvalidInput(text.str());
  }
}

/// The motion along a course, relative to the rotating earth.
///
/// The state is the normal n, the direction ahead f, height and speed, without singular angles. It
/// is integrated by its power series between the jumps of the signals:
///
///   n' = u_y f - u_z l,   f' = -u_y n - u_x l,   l = n x f,   u from level_turning()
///
/// Angular velocity and acceleration follow from the state by formula, never by differences.
///
/// Error  : against GeographicLib's geodesics <= 1e-8 m and 2e-15 rad after 3e7 m
///                                                           (tests/dynamics/guide/course.cpp)
/// Cost   : 1.8 kB and 0.4 ms for each piece: about 1.9 rad of the path, of turning, or of a
///          signal's phase
/// Throws : InvalidInput as check() does, and for a height outside [-11000, 1e7] m on the way, more
///          than 20,000 pieces, a time outside [0, end]
class Course {
 public:
  Course(CoursePlan plan, double end) : plan_(std::move(plan)), end_(end) {
    check(plan_, end_);
    integrate();
  }

  [[nodiscard]] const CoursePlan& plan() const { return plan_; }
  [[nodiscard]] double end() const { return end_; }

  [[nodiscard]] detail::CoursePoint at(double t) const {
    require(t);
    const auto next = std::upper_bound(begins_.begin() + 1, begins_.end(), t);
    const auto piece = static_cast<std::size_t>(next - begins_.begin()) - 1;
    const Piece& c = pieces_[piece];
    const double s = t - begins_[piece];
    State x = c[degree];
    for (std::size_t k = degree; k-- > 0;) x = x * s + c[k];
    detail::CoursePoint point{level(x, t)};
    if (plan_.is_coordinated) {
      set_bank(c, s, point);
    } else if (!plan_.bank.is_constant() || plan_.bank(0.0) != 0) {
      point.bank = plan_.bank(t);
      point.bank_rate = plan_.bank.derivative(t, 1);
      point.bank_acceleration = plan_.bank.derivative(t, 2);
    }
    return point;
  }

 private:
  static constexpr std::size_t degree = 24;
  static constexpr int most_pieces = 20000;

  /// Normal, direction ahead, height, speed, coordinated bank.
  template <class N>
  using Numbers = Eigen::Matrix<N, 9, 1>;
  using State = Numbers<double>;
  using Piece = std::array<State, degree + 1>;  ///< of powers of the time since its begin
  using Wide = DoubleDouble;

  static void refuse(const std::string& what) { throw InvalidInput("course: " + what); }

  void require(double t) const {
    if (t >= 0 && t <= end_) return;
    std::ostringstream text;
    text.precision(10);
    text << "t = " << t << " s lies outside [0, " << end_ << "] s, for which the course is known";
    refuse(text.str());
  }

  static void require_height(double height, double t) {
    std::ostringstream key;
    key.precision(10);
    key << "course: height at t = " << t << " s";
    detail::require_within(key.str(), height, -11000.0, 1e7, "m");
  }

  [[nodiscard]] Numbers<Wide> start() const {
    const auto [s, c] = sine_cosine_degrees<Wide>(plan_.latitude);
    const auto [sl, cl] = sine_cosine_degrees<Wide>(plan_.longitude);
    const auto [sh, ch] = sine_cosine_degrees<Wide>(plan_.heading);
    const Vector3<Wide> north(-s * cl, -s * sl, c);
    const Vector3<Wide> east(-sl, cl, 0);
    return (Numbers<Wide>() << c * cl, c * sl, s, Vector3<Wide>(ch * north + sh * east),
            plan_.height, plan_.speed, 0)
        .finished();
  }

  void integrate() {
    Numbers<Wide> state = start();
    std::vector<double> stops = plan_.discontinuities(end_);
    stops.push_back(end_);
    double t = 0;
    for (const double stop : stops) {
      while (t < stop) {
        const Piece piece = expanded(t, state.cast<double>());
        const double ahead = reach(piece);
        const double next = std::min(stop, t + ahead);
        if (begins_.size() == most_pieces || end_ - t > 10 * most_pieces * ahead) {
          if (reach(piece, 4) > 10 * ahead) refuse_bank(t);
          refuse("it turns, or its signals oscillate, by more than 4e4 rad");
        }
        if (!(next > t)) refuse("a turn rate or a speed is too great for any step of time");
        begins_.push_back(t);
        pieces_.push_back(piece);
        state = moved(state, piece, Wide(next) - Wide(t));
        t = next;
        require_height(static_cast<double>(state[6]), t);
      }
    }
  }

  /// The state at the end of a piece; n and f are made orthonormal.
  [[nodiscard]] static Numbers<Wide> moved(const Numbers<Wide>& state, const Piece& c, Wide step) {
    Numbers<Wide> off = Numbers<Wide>::Zero();
    for (std::size_t k = degree; k > 0; --k) off = (off + c[k].cast<Wide>()) * step;
    Numbers<Wide> result = state + off;
    const Vector3<Wide> n = result.head<3>().normalized();
    const Vector3<Wide> f = result.segment<3>(3);
    result.head<3>() = n;
    result.segment<3>(3) = (f - n.dot(f) * n).normalized();
    return result;
  }

  static void refuse_bank(double t) {
    std::ostringstream text;
    text.precision(4);
    text << "no bank is coordinated near t = " << t
         << " s, where apparent gravity vanishes: let it climb with less acceleration, or give an "
            "angle of bank";
    refuse(text.str());
  }

  /// The time after which the last two terms of each series are 1e-17 of its size. The parts are those
  /// of Numbers; the fifth is the bank.
  [[nodiscard]] static double reach(const Piece& c, Eigen::Index parts = 5) {
    const auto size = [](const State& x, Eigen::Index part) {
      return part < 2 ? x.segment<3>(3 * part).norm() : std::abs(x[4 + part]);
    };
    double result = std::numeric_limits<double>::infinity();
    for (Eigen::Index part = 0; part < parts; ++part) {
      const std::size_t last = part < 4 ? degree : degree - 1;
      for (std::size_t k = last - 1; k <= last; ++k) {
        const double term = size(c[k], part);
        const double whole = std::max(1.0, size(c[0], part));
        if (term > 0) {
          result = std::min(result, std::pow(1e-17 * whole / term, 1.0 / static_cast<double>(k)));
        }
      }
    }
    return result;
  }

  /// The signals as series about t in seconds.
  struct SignalSeries {
    PowerSeries turn_rate, acceleration, climb;
  };

  [[nodiscard]] SignalSeries signals(double t, int order) const {
    const PowerSeries time = PowerSeries::time(t, 1, order);
    return {detail::value_at(plan_.turn_rate, time), detail::value_at(plan_.acceleration, time),
            detail::value_at(plan_.climb, time)};
  }

  /// The first `order` + 1 coefficients of a piece as series.
  [[nodiscard]] detail::CourseState<PowerSeries> series(const Piece& c, double t, int order) const {
    const auto part = [&c, order](int i) {
      return PowerSeries::of(order, [&c, i](std::size_t k) { return c[k][i]; });
    };
    const auto [turn_rate, acceleration, climb] = signals(t, order);
    return {{part(0), part(1), part(2)},
            {part(3), part(4), part(5)},
            part(6),
            part(7),
            turn_rate,
            acceleration,
            climb};
  }

  /// The series of the state about t: each coefficient follows from those before it.
  [[nodiscard]] Piece expanded(double t, const State& state) const {
    Piece c;
    c.fill(State::Zero());
    c[0] = state;
    for (int k = 0; k < static_cast<int>(degree); ++k) {
      const detail::CourseState<PowerSeries> x = series(c, t, k);
      const Vector3<PowerSeries> u = x.turning();
      const Vector3<PowerSeries> l = x.left();
      const Vector3<PowerSeries> normal_rate = u.y() * x.ahead - u.z() * l;
      const Vector3<PowerSeries> ahead_rate = -u.y() * x.normal - u.x() * l;
      const auto coefficient = [k](const PowerSeries& rate) { return rate[k]; };
      State& next = c[static_cast<std::size_t>(k) + 1];
      next.head<3>() = normal_rate.unaryExpr(coefficient);
      next.segment<3>(3) = ahead_rate.unaryExpr(coefficient);
      next[6] = x.climb[k];
      next[7] = x.acceleration[k];
      next /= k + 1;
    }
    if (plan_.is_coordinated) add_coordinated_bank(t, c);
    return c;
  }

  /// The angle of the apparent gravity in the plane across the heading:
  ///
  ///   tan(bank) = g_y/g_x,   bank' = (g_x g_y' - g_y g_x')/(g_x^2 + g_y^2)
  void add_coordinated_bank(double t, Piece& c) const {
    constexpr int order = static_cast<int>(degree);
    const detail::CourseState<PowerSeries> x = series(c, t, order);
    const Vector3<PowerSeries> a = x.acceleration_on_earth(x.climb.derivative(1));
    const Vector3<PowerSeries> g =
        plan_.gravity
            ? Vector3<PowerSeries>(PowerSeries(*plan_.gravity), PowerSeries(0), PowerSeries(0))
            : x.normal_gravity();
    const PowerSeries down = g.x() - a.x();
    const PowerSeries aside = g.y() - a.y();
    const PowerSeries rate =
        (down * aside.derivative(1) - aside * down.derivative(1)) / (down * down + aside * aside);
    c[0][8] = std::atan2(aside[0], down[0]);
    for (int k = 1; k < order; ++k) c[static_cast<std::size_t>(k)][8] = rate[k - 1] / k;
  }

  static void set_bank(const Piece& c, double s, detail::CoursePoint& point) {
    double half = 0;
    for (std::size_t k = degree; k-- > 0;) {
      half = half * s + point.bank_rate;
      point.bank_rate = point.bank_rate * s + point.bank;
      point.bank = point.bank * s + c[k][8];
    }
    point.bank_acceleration = 2 * half;
  }

  [[nodiscard]] FrameMotion<detail::LevelAxes, detail::EarthAxes> level(const State& x,
                                                                        double t) const {
    using Dual = Eigen::AutoDiffScalar<Eigen::Matrix<double, 1, 1>>;
    const detail::CourseState<double> now{x.head<3>(),   x.segment<3>(3),    x[6],
                                          x[7],          plan_.turn_rate(t), plan_.acceleration(t),
                                          plan_.climb(t)};
    const auto along = [](double value, double rate) {
      return Dual(value, Eigen::Matrix<double, 1, 1>(rate));
    };
    const Vector3<double> u = now.turning();
    const Vector3<double> pole = now.pole();
    const Vector3<double> pole_rate = pole.cross(u);  // it rests on the earth
    const Vector3<Dual> turning =
        level_turning<Dual>({along(pole.x(), pole_rate.x()), along(pole.y(), pole_rate.y()),
                             along(pole.z(), pole_rate.z())},
                            along(now.height, now.climb), along(now.speed, now.acceleration),
                            along(now.turn_rate, plan_.turn_rate.derivative(t, 1)));

    FrameMotion<detail::LevelAxes, detail::EarthAxes> motion;
    motion.X.value.rotation << -now.normal, now.left(), now.ahead;
    motion.X.value.translation = point_above(now.normal, now.height);
    motion.V.value = {u, now.velocity()};
    motion.dV.value = {
        {turning.x().derivatives()[0], turning.y().derivatives()[0], turning.z().derivatives()[0]},
        {-plan_.climb.derivative(t, 1), 0, now.acceleration}};
    return motion;
  }

  CoursePlan plan_;
  double end_;
  std::vector<double> begins_;
  std::vector<Piece> pieces_;
};

namespace detail {

/// The earth's rotation.
template <class I>
[[nodiscard]] FrameMotion<EarthAxes, I> rotating_earth(double t) {
  const Vector3<double> axis(0, 0, Wgs84::rotation_rate);
  return SteadyFrame<EarthAxes, I>{{}, {{axis, Vector3<double>::Zero()}}}(t);
}

/// The banked frame of a vehicle from its level one.
template <class G, class I>
[[nodiscard]] FrameMotion<G, I> banked(const FrameMotion<LevelAxes, I>& level,
                                       const CoursePoint& point) {
  FrameMotion<G, LevelAxes> bank;
  const Vector3<double> ahead = Vector3<double>::UnitZ();
  bank.X.value.rotation = Eigen::AngleAxisd(point.bank, ahead).toRotationMatrix();
  bank.V.value.resultant = point.bank_rate * ahead;
  bank.dV.value.resultant = point.bank_acceleration * ahead;
  return level * bank;
}

}  // namespace detail

/// The frame of a vehicle on a course over the rotating earth: x down along the ellipsoid's normal,
/// z horizontal along the heading, y = z x x to the left. A positive bank turns it about z, the
/// right side down.
///
/// I is the non-rotating frame at the earth's centre, z to the north pole, x through longitude 0 at
/// t = 0. Gravitation is a load (EarthGravitation), as for earth_frame().
///
/// Error  : as Course; at speed 0 the motion is that of earth_frame() to 4u
///                                                           (tests/dynamics/guide/course.cpp)
/// Throws : as Course
template <class G = Guide, class I = Inertial>
class CourseFrame {
 public:
  /// `end` is the last time at which the frame is evaluated.
  CourseFrame(const CoursePlan& plan, double end) : course_(plan, end) {}

  [[nodiscard]] const Course& course() const { return course_; }
  [[nodiscard]] double end() const { return course_.end(); }

  [[nodiscard]] FrameMotion<G, I> operator()(double t) const {
    const detail::CoursePoint point = course_.at(t);
    return detail::banked<G>(detail::rotating_earth<I>(t) * point.level, point);
  }

 private:
  Course course_;
};

/// The frame of a vehicle for bodies in an effective gravity that is given as a number. Attitude and
/// angular velocity are those of CourseFrame. The origin rests at I's; its acceleration is that
/// against the earth and the Coriolis acceleration. The effective gravity contains the centrifugal
/// acceleration.
///
/// Throws : as Course
template <class G = Guide, class I = Inertial>
class CourseAxes {
 public:
  CourseAxes(const CoursePlan& plan, double end) : course_(plan, end) {}

  [[nodiscard]] double end() const { return course_.end(); }

  [[nodiscard]] FrameMotion<G, I> operator()(double t) const {
    const detail::CoursePoint point = course_.at(t);
    const FrameMotion<detail::EarthAxes, I> earth = detail::rotating_earth<I>(t);
    FrameMotion<detail::LevelAxes, I> level = earth * point.level;
    const Vector3<double> spin = level.V.value.resultant +
                                 point.level.X.value.rotation.transpose() * earth.V.value.resultant;
    level.dV.value.moment = point.level.dV.value.moment + spin.cross(point.level.V.value.moment);
    level.V.value.moment.setZero();
    level.X.value.translation.setZero();
    return detail::banked<G>(level, point);
  }

 private:
  Course course_;
};

}  // namespace kreisel
