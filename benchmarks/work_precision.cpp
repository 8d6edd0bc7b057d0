// Error against run time: every method on every scene over all tolerances. Each result is compared
// with a truth that no method computes. Writes work_precision.csv, two pictures for each scene and
// work_precision.md into a directory.
//
// Usage: work_precision [--quick] [--scene NAME|all] --out DIR

#include <fmt/core.h>

#include <exception>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <motor/error.hpp>

#include "order.hpp"
#include "work_precision/output.hpp"
#include "work_precision/point.hpp"
#include "work_precision/scenes.hpp"

using namespace work_precision;

namespace {

const std::pair<std::string, AddRuns> all_scenes[] = {
    {"dzhanibekov", &dzhanibekov},     {"fast_top", &fast_top},
    {"slow_top", &slow_top},           {"fast_top_axis", &fast_top_axis},
    {"pendulum", &pendulum},           {"earth_pendulum", &earth_pendulum},
    {"earth_ball", &earth_ball},       {"ship", &ship},
    {"cardan_free", &cardan_free},     {"cardan_on_base", &cardan_on_base},
    {"cardan_blades", &cardan_blades}, {"satellite", &satellite},
    {"bearing_1e3", &bearing_1e3},     {"bearing_1e6", &bearing_1e6},
    {"bearing_1e9", &bearing_1e9},     {"bearing_undamped", &bearing_undamped},
    {"bearing_1e12", &bearing_1e12},   {"bearing_deviation", &bearing_deviation}};

std::vector<Run> runs(const std::string& scene, const Thoroughness& thoroughness) {
  std::vector<Run> all;
  std::string known;
  for (const auto& [name, add] : all_scenes) {
    if (scene == "all" || scene == name) add(all, thoroughness);
    known += " " + name;
  }
  if (all.empty()) throw kreisel::InvalidInput("no such scene: " + scene + "; there are" + known);
  return all;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const Order order = parse_order(argc, argv, "work_precision", "scene");
    const Thoroughness thoroughness =
        order.quick ? Thoroughness::in_a_minute() : Thoroughness::full();
    std::filesystem::create_directories(order.directory);
    const std::vector<Point> points = measure(runs(order.wanted, thoroughness), thoroughness);
    write_csv(order.directory + "/work_precision.csv", points);
    write_tables(order.directory + "/work_precision.md", points);
    draw(order.directory, points);
    return interrupted() ? 130 : 0;
  } catch (const kreisel::InvalidInput& error) {
    fmt::print(stderr, "work_precision: {}\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    fmt::print(stderr, "work_precision: {}\n", error.what());
    return 3;
  }
}
