#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

#include <dynamics/decompositions.hpp>
#include <dynamics/step/explicit.hpp>
#include <dynamics/study/precession.hpp>
#include <dynamics/study/precession_point.hpp>
#include <motor/error.hpp>

namespace kreisel {

namespace detail {

template <class... Words>
[[noreturn]] void refuse_precession(double t, const Words&... words) {
  std::ostringstream text;
  text.precision(10);
  text << "precession equations at t = " << t << " s: ";
  (text << ... << words);
  throw ComputationFailed(text.str());
}

/// 12 h times the derivatives, at five points h apart, of the polynomial through them.
inline constexpr std::array<std::array<double, 5>, 5> five_point_slopes{{{-25, 48, -36, 16, -3},
                                                                         {-3, -10, 18, -6, 1},
                                                                         {1, -8, 0, 8, -1},
                                                                         {-1, 6, -18, 10, 3},
                                                                         {3, -16, 36, -48, 25}}};

/// The nutations that a motion starts with because its velocity differs from that of the precession
/// equations. They obey A_f w' + way' W P w = 0 with A_f = P' A way: transverse, the kept
/// directions giving way.
struct Nutations {
  Eigen::VectorXcd roots;
  Eigen::MatrixXcd shapes;  ///< of the displacement, scaled to the start
  Eigen::VectorXd offset;   ///< of their centre from the start
  Eigen::VectorXd kick;     ///< of v

  Nutations(const Directions& d, const PrecessionPoint& p, const Eigen::VectorXd& mismatch)
      : offset(Eigen::VectorXd::Zero(p.u.size())), kick(Eigen::VectorXd::Zero(d.N.cols())) {
    if (d.P.cols() == 0) return;
    const Eigen::VectorXd w = d.P_t * mismatch;
    if (d.N.cols() > 0) kick = -(d.N_t * Eigen::VectorXd(p.way * w));
    const Eigen::MatrixXd A = across(d, p);
    const Eigen::VectorXd middle = p.across.solve(Eigen::VectorXd(A * w));
    offset = p.way * middle;
    const Eigenpairs modes = eigenpairs(state_matrix(d, p, A));
    roots = modes.values;
    const Eigen::VectorXcd share = solution(modes.vectors, w.cast<std::complex<double>>());
    shapes.resize(p.way.rows(), roots.size());
    shapes.real() = product(p.way, modes.vectors.real());
    shapes.imag() = product(p.way, modes.vectors.imag());
    for (Eigen::Index k = 0; k < roots.size(); ++k) shapes.col(k) *= share[k] / roots[k];
  }

  /// Amplitudes, component by component, at a time after the start.
  [[nodiscard]] Eigen::VectorXd amplitude(double time) const {
    if (roots.size() == 0) return Eigen::VectorXd::Zero(offset.size());
    const Eigen::VectorXd grown = (roots.real() * time).array().exp();
    return Eigen::MatrixXd(shapes.cwiseAbs()) * grown;
  }

  /// The least |root| of the nutations at one point.
  [[nodiscard]] static double slowest(const Directions& d, const PrecessionPoint& p) {
    if (d.P.cols() == 0) return std::numeric_limits<double>::infinity();
    return eigenvalues(state_matrix(d, p, across(d, p))).cwiseAbs().minCoeff();
  }

