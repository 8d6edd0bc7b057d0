// Members of an ensemble per second: one by one, in packs, and in packs on two threads, all with
// the same accuracy. Prints the greatest true error of the first 64 members as well, which must be
// equal.

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <ctime>
#include <string>
#include <vector>

#include <dynamics/ensemble/ensemble.hpp>
#include <dynamics/gimbal/cardan_gyro.hpp>
#include <dynamics/rigid/euler_top.hpp>

#include <tests/support/worst.hpp>

using namespace kreisel;

namespace {

using Gyro = CardanGyro<RestingFrame<>>;

constexpr std::size_t members = 512;
constexpr std::size_t checked = 64;
constexpr int repetitions = 9;
const SolveOptions options{.output_times = {2}, .tolerance = 1e-10};

Member<EulerTop> scattered_top(std::size_t /*index*/, MemberRandom& random) {
  const double A = random.normal(0.002, 0.00002);
  const double tilt = random.normal(0.5, 0.05);
  return {EulerTop({A, A, random.normal(0.003, 0.00003)}, {0, 0, 0.05}),
          {Eigen::Quaterniond(Eigen::AngleAxisd(tilt, Vector3<double>::UnitX())),
           {random.normal(), random.normal(), random.normal(100, 5)}}};
}

/// `blades` : A/B of the rotor
Member<Gyro> scattered_gyro(MemberRandom& random, double blades) {
  CardanMoments moments{.rotor = {0.005, 0.005, 0.008},
                        .inner_ring = {0.002, 0.0015, 0.0028},
                        .outer_ring = {0.006, 0.0045, 0.005}};
  moments.rotor *= random.normal(1, 0.01);
  moments.rotor.x() *= blades;
  moments.outer_ring *= random.normal(1, 0.01);
  return {Gyro(moments, {}, {}),
          {.beta = random.normal(0.5, 0.1), .beta_rate = random.normal(1, 0.1), .phi_rate = 50}};
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

/// One way to run an ensemble, and the times of its repetitions.
struct Way {
  std::string name;
  std::vector<double> processor;  ///< s, of all threads
  std::vector<double> wall;       ///< s
  double error = 0;
};

template <class Make>
void measure(const char* name, const Make& make) {
  using Scene = decltype(std::invoke_result_t<const Make&, std::size_t, MemberRandom&>::scene);
  std::vector<typename Scene::State> truth;
  for (std::size_t i = 0; i < checked; ++i) {
    MemberRandom random(1, i);
    const auto [scene, start] = make(i, random);
    truth.push_back(Integrator(scene, 0, start, {1e-15}).to(options.output_times.back()));
  }
  std::array<Way, 3> ways{Way{"one by one", {}, {}}, Way{"packs", {}, {}},
                          Way{"packs, 2 threads", {}, {}}};
  const auto run = [&](Way& way, const auto& how) {
    const auto begin = std::chrono::steady_clock::now();
    const std::clock_t before = std::clock();
    const auto result = how();
    way.processor.push_back(static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC);
    way.wall.push_back(
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    ErrorMeasure<Scene> distance(options.absolute_scale);
    for (std::size_t i = 0; i < checked; ++i) {
      const auto y = Scene::to_vector(result.members[i].states.back());
      way.error = test::worst_of(way.error, distance(y, Scene::to_vector(truth[i])));
    }
  };
  const Sampling alone{.count = members, .threads = 1, .estimates_errors = false};
  Sampling two = alone;
  two.threads = 2;
  for (int i = 0; i < repetitions; ++i) {  // alternately, so that disturbances affect all
    run(ways[0], [&] { return ensemble<double>(alone, make, options); });
    run(ways[1], [&] { return ensemble(alone, make, options); });
    run(ways[2], [&] { return ensemble(two, make, options); });
  }
  const double first_processor = median(ways[0].processor);
  const double first_wall = median(ways[0].wall);
  for (const Way& way : ways) {
    const double processor = median(way.processor);
    const double wall = median(way.wall);
    fmt::print("{:24}{:18}{:14.0f}{:9.2f}{:16.1f}{:9.2f}{:12.1e}\n", name, way.name,
               static_cast<double>(members) / wall, first_wall / wall,
               1e6 * processor / static_cast<double>(members), first_processor / processor,
               way.error);
  }
}

}  // namespace

int main() {
  fmt::print("{} members, 2 s of motion, {:.0e} in a step, packs of {}; medians of {}\n\n", members,
             options.tolerance / 10, Pack::lanes, repetitions);
  fmt::print("{:24}{:18}{:>14}{:>9}{:>16}{:>9}{:>12}\n", "", "", "members/s", "", "us of a core",
             "", "true error");
  measure("heavy top", scattered_top);
  measure("Cardan gyro",
          [](std::size_t /*index*/, MemberRandom& random) { return scattered_gyro(random, 1); });
  measure("Cardan gyro, unsym.",
          [](std::size_t /*index*/, MemberRandom& random) { return scattered_gyro(random, 0.9); });
}
