// simulate --resume: rows and report of a stopped run, against those of an uninterrupted one.

#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include <dynamics/file/columns.hpp>
#include <dynamics/file/readings.hpp>

#include <support/json.hpp>
#include <support/program.hpp>

using namespace kreisel;
using nlohmann::json;
using test::Outcome;
using test::Scratch;

namespace {

const std::string simulate = KREISEL_SIMULATE;

/// A sensor whose increments depend on all earlier ones.
const std::string gyro =
    "[[sensor]]\nname = \"gyro\"\nkind = \"gyro\"\nbody = \"lower\"\nperiod = 0.1\n"
    "increments = true\nnoise = 1e-3\ndrift = 1e-4\nresolution = 1e-3\n";

std::string two_rods(const std::string& method, const std::string& t_end) {
  const std::string rod =
      "joint = { kind = \"revolute\", axis = [0, 1, 0], position = [0, 0, PLACE] }\n"
      "mass = 1\ncentre = [0, 0, -1]\ninertia = [0.1, 0.1, 0.1]\n";
  const auto at = [&rod](const char* place) {
    std::string text = rod;
    return text.replace(text.find("PLACE"), 5, place);
  };
  return "[gravity]\nkind = \"uniform\"\nvector = [0, 0, -9.81]\n[[body]]\nname = \"upper\"\n" +
         at("0") + "initial = { angle = 0.5 }\n[[body]]\nname = \"lower\"\nparent = \"upper\"\n" +
         at("-1") + "[solve]\nt_end = " + t_end + "\ntolerance = 1e-9\noutput_step = 0.05\n" +
         "method = \"" + method + "\"\n";
}

/// A scene, its uninterrupted run, and a CSV file for the stopped one.
struct Case {
  Case(const std::string& method, const std::string& t_end, const std::string& sensor = "")
      : scene(folder.write("scene.toml", two_rods(method, t_end) + sensor).string()),
        csv((folder.path() / "part.csv").string()) {
    const auto start = std::chrono::steady_clock::now();
    const Outcome outcome = test::run(simulate + " " + scene + " --json --csv " +
                                      (folder.path() / "whole.csv").string());
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    seconds_of_whole = taken.count();
    BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
    report = test::parsed(outcome.out);
    rows = folder.read("whole.csv");
  }

  [[nodiscard]] Outcome run(const std::string& options, const std::string& before = "") const {
    return test::run(before + " " + simulate + " " + scene + " --json --csv " + csv + " " +
                     options);
  }

  void check(const Outcome& outcome) const {
    BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
    BOOST_TEST((folder.read("part.csv") == rows));
    const json found = test::parsed(outcome.out);
    for (const char* const key : {"final", "steps", "rejected", "evaluations", "all_evaluations",
                                  "error_estimate", "invariants", "method"}) {
      BOOST_TEST(found.at(key) == report.at(key), key);
    }
    BOOST_TEST(!std::filesystem::exists(csv + ".resume"));
  }

  /// Rows up to the middle, with a checkpoint that is not of the first row.
  void stop_half_way() const {
    std::mt19937 random(2);
    for (int runs = 0;; ++runs) {
      BOOST_TEST_REQUIRE(runs < 300);
      const double seconds = std::uniform_real_distribution(0.1, 1.0)(random) * seconds_of_whole;
      std::filesystem::remove(csv);
      std::filesystem::remove(csv + ".resume");
      (void)run("", "timeout --foreground -s KILL " + std::to_string(seconds));
      if (folder.read("part.csv").size() < rows.size() && checkpoint_bytes() > 1000) return;
    }
  }

  /// Bytes of the rows covered by the checkpoint; 0 if there is none.
  [[nodiscard]] std::size_t checkpoint_bytes() const {
    std::istringstream words(folder.read("part.csv.resume"));
    std::string word;
    double t = 0;
    double begin = 0;
    std::size_t bytes = 0;
    words >> word >> word >> t >> begin >> bytes;
    return t > 0 ? bytes : 0;
  }

  /// First output of a continued run, without waiting for its end.
  [[nodiscard]] std::string first_words(const std::string& options = "") const {
    const std::string begun = folder.read("part.csv");
    const std::string checkpoint = folder.read("part.csv.resume");
    for (double seconds = 0.1; seconds < 100; seconds *= 2) {
      folder.write("part.csv", begun);
      folder.write("part.csv.resume", checkpoint);
      const Outcome outcome =
          run("--resume " + options, "timeout --foreground -s KILL " + std::to_string(seconds));
      if (!outcome.err.empty()) return outcome.err;
    }
    return "";
  }

