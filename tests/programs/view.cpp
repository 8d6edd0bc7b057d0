// The page of simulate --plot in a browser: results of its JavaScript against the library. Skipped
// without Chromium.

#include <boost/test/unit_test.hpp>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>

#include <dynamics/file/scene_system.hpp>
#include <dynamics/solve/solve.hpp>
#include <dynamics/tree/body_system.hpp>

#include <support/json.hpp>
#include <support/program.hpp>

using namespace kreisel;
using nlohmann::json;
using test::Outcome;
using test::Scratch;

namespace {

// Every kind of joint, each turned against its parent, all in motion.
const std::string all_joints = R"(
title = "All joints"
[gravity]
kind = "uniform"
vector = [0, 0, -9.81]
[[body]]
name = "slide"
joint = { kind = "prismatic", axis = [1, 1, 0], orientation = [0.7, 0.1, -0.7, 0.1] }
mass = 2
inertia = [0.1, 0.1, 0.1]
initial = { displacement = 0.2, rate = -0.4 }
[[body]]
name = "gimbal"
parent = "slide"
mass = 1
inertia = [0.03, 0.02, 0.04]
initial = { angle = [0.4, -0.3], rate = [1, 2] }
[body.joint]
kind = "universal"
axis = [1, 0, 0]
second_axis = [0.2, 1, 0]
position = [0.1, 0, 0.3]
orientation = [0.5, -0.5, 0.5, 0.5]
[[body]]
name = "wheel"
parent = "gimbal"
joint = { kind = "revolute", axis = [0, 0.1, 1], orientation = [0.1, 0.7, 0.1, 0.7] }
mass = 1
inertia = [0.01, 0.01, 0.01]
initial = { angle = 0.7, rate = 9 }
[[body]]
name = "top"
parent = "slide"
joint = { kind = "spherical", position = [0, 0.4, 0], orientation = [0.9, 0.3, 0.1, 0.3] }
mass = 0.5
centre = [0, 0, 0.2]
inertia = [0.01, 0.02, 0.015]
initial = { attitude = [0.1, 0.3, 0.3, 0.9], angular_velocity = [3, -2, 4] }
[[body]]
name = "stone"
joint = { kind = "free", position = [0.5, 0, 0], orientation = [0.3, -0.9, 0.1, 0.3] }
mass = 1
inertia = [0.01, 0.02, 0.025]
initial = { position = [0, 0.3, 1], velocity = [0.4, 0, 3], angular_velocity = [1, 4, -2] }
[[sensor]]
name = "probe"
kind = "gyro"
body = "wheel"
[solve]
t_end = 1
output_step = 0.02
)";

// A script after the page's own, which can see all its data.
const std::string probe = R"(<pre id="probe"></pre><script>
playing = false;
draw();
const share_painted = (of) => {
  const dots = of.getContext("2d").getImageData(0, 0, of.width, of.height).data;
  return dots.filter((x, i) => i % 4 === 3 && x > 0).length / (dots.length / 4);
};
const press = (key, shiftKey = false) => {
  document.dispatchEvent(new KeyboardEvent("keydown", { key, shiftKey, bubbles: true }));
  return [t, playing];
};
const painted = share_painted(canvas), curve = share_painted(element("curve"));
element("probe").textContent = JSON.stringify({
  poses: [poses(row_at(0)), poses(row_at(0.51))],
  painted, curve,
  quantities: element("quantity").length,
  keys: [press("ArrowRight"), press("ArrowLeft", true), press("End"), press("Home"), press(" ")],
  words: element("bodies").textContent,
  sensors: element("sensors").textContent,
  fetched: performance.getEntriesByType("resource").length,
});
</script>)";

Outcome browse(const std::filesystem::path& page, const std::string& arguments) {
  const Scratch profile;
  return test::run("timeout 500 '" KREISEL_CHROMIUM
                   "' --headless --no-sandbox --disable-gpu --no-first-run --disable-extensions "
                   "--disable-background-networking --disable-sync --hide-scrollbars "
                   "--window-size=800,600 --timeout=100000 --user-data-dir='" +
                   profile.path().string() + "' " + arguments + " 'file://" + page.string() +
                   "#t=0.51'");
}

