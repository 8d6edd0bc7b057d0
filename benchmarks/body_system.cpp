// Chains of 1 to 4096 revolute bodies: BodySystem beside articulated bodies and Newton-Euler
// written out by hand for such chains and nothing else, on body axes, as textbooks do.

#include <Eigen/Core>
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <dynamics/guide/rotating.hpp>
#include <dynamics/scene/body_system.hpp>

using namespace kreisel;

namespace {

using V3 = Vector3<double>;
using M3 = Matrix3<double>;

const V3 gravity(0.5, -1, -9.75);

std::vector<BodyDescription> chain(int n) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto vector = [&] {
    const double x = uniform(random);
    const double y = uniform(random);
    const double z = uniform(random);
    return V3(x, y, z);
  };
  std::vector<BodyDescription> bodies;
  for (int i = 0; i < n; ++i) {
    BodyDescription b;
    b.name = "body " + std::to_string(i);
    if (i > 0) b.parent = "body " + std::to_string(i - 1);
    b.joint = {.kind = JointKind::revolute, .axis = vector(), .position = vector()};
    b.inertia = InertiaTensor<Body>::about_centre(1.25, 0.25 * vector(),
                                                  V3(0.1, 0.12, 0.15).asDiagonal().toDenseMatrix());
    bodies.push_back(b);
  }
  return bodies;
}

struct Start {
  Eigen::VectorXd y;
  Eigen::VectorXd dv;

  explicit Start(int n) : y(2 * n), dv(n) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (double& x : y) x = uniform(random);
    for (double& x : dv) x = uniform(random);
  }
};

/// Everything on body axes, moments about the body's origin; R takes body to parent axes.
class HandWritten {
 public:
  explicit HandWritten(const std::vector<BodyDescription>& bodies) : links_(bodies.size()) {
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      const Inertia<>& T = bodies[i].inertia.value;
      links_[i].axis = bodies[i].joint.axis.normalized();
      links_[i].position = bodies[i].joint.position;
      links_[i].mass = T.mass;
      links_[i].s = T.first_moment;
      links_[i].tensor = T.tensor.matrix();
    }
  }

  void forward(const double* q, const double* v, double* dv) {
    spread(q, v, nullptr);
    for (Link& l : links_) {
      l.M = l.mass * M3::Identity();
      l.H = skew(l.s);
      l.J = l.tensor;
    }
    for (std::size_t i = links_.size(); i-- > 0;) {
      Link& l = links_[i];
      l.h.noalias() = l.H.transpose() * l.axis;
      l.j.noalias() = l.J * l.axis;
      l.d = 1 / l.axis.dot(l.j);
      l.u = -l.axis.dot(l.n);
      if (i == 0) break;
      Link& p = links_[i - 1];
      const V3 hd = l.d * l.h;
      const V3 jd = l.d * l.j;
      const M3 M = l.M - hd * l.h.transpose();
      const M3 H = l.H - jd * l.h.transpose();
      const M3 J = l.J - jd * l.j.transpose();
      const M3& R = l.R;
      const M3 x = skew(l.position);
      const M3 Mp = R * M * R.transpose();
      const M3 Hp = R * H * R.transpose();
      const M3 Jp = R * J * R.transpose();
      const M3 xH = x * Hp.transpose();
      const M3 xM = x * Mp;
      p.M += Mp;
      p.H += Hp + xM;
      p.J += Jp + xH + xH.transpose() - xM * x;
      const V3 f = R * (l.f + l.u * hd);
      p.f += f;
      p.n += R * (l.n + l.u * jd) + l.position.cross(f);
    }
    V3 dw = V3::Zero();
    V3 a = V3::Zero();
    for (std::size_t i = 0; i < links_.size(); ++i) {
      const Link& l = links_[i];
      const V3 moved = a + dw.cross(l.position);
      a.noalias() = l.R.transpose() * moved;
      dw = V3(l.R.transpose() * dw);
      dv[i] = (l.u - l.h.dot(a) - l.j.dot(dw)) * l.d;
      dw += dv[i] * l.axis;
    }
  }

  void inverse(const double* q, const double* v, const double* dv, double* force) {
    spread(q, v, dv);
    for (std::size_t i = links_.size(); i-- > 0;) {
      const Link& l = links_[i];
      force[i] = l.axis.dot(l.n);
      if (i == 0) break;
      Link& p = links_[i - 1];
      const V3 f = l.R * l.f;
      p.f += f;
      p.n += l.R * l.n + l.position.cross(f);
    }
  }

 private:
  struct Link {
    V3 axis, position, s;
    M3 tensor;
    double mass = 0;
    M3 R, M, H, J;
    V3 f, n, h, j;
    double d = 0;
    double u = 0;
  };

  void spread(const double* q, const double* v, const double* dv) {
    V3 w = V3::Zero();
    V3 dw = V3::Zero();
    V3 a = -gravity;
    for (std::size_t i = 0; i < links_.size(); ++i) {
      Link& l = links_[i];
      const double c = std::cos(q[i]);
      const double s = std::sin(q[i]);
      l.R = (1 - c) * l.axis * l.axis.transpose() + s * skew(l.axis);
      l.R.diagonal().array() += c;
      const V3 moved = a + dw.cross(l.position) + w.cross(w.cross(l.position));
      a.noalias() = l.R.transpose() * moved;
      const V3 w_parent = l.R.transpose() * w;
      const V3 turn = v[i] * l.axis;
      dw = V3(l.R.transpose() * dw) + w_parent.cross(turn);
      if (dv) dw += dv[i] * l.axis;
      w = w_parent + turn;
      l.f = l.mass * a + dw.cross(l.s) + w.cross(w.cross(l.s));
      l.n = l.s.cross(a) + l.tensor * dw + w.cross(l.tensor * w);
    }
  }

  std::vector<Link> links_;
};