  Scratch folder;
  std::string scene;
  std::string csv;
  json report;
  std::string rows;
  double seconds_of_whole = 0;
};

bool is_told(const std::string& words) {
  return words.find("with new steps") != std::string::npos ||
         words.find("is damaged") != std::string::npos ||
         words.find("does not increase") != std::string::npos ||
         words.find("another state than the scene") != std::string::npos ||
         words.find("are not those of this scene") != std::string::npos;
}

std::string line(const std::string& text, std::size_t number) {
  std::size_t begin = 0;
  for (std::size_t i = 0; i < number; ++i) begin = text.find('\n', begin) + 1;
  return text.substr(begin, text.find('\n', begin) + 1 - begin);
}

}  // namespace

BOOST_AUTO_TEST_SUITE(resuming)

// 300 kills in all, of runs of half a second or more. A run that is killed before it advances gets
// more time.
BOOST_AUTO_TEST_CASE(continues_exactly_after_300_kills) {
  std::mt19937 random(1);
  for (const auto& [method, t_end] :
       {std::pair("verner98", "600"), std::pair("taylor", "500\nt_begin = -300"),
        std::pair("gauss16", "150"), std::pair("radau13", "400")}) {
    const Case c(method, t_end);
    int kills = 0;
    double longest = 0.2;
    for (int runs = 0; kills < 75; ++runs) {
      BOOST_TEST_REQUIRE(runs < 300);
      std::string resume;
      Outcome outcome{137, "", ""};
      while (outcome.status == 137) {
        const double drawn = std::uniform_real_distribution(0.01, longest)(random);
        const double seconds = kills < 75 ? drawn : 600;
        outcome = c.run(resume, "timeout --foreground -s KILL " + std::to_string(seconds));
        if (outcome.status != 137) break;
        if (!outcome.out.empty()) break;  // it was complete
        BOOST_TEST(outcome.err.find("new steps") == std::string::npos, outcome.err);
        if (++kills % 50 == 0) longest *= 1.5;
        resume = std::filesystem::exists(c.csv) ? "--resume" : "";
      }
      // 124: its time was over
      if (outcome.status != 137 && outcome.status != 124) c.check(outcome);
      std::filesystem::remove(c.csv);
      std::filesystem::remove(c.csv + ".resume");
    }
    BOOST_TEST_MESSAGE(method << ": " << kills << " kills");
  }
}

BOOST_AUTO_TEST_CASE(continues_increments_exactly) {
  const Case c("verner98", "40", gyro);
  c.stop_half_way();
  c.check(c.run("--resume"));
}

// A run may be continued after any row: sensors with a period read the states that rows hold. Their
// quaternions have the length 1, those of the run nearly.
BOOST_AUTO_TEST_CASE(reads_what_rows_hold) {
  const Scratch folder;
  const auto scene = folder.write("top.toml", R"(
[gravity]
kind = "uniform"
vector = [0, 0, -9.81]
[[body]]
name = "a"
joint = { kind = "spherical" }
mass = 1
centre = [0.02, 0.1, -0.3]
inertia = [0.02, 0.03, 0.04]
initial = { angular_velocity = [3, 2, 5] }
[[sensor]]
name = "gyro"
kind = "gyro"
body = "a"
period = 0.013
[[sensor]]
name = "increments"
kind = "accelerometer"
body = "a"
increments = true
period = 0.05
[solve]
t_end = 20
tolerance = 1e-10
output_step = 0.01
)");
  const auto csv = folder.path() / "run.csv";
  BOOST_REQUIRE(test::run(simulate + " " + scene.string() + " --csv " + csv.string()).status == 0);
  const SceneFile file = read_scene(scene);
  const auto model = make_model(file);
  SensorReadings sensors(file);
  std::istringstream lines(folder.read("run.csv"));
  std::string text;
  std::getline(lines, text);
  int rows = 0;
  while (std::getline(lines, text)) {
    std::replace(text.begin(), text.end(), ',', ' ');
    std::istringstream words(text);
    const std::vector<double> numbers{std::istream_iterator<double>(words), {}};
    const std::vector<double> found =
        sensors.row(*model, numbers.front(), state_of(*model, numbers));
    BOOST_TEST_REQUIRE(found.size() == 6U);
    BOOST_TEST(std::equal(found.begin(), found.end(), numbers.end() - 6), text);
    ++rows;
  }
  BOOST_TEST(rows > 2000);
}