/// Prints the text that ctest recognises as "skipped".
bool has_browser() {
  const bool found = std::string(KREISEL_CHROMIUM) != "";
  if (!found) std::puts("chromium is not installed");
  return found;
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_view_needs_no_gnuplot) {
  const Scratch folder;
  const auto file = folder.write("scene.toml", all_joints);
  const Outcome outcome = test::run("PATH=/nowhere " + std::string(KREISEL_SIMULATE) + " " +
                                    file.string() + " --plot " + folder.path().string());
  BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
  BOOST_TEST(outcome.err.find("gnuplot is not installed") != std::string::npos);
  BOOST_TEST(std::filesystem::exists(folder.path() / "view.html"));
  BOOST_TEST(!std::filesystem::exists(folder.path() / "rates.svg"));
}

BOOST_AUTO_TEST_CASE(a_browser_shows_every_joint_correctly) {
  if (!has_browser()) return;
  const Scratch folder;
  const auto file = folder.write("scene.toml", all_joints);
  const Outcome outcome = test::run(std::string(KREISEL_SIMULATE) + " " + file.string() +
                                    " --plot " + folder.path().string());
  BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
  const auto page = folder.write("probe.html", folder.read("view.html") + probe);
  const auto picture = std::filesystem::path(KREISEL_PICTURES) / "all_joints.png";
  std::filesystem::create_directories(picture.parent_path());
  const Outcome shown = browse(page, "--dump-dom --screenshot='" + picture.string() + "'");
  BOOST_TEST(std::filesystem::file_size(picture) > 10000U);
  const std::string opening = R"(<pre id="probe">)";
  const std::size_t begin = shown.out.rfind(opening);
  BOOST_REQUIRE_MESSAGE(begin != std::string::npos, shown.err);
  const std::size_t end = shown.out.find("</pre>", begin);
  const json found =
      test::parsed(shown.out.substr(begin + opening.size(), end - begin - opening.size()));
  BOOST_TEST(found.at("painted").get<double>() > 0.01);
  BOOST_TEST(found.at("curve").get<double>() > 0.01);
  BOOST_TEST(found.at("quantities") == 20);
  BOOST_TEST(found.at("fetched") == 0);
  // Rows are 0.02 s apart; the page begins between those at 0.5 s and 0.52 s.
  const double shown_times[] = {0.52, 0.32, 1, 0, 0};
  for (std::size_t i = 0; i < 5; ++i) {
    const json& key = found.at("keys").at(i);
    BOOST_TEST(std::abs(key.at(0).get<double>() - shown_times[i]) < 1e-9, "key " << i);
    BOOST_TEST(key.at(1) == (i == 4));  // the space plays
  }
  BOOST_TEST(found.at("words").get<std::string>().find("rad/s") != std::string::npos);
  BOOST_TEST(found.at("sensors").get<std::string>().starts_with("probex"));

  const SceneFile scene = parse_scene(all_joints, file);
  const auto [bodies, gravity, elements, constraints, gravitation] = bodies_in_gravity(scene);
  const BodySystem system(make_guide_of_equations(scene), bodies, gravity);
  auto start = system.rest();
  Eigen::Index q = 0;
  Eigen::Index v = 0;
  for (const JointStart& joint : scene.start) {
    for (const double x : joint.coordinates) start.coordinates[q++] = x;
    for (const double x : joint.rates) start.rates[v++] = x;
  }
  const auto run = solve(system, start, {.output_times = {0, 0.51}, .tolerance = 1e-10});
  auto workspace = system.workspace();
  // At 0.51 s between two rows, where a cubic errs by (0.02 s)^4 / 384 of a fourth derivative.
  for (std::size_t k = 0; k < 2; ++k) {
    const double bound = k == 0 ? 1e-8 : 1e-5;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      const auto X = system
                         .situation(run.times[k], system.to_vector(run.states[k]),
                                    static_cast<int>(i), workspace)
                         .X.value;
      const json& pose = found.at("poses").at(k).at(i);
      for (std::size_t n = 0; n < 9; ++n) {
        const double wanted =
            X.rotation(static_cast<Eigen::Index>(n / 3), static_cast<Eigen::Index>(n % 3));
        BOOST_TEST(std::abs(pose.at("R").at(n).get<double>() - wanted) <= bound, bodies[i].name);
      }
      for (std::size_t n = 0; n < 3; ++n) {
        const double wanted = X.translation[static_cast<Eigen::Index>(n)];
        BOOST_TEST(std::abs(pose.at("p").at(n).get<double>() - wanted) <= bound, bodies[i].name);
      }
    }
  }
}
