// The catalogue of stiff and extreme cases, each over every scene and method to which it applies.
// Results are compared with closed forms, references of 25 digits or an independent run. A result
// is right if its error is within the reported estimate, or if there is a clear error message;
// everything else has FAILED. Writes stability.csv, stability.md and pictures of drift into a
// directory.
//
// Usage: stability [--quick] [--case NAME|all] --out DIR
//
// Exit status: 0; 1 if a case failed; 2 for a wrong call; 3 if the output cannot be written.

#include <fmt/core.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include <motor/error.hpp>

#include "order.hpp"
#include "stability/catalogue.hpp"
#include "stability/isolated.hpp"
#include "stability/output.hpp"

using namespace stability;

namespace {

std::vector<Case> chosen(const std::string& wanted) {
  std::vector<Case> all;
  for (const AddCases add :
       {&tops, &heavy_tops, &held_bodies, &free_bodies, &fast_bodies, &gyros, &rotors, &systems,
        &plane_motions, &pendulum_scene, &steppers, &guides, &inputs}) {
    add(all);
  }
  if (wanted == "all") return all;
  std::string known;
  for (const Case& c : all) known += " " + c.name;
  std::erase_if(all, [&](const Case& c) { return c.name != wanted; });
  if (all.empty()) throw kreisel::InvalidInput("no such case: " + wanted + "; there are" + known);
  return all;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const Order order = parse_order(argc, argv, "stability", "case");
    const std::vector<Case> cases = chosen(order.wanted);
    std::filesystem::create_directories(order.directory);
    const std::vector<Finding> findings = run_isolated(cases, order.quick);
    write_csv(order.directory + "/stability.csv", findings);
    write_tables(order.directory + "/stability.md", findings);
    draw(order.directory, findings);
    if (interrupted()) return 130;
    int failures = 0;
    for (const Finding& f : findings) {
      for (const Row& r : f.rows) {
        if (r.verdict != Verdict::failed) continue;
        failures += 1;
        fmt::print("FAILED {}: {}, {}: {} (error {:.3g}, estimate {:.3g})\n", f.name, r.variant,
                   r.method, r.note, r.error, r.estimate);
      }
    }
    fmt::print("{} cases, {} failures\n", findings.size(), failures);
    return failures == 0 ? 0 : 1;
  } catch (const kreisel::InvalidInput& error) {
    fmt::print(stderr, "stability: {}\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    fmt::print(stderr, "stability: {}\n", error.what());
    return 3;
  }
}