/// A sampled servo with memory and outputs that wait.
const std::string servo =
    "[[sensor]]\nname = \"pickoff\"\nkind = \"joint\"\njoint = \"upper\"\n"
    "[[controller]]\nname = \"servo\"\nreads = [\"pickoff.angle\"]\ndrives = [\"upper\"]\n"
    "law = { kind = \"pid\", proportional = 1, integral = 0.05 }\n"
    "period = 0.2\ndelay = 0.25\nlimit = 2\n";

BOOST_AUTO_TEST_CASE(continues_controllers_exactly) {
  const Case c("verner98", "40", gyro + servo);
  c.stop_half_way();
  c.check(c.run("--resume"));
}

// Without a checkpoint the rows have the whole state, also at the time of a sample.
BOOST_AUTO_TEST_CASE(continues_controllers_from_a_row) {
  const Case c("verner98", "3", gyro + servo);
  for (const char* const cut : {"\n1.45", "\n1.6", "\n0.05"}) {
    c.folder.write("part.csv", c.rows.substr(0, c.rows.find(cut) + 1));
    const Outcome outcome = c.run("--resume");
    BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
    const json final = test::parsed(outcome.out).at("final");
    const auto check_near = [&](const json& found, const json& wanted) {
      BOOST_TEST(std::abs(found.get<double>() - wanted.get<double>()) < 1e-7);
    };
    for (const char* const body : {"upper", "lower"}) {
      check_near(final.at("joints").at(body).at("coordinate"),
                 c.report.at("final").at("joints").at(body).at("coordinate"));
    }
    check_near(final.at("sensors").at("servo").at("value").at(0),
               c.report.at("final").at("sensors").at("servo").at("value").at(0));
  }
}

// The checkpoint after new steps belongs to the run that began with that row.
BOOST_AUTO_TEST_CASE(continues_after_new_steps) {
  const Case c("verner98", "600");
  const std::string begin = c.rows.substr(0, c.rows.find("\n0.25,") + 1);
  const auto begin_anew = [&] {
    c.folder.write("part.csv", begin);
    std::filesystem::remove(c.csv + ".resume");
  };
  begin_anew();
  const Outcome whole = c.run("--resume");
  BOOST_REQUIRE_MESSAGE(whole.status == 0, whole.err);
  const std::string wanted = c.folder.read("part.csv");
  BOOST_TEST(std::count(wanted.begin(), wanted.end(), '\n') ==
             std::count(c.rows.begin(), c.rows.end(), '\n'));
  int kills = 0;
  for (double seconds = 0.05; kills < 4; seconds *= 1.1) {
    BOOST_TEST_REQUIRE(seconds < 60);
    begin_anew();
    Outcome outcome{137, "", ""};
    while (outcome.status == 137 && kills < 40) {
      outcome = c.run("--resume", "timeout --foreground -s KILL " + std::to_string(seconds));
      if (outcome.status == 137) ++kills;
    }
    if (outcome.status == 137) outcome = c.run("--resume", "timeout 60");
    BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
    BOOST_TEST((c.folder.read("part.csv") == wanted));
    const json found = test::parsed(outcome.out);
    BOOST_TEST(found.at("final") == test::parsed(whole.out).at("final"));
  }
}

// The first row is the start of the scene to the last bit.
BOOST_AUTO_TEST_CASE(continues_a_closed_form_from_a_row) {
  const Scratch folder;
  const std::string scene =
      folder
          .write("top.toml",
                 "[gravity]\nkind = \"uniform\"\nvector = [0, 0, -9.81]\n[[body]]\nname = \"top\"\n"
                 "joint = { kind = \"spherical\" }\nmass = 0.1\ncentre = [0, 0, 0.05]\n"
                 "inertia = [0.5e-4, 0.5e-4, 1e-4]\ninitial = { attitude = [0.9689124217106447, "
                 "0.24740395925452294, 0, 0], angular_velocity = [0, 0, 3000] }\n"
                 "[solve]\nt_end = 1\noutput_step = 0.1\n")
          .string();
  const std::string command =
      simulate + " " + scene + " --csv " + (folder.path() / "part.csv").string();
  BOOST_REQUIRE(test::run(command).status == 0);
  const std::string whole = folder.read("part.csv");
  const auto third_row = whole.find('\n', whole.find('\n', whole.find('\n') + 1) + 1) + 1;
  folder.write("part.csv", whole.substr(0, third_row));
  const Outcome outcome = test::run(command + " --resume");
  BOOST_TEST(outcome.status == 0, outcome.err);
  const std::string all = folder.read("part.csv");
  BOOST_TEST(std::count(all.begin(), all.end(), '\n') ==
             std::count(whole.begin(), whole.end(), '\n'));
}