 private:
  /// A_f
  [[nodiscard]] static Eigen::MatrixXd across(const Directions& d, const PrecessionPoint& p) {
    return product(product(d.P_t, p.f.A), p.way);
  }
  [[nodiscard]] static Eigen::MatrixXd state_matrix(const Directions& d, const PrecessionPoint& p,
                                                    const Eigen::MatrixXd& A) {
    return -A.ldlt().solve(product(product(p.way.transpose(), p.W), d.P));
  }
};

}  // namespace detail

PrecessionMotion precession_motion(const PrecessionModel& model, double t_begin,
                                   const Eigen::VectorXd& position, const Eigen::VectorXd& u,
                                   double t_end, const PrecessionOptions& options) {
  using Eigen::VectorXd;
  using Point = detail::PrecessionPoint;
  const auto clock = std::chrono::steady_clock::now();
  const GyroForces at_start = model.forces(t_begin, position);
  const auto directions = detail::Directions::of(at_start.G, options);
  const auto& N = directions.N;
  const Eigen::Index n = position.size(), kept = N.cols();

  const auto point = [&](double t, const VectorXd& z) {
    return Point(directions, model.forces(t, z.head(n)), z.tail(kept));
  };
  const auto field = [&](double t, const VectorXd& z, VectorXd& rate) {
    const Point p = point(t, z);
    // Not a number: the step is shortened.
    if (!p.determined) {
      rate.setConstant(std::numeric_limits<double>::quiet_NaN());
      return;
    }
    rate.head(n) = model.rate(t, z.head(n), p.u);
    rate.tail(kept) = p.dv;
  };
  // The change of the forces with a displacement at constant velocities.
  const auto stiffening = [&](double t, const VectorXd& z, const Point& p, const VectorXd& e) {
    const double size = e.norm();
    VectorXd change = VectorXd::Zero(e.size());
    if (!(size > 0)) return change;
    const double h = 1e-4;
    for (const double sign : {1.0, -1.0}) {
      const GyroForces f = model.forces(t, model.moved(z.head(n), VectorXd(sign * h / size * e)));
      change += sign * ((f.G + f.D) * p.u - f.Q + f.A * VectorXd(N * p.dv));
    }
    return VectorXd(change * (size / (2 * h)));
  };

  VectorXd z(n + kept);
  z << position, N.transpose() * u;
  std::vector<int> blocks = model.blocks();
  blocks.insert(blocks.end(), static_cast<std::size_t>(kept), 1);
  ExplicitRungeKutta steps(field, t_begin, z, options.accuracy, blocks);

  PrecessionMotion motion;
  motion.kept = static_cast<int>(kept);
  motion.valid_until = t_begin;
  std::optional<detail::Nutations> nutations;
  VectorXd e, w_kept;
  double worst = 0, fastest_drift = 0;
  bool good = true;
  const auto note = [&](double t, const VectorXd& at, const Point& p) {
    PrecessionSample s{t, at.head(n), p.u, e, nutations->amplitude(t - t_begin), 0};
    worst = std::max(worst, (e.cwiseAbs() + s.nutation).norm());
    s.bound = (1.2 + 4 * motion.smallness) * worst;
    good = good && s.bound <= options.tolerated_error;
    if (good) motion.valid_until = t;
    motion.samples.push_back(std::move(s));
  };

  if (!point(t_begin, z).determined) {
    detail::refuse_precession(
        t_begin, "G + D does not determine the velocities; keep the accelerations on its kernel");
  }
  while (steps.t() != t_end && motion.slow) {
    const double from = steps.t();
    std::vector<VectorXd> states{steps.y()};
    steps.step_towards(t_end);
    const double h = (steps.t() - from) / 4;
    std::vector<double> times{from};
    std::vector<Point> points;
    for (int i = 1; i < 5; ++i) {
      times.push_back(i < 4 ? from + i * h : steps.t());
      states.push_back(i < 4 ? steps.at(times.back()) : steps.y());
    }
    for (std::size_t i = 0; i < 5; ++i) points.push_back(point(times[i], states[i]));
    std::vector<VectorXd> neglected;
    for (std::size_t i = 0; i < 5; ++i) {
      const Point& p = points[i];
      VectorXd du = VectorXd::Zero(p.u.size());
      for (std::size_t k = 0; k < 5; ++k) {
        du += detail::five_point_slopes.at(i).at(k) / (12 * h) * points[k].u;
      }
      neglected.push_back(p.f.A * du - p.f.A * VectorXd(N * p.dv) +
                          model.motion_forces(times[i], states[i].head(n), p.u));
    }
    if (!nutations) {
      const Point& p = points[0];
      const VectorXd slow = p.velocity(directions, VectorXd(p.f.Q - neglected[0]), z.tail(kept));
      nutations.emplace(directions, p, u - slow);
      e = nutations->offset;
      w_kept = nutations->kick;
      note(t_begin, states[0], p);
    }
    const double least_nutation = detail::Nutations::slowest(directions, points[4]);
    // Classical Runge-Kutta steps from every second of the five points to the next.
    const auto slope = [&](std::size_t i, const VectorXd& x) {
      const Point& p = points[i];
      const VectorXd at = x.head(e.size());
      const VectorXd force = -neglected[i] - stiffening(times[i], states[i], p, at);
      const VectorXd w = p.velocity(directions, force, x.tail(kept));
      VectorXd rate(x.size());
      rate.head(e.size()) = w + model.turning_along(states[i].head(n), p.u, at);
      rate.tail(kept) = p.acceleration(directions, force - p.W * w);
      return rate;
    };
    VectorXd x(e.size() + kept);
    x << e, w_kept;
    for (std::size_t i = 0; i < 4; i += 2) {
      const VectorXd k_1 = slope(i, x);
      const VectorXd k_2 = slope(i + 1, x + h * k_1);
      const VectorXd k_3 = slope(i + 1, x + h * k_2);
      const VectorXd k_4 = slope(i + 2, x + 2 * h * k_3);
      x += h / 3 * (k_1 + 2 * k_2 + 2 * k_3 + k_4);
      fastest_drift = std::max(fastest_drift, k_4.head(e.size()).norm());
      const double turn = (k_4 - k_1).head(e.size()).norm() / (2 * h);
      if (fastest_drift > 0) {
        motion.smallness = std::max(motion.smallness, turn / fastest_drift / least_nutation);
      }
      motion.slow = motion.smallness < 0.5;
      if (!motion.slow) break;
      e = x.head(e.size());
      w_kept = x.tail(kept);
      note(times[i + 2], states[i + 2], points[i + 2]);
    }
    while (motion.slow && motion.outputs.size() < options.output_times.size() &&
           steps.covers(options.output_times[motion.outputs.size()])) {
      const double t = options.output_times[motion.outputs.size()];
      const VectorXd there = steps.at(t);
      motion.outputs.push_back(
          {t, there.head(n), point(t, there).u, {}, {}, motion.samples.back().bound});
    }
  }
  motion.effort = steps.effort();
  motion.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
  return motion;
}

}  // namespace kreisel