template <class M>
struct System {
  BodySystem<M> system;
  BodyWorkspace w;
  Start start;
  Eigen::VectorXd result;

  System(const M& guide, int n)
      : system(guide, chain(n), UniformGravity<Guide>{gravity}), w(system.workspace()), start(n) {}
};

RestingFrame<> resting() { return {}; }
RotatingFrame<> moving() {
  return {.angular_velocity = {0.5, 0.25, 1}, .origin_acceleration = {1, 2, 3}};
}

template <auto guide>
void forward(benchmark::State& state) {
  System<decltype(guide())> s(guide(), static_cast<int>(state.range(0)));
  for (auto _ : state) {
    s.start.y[0] += 1e-3;
    s.system.accelerations(0.5, s.start.y, {}, s.result, s.w);
    benchmark::DoNotOptimize(s.result.data());
  }
}

template <auto guide>
void inverse(benchmark::State& state) {
  System<decltype(guide())> s(guide(), static_cast<int>(state.range(0)));
  for (auto _ : state) {
    s.start.y[0] += 1e-3;
    s.system.joint_forces(0.5, s.start.y, s.start.dv, s.result, s.w);
    benchmark::DoNotOptimize(s.result.data());
  }
}

void forward_by_hand(benchmark::State& state) {
  const auto n = static_cast<int>(state.range(0));
  HandWritten hand(chain(n));
  Start start(n);
  Eigen::VectorXd result(n);
  for (auto _ : state) {
    start.y[0] += 1e-3;
    hand.forward(start.y.data(), start.y.data() + n, result.data());
    benchmark::DoNotOptimize(result.data());
  }
}

void inverse_by_hand(benchmark::State& state) {
  const auto n = static_cast<int>(state.range(0));
  HandWritten hand(chain(n));
  Start start(n);
  Eigen::VectorXd result(n);
  for (auto _ : state) {
    start.y[0] += 1e-3;
    hand.inverse(start.y.data(), start.y.data() + n, start.dv.data(), result.data());
    benchmark::DoNotOptimize(result.data());
  }
}

/// Times of two things that differ say nothing.
bool both_agree() {
  const int n = 16;
  System<RestingFrame<>> s(resting(), n);
  HandWritten hand(chain(n));
  Eigen::VectorXd by_hand(n);
  const double* q = s.start.y.data();
  s.system.accelerations(0, s.start.y, {}, s.result, s.w);
  hand.forward(q, q + n, by_hand.data());
  const double forward_off = (s.result - by_hand).norm() / by_hand.norm();
  s.system.joint_forces(0, s.start.y, s.start.dv, s.result, s.w);
  hand.inverse(q, q + n, s.start.dv.data(), by_hand.data());
  const double inverse_off = (s.result - by_hand).norm() / by_hand.norm();
  if (forward_off < 1e-11 && inverse_off < 1e-12) return true;
  std::fprintf(stderr,
               "body_system: library and hand-written loop differ by %.1e forward, %.1e "
               "inverse\n",
               forward_off, inverse_off);
  return false;
}

void lengths(benchmark::internal::Benchmark* benchmark) {
  for (const int n : {1, 4, 16, 64, 256, 1024, 4096}) benchmark->Arg(n);
}

}  // namespace

BENCHMARK(forward_by_hand)->Apply(lengths);
BENCHMARK_TEMPLATE(forward, resting)->Apply(lengths);
BENCHMARK_TEMPLATE(forward, moving)->Apply(lengths);
BENCHMARK(inverse_by_hand)->Apply(lengths);
BENCHMARK_TEMPLATE(inverse, resting)->Apply(lengths);
BENCHMARK_TEMPLATE(inverse, moving)->Apply(lengths);

int main(int argc, char** argv) {
  if (!both_agree()) return EXIT_FAILURE;
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
}