BOOST_AUTO_TEST_CASE(does_not_lose_the_row_of_the_start) {
  for (const char* const times : {"2", "2\nt_begin = -1", "2\nt_begin = 1"}) {
    const Case c("taylor", times);
    c.folder.write("part.csv", line(c.rows, 0) + line(c.rows, 1));
    c.check(c.run("--resume"));
    c.folder.write("part.csv", line(c.rows, 0));
    c.check(c.run("--resume"));
  }
}

// Bytes of the first line, and some of the numbers after it.
BOOST_AUTO_TEST_CASE(finds_damage_of_the_checkpoint) {
  const Case c("verner98", "600");
  c.stop_half_way();
  const std::string rows = c.folder.read("part.csv");
  const std::string whole = c.folder.read("part.csv.resume");
  const auto restore = [&](const std::string& checkpoint) {
    c.folder.write("part.csv", rows);
    c.folder.write("part.csv.resume", checkpoint);
  };
  const auto words_with = [&](const std::string& checkpoint) {
    restore(checkpoint);
    return c.first_words();
  };
  const std::size_t step = std::max<std::size_t>(1, whole.size() / 20);
  for (std::size_t at = 0; at < whole.size(); at += at < 60 ? 5 : step) {
    std::string damaged = whole;
    damaged[at] = damaged[at] == '1' ? '2' : '1';
    const std::string words = words_with(damaged);
    BOOST_TEST(is_told(words), at << ": " << words);
  }
  for (const std::size_t left : {std::size_t(0), whole.size() / 2, whole.size() - 1}) {
    BOOST_TEST(is_told(words_with(whole.substr(0, left))), left);
  }
  BOOST_TEST(!is_told(words_with(whole)));
  restore(whole);  // that run may have reached its end
  c.check(c.run("--resume"));
}

BOOST_AUTO_TEST_CASE(finds_rows_that_were_changed) {
  const Case c("verner98", "600");
  c.stop_half_way();
  const std::string rows = c.folder.read("part.csv");
  const std::string checkpoint = c.folder.read("part.csv.resume");
  const std::size_t last = c.checkpoint_bytes();
  for (std::size_t at = 0; at < last; at += 1 + last / 40) {
    std::string changed = rows;
    changed[at] = changed[at] == '1' ? '2' : '1';
    c.folder.write("part.csv", changed);
    c.folder.write("part.csv.resume", checkpoint);
    const std::string words = c.first_words();
    BOOST_TEST(is_told(words), at << ": " << words);
  }
}

// All inputs of the steps distinguish one run from another.
BOOST_AUTO_TEST_CASE(refuses_a_checkpoint_of_another_run) {
  const Case c("verner98", "600");
  c.stop_half_way();
  const std::string rows = c.folder.read("part.csv");
  const std::string checkpoint = c.folder.read("part.csv.resume");
  const auto told = [&](const std::string& options) {
    c.folder.write("part.csv", rows);
    c.folder.write("part.csv.resume", checkpoint);
    const std::string words = c.first_words(options);
    BOOST_TEST(words.find("is of another run") != std::string::npos, options << ": " << words);
  };
  told("--tolerance 1e-8");
  told("--t-end 601");
  told("--method taylor");
  std::string other = two_rods("verner98", "600");
  other.replace(other.find("output_step = 0.05"), 18, "output_step = 0.10");
  c.folder.write("scene.toml", other);
  told("");
}

BOOST_AUTO_TEST_CASE(two_runs_do_not_mix_their_rows) {
  const Case c("verner98", "600");
  const Outcome outcome =
      test::run("( " + simulate + " " + c.scene + " --csv " + c.csv + " & pid=$!; until test -s " +
                c.csv + "; do sleep 0.02; done; " + simulate + " " + c.scene + " --csv " + c.csv +
                "; status=$?; kill -KILL $pid; exit $status )");
  BOOST_TEST(outcome.status == 2);
  BOOST_TEST(outcome.err.find("another process is writing this file") != std::string::npos,
             outcome.err);
}

BOOST_AUTO_TEST_SUITE_END()
