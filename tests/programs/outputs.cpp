// Outputs of the programs and their targets: pipes, devices, full disks, signals, hostile names.

#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <regex>
#include <sstream>
#include <string>
#include <sys/stat.h>

#include <support/hostile.hpp>
#include <support/json.hpp>
#include <support/program.hpp>

using namespace kreisel;
using nlohmann::json;
using test::hostile_names;
using test::lines;
using test::Outcome;
using test::Scratch;
using test::word;

namespace {

const std::string simulate = KREISEL_SIMULATE;
const std::string ensemble = KREISEL_ENSEMBLE;
const std::string analyze = KREISEL_ANALYZE;

std::string rod(const std::string& head, const std::string& name, const std::string& t_end) {
  return head + "[gravity]\nkind = \"uniform\"\nvector = [0, 0, -9.81]\n[[body]]\nname = " + name +
         "\njoint = { kind = \"revolute\", axis = [0, 1, 0] }\nmass = 1\ncentre = [0, 0, -1]\n"
         "inertia = [0.1, 0.1, 0.1]\ninitial = { angle = 0.5 }\n[solve]\nt_end = " +
         t_end + "\noutput_step = 0.01\nmethod = \"verner98\"\n";
}

/// A body that tumbles freely: its joint carries only rounding.
const std::string tumbling =
    "[[body]]\nname = \"body\"\njoint = { kind = \"free\" }\nmass = 1\ninertia = [1, 2, 3]\n"
    "initial = { angular_velocity = [0.001, 2, 0.001] }\n[solve]\nt_end = 20\n";

/// True if a line shows a number below 1e-13; lines about errors are excepted.
bool shows_rounding(const std::string& text) {
  static const std::regex rounding("[0-9]e-(1[3-9]|[2-9][0-9]|[1-9][0-9][0-9])");
  std::istringstream all(text);
  for (std::string line; std::getline(all, line);) {
    const bool of_errors = line.starts_with("error") || line.starts_with("constant");
    if (!of_errors && std::regex_search(line, rounding)) return true;
  }
  return false;
}

/// The run in a page of --plot.
json run_in(const std::string& page) {
  const std::string open = "id=\"run\">";
  const std::size_t begin = page.find(open) + open.size();
  return test::parsed(page.substr(begin, page.find("</script>", begin) - begin));
}

/// The text as a basic string of TOML.
std::string toml(const std::string& text) { return json(text).dump(); }

/// The rod's point and a sensor there, both of that name.
std::string with_sensor(std::string text, const std::string& name, const std::string& at) {
  text.insert(text.find("mass = "), "points = { " + toml(name) + " = [0, 0, 1] }\n");
  return text + "[[sensor]]\nname = " + toml(name) + "\nkind = \"point\"\nbody = " + toml(name) +
         "\nat = " + toml(at) + "\n";
}

}  // namespace

BOOST_AUTO_TEST_SUITE(outputs_of_programs)

BOOST_AUTO_TEST_CASE(hostile_names_and_titles_are_only_shown) {
  for (const std::string& name : hostile_names()) {
    const Scratch folder;
    const std::string plain = rod("title = " + toml(name) + "\n", toml(name), "0.1");
    const std::string file = folder.write("s.toml", with_sensor(plain, name, name)).string();
    const std::string here = "cd " + folder.path().string() + " && ";
    const Outcome run =
        test::run(here + simulate + " s.toml --csv out.csv --json --terms --plot pictures");
    BOOST_TEST(run.status == 0, name << ": " << run.err);
    const json result = test::parsed(run.out);
    BOOST_TEST(result.at("title") == name);
    BOOST_TEST(result.at("final").at("sensors").at(name).at("position").size() == 3U, name);
    BOOST_TEST(folder.read("pictures/coordinates.svg").find("</svg>") != std::string::npos, name);
    BOOST_TEST(lines(folder.read("out.csv")) >= 12, name);
    const Outcome text = test::run(here + simulate + " s.toml");
    BOOST_TEST(text.status == 0, text.err);
    BOOST_TEST(text.out.find('\x1b') == std::string::npos, name);
    BOOST_TEST(text.out.find("\nb: is no key") == std::string::npos, name);
    const Outcome equilibrium = test::run(here + analyze + " s.toml --plot pictures");
    BOOST_TEST(equilibrium.status == 0, name << ": " << equilibrium.err);
    const Outcome members =
        test::run(here + ensemble + " s.toml --members 2 --json --csv members.csv --vary " +
                  word("body[0].initial.angle=linear(0.1,0.2)"));
    BOOST_TEST(members.status == 0, name << ": " << members.err);
    BOOST_TEST(!std::filesystem::exists(folder.path() / "hit"), name);
    BOOST_TEST(folder.size() == 4U, name);
  }
}

// An invariant has the name of its body: no torque acts about the body's axis.
BOOST_AUTO_TEST_CASE(hostile_names_of_invariants_are_shown) {
  const std::string name = "a\nb: is no key\x1b]0;title\x07";
  const Scratch folder;
  const std::string file =
      folder
          .write("s.toml", "[[body]]\nname = " + toml(name) +
                               "\njoint = { kind = \"revolute\", axis = [0, 1, 0] }\nmass = 1\n"
                               "inertia = [1, 1, 1]\n[solve]\nt_end = 1\n")
          .string();
  const Outcome text = test::run(simulate + " " + file);
  BOOST_TEST(text.status == 0, text.err);
  BOOST_TEST(text.out.find("angular momentum about the axis of 'a\\nb") != std::string::npos);
  BOOST_TEST(text.out.find('\x1b') == std::string::npos);
}

// A name with a slash belongs to another folder; all others are names of files here.
BOOST_AUTO_TEST_CASE(hostile_paths_are_names_of_files) {
  for (const std::string& name : hostile_names()) {
    if (name.find('/') != std::string::npos || name.size() > 200) continue;
    const Scratch folder;
    folder.write("s.toml", rod("", "\"rod\"", "0.1"));
    std::filesystem::create_directory(folder.path() / "home");
    const std::string here =
        "cd " + folder.path().string() + " && HOME=" + (folder.path() / "home").string() + " ";
    const Outcome run = test::run(here + simulate + " s.toml --csv=" + word(name) +
                                  " --plot=" + word("plot " + name));
    BOOST_TEST(run.status == 0, name << ": " << run.err);
    BOOST_TEST(lines(folder.read(name)) == 12, name);
    BOOST_TEST(std::filesystem::exists(folder.path() / ("plot " + name) / "coordinates.svg"));
    std::filesystem::rename(folder.path() / "s.toml", folder.path() / ("s" + name));
    const Outcome again = test::run(here + simulate + " " + word("s" + name));
    BOOST_TEST(again.status == 0, name << ": " << again.err);
    const Outcome none = test::run(here + simulate + " " + word("no " + name));
    BOOST_TEST(none.status == 2, name);
    BOOST_TEST(lines(none.err) == 1, name << ": " << none.err);
    const Outcome varied = test::run(here + ensemble + " " + word("s" + name) +
                                     " --members 1 --vary " + word(name + "=linear(0,1)"));
    BOOST_TEST(varied.status == 2, name << ": " << varied.out);
    BOOST_TEST(lines(varied.err) == 1, name << ": " << varied.err);
    BOOST_TEST(!std::filesystem::exists(folder.path() / "hit"), name);
    BOOST_TEST(std::filesystem::is_empty(folder.path() / "home"), name);
  }
}

// A mistake is one line, whatever the file contains.
BOOST_AUTO_TEST_CASE(hostile_texts_stay_in_one_line) {
  for (const std::string& name : hostile_names()) {
    const Scratch folder;
    std::string text = rod("", "\"rod\"", "0.1");
    text.insert(text.find("mass = "), "parent = " + toml(name) + "\n");
    const std::string file = folder.write("s.toml", text).string();
    const std::string point = with_sensor(rod("", toml(name), "0.1"), name, "no " + name);
    const std::string pointless = folder.write("p.s.toml", point).string();
    const std::string at_point = test::run(simulate + " " + pointless).err;
    BOOST_TEST(lines(at_point) == 1, at_point);
    BOOST_TEST(at_point.size() < 1500U, at_point.size());
    for (const std::string& program : {simulate, analyze}) {
      const Outcome outcome = test::run(program + " " + file);
      BOOST_TEST(outcome.status == 2);
      BOOST_TEST(lines(outcome.err) == 1, outcome.err);
      BOOST_TEST(outcome.err.find("s.toml:") != std::string::npos, outcome.err);
      BOOST_TEST(outcome.err.size() < 1500U, outcome.err.size());
      BOOST_TEST(outcome.err.find('\x1b') == std::string::npos);
    }
  }
}

// JSON and CSV have all digits; the text shows 0, and pictures show a line at 0.
BOOST_AUTO_TEST_CASE(rounding_is_not_shown_as_physics) {
  const Scratch folder;
  const std::string file = folder.write("s.toml", tumbling).string();
  const std::string options = " --reactions --terms --csv " + (folder.path() / "out.csv").string();
  const Outcome full = test::run(simulate + " " + file + options + " --json");
  BOOST_TEST_REQUIRE(full.status == 0, full.err);
  const json final = test::parsed(full.out).at("final");
  for (const json& torque : {final.at("reactions").at("body").at("torque"),
                             final.at("terms").at("body").at("relative").at("torque")}) {
    double most = 0;
    for (const json& x : torque) most = std::max(most, std::abs(x.get<double>()));
    BOOST_TEST(most > 0);
    BOOST_TEST(most < 1e-13);
  }
  BOOST_TEST(shows_rounding(folder.read("out.csv")));
  const Outcome text =
      test::run(simulate + " " + file + options + " --plot " + folder.path().string());
  BOOST_TEST_REQUIRE(text.status == 0, text.err);
  BOOST_TEST(!shows_rounding(text.out), text.out);
  BOOST_TEST(text.out.find("(0, 0, 0)") != std::string::npos, text.out);
  BOOST_TEST(!shows_rounding(folder.read("reactions.svg")));
  const json run = run_in(folder.read("view.html"));
  for (const json& row : run.at("terms")) {
    for (const json& x : row) BOOST_TEST(x.get<double>() == 0);
  }
}

// The hanging top has components of its attitude of 7e-17 and less.
BOOST_AUTO_TEST_CASE(rounding_of_studies_is_not_shown) {
  const std::string command = analyze + " " + KREISEL_SCENES + "/heavy_top.toml";
  const Outcome text = test::run(command);
  BOOST_TEST_REQUIRE(text.status == 0, text.err);
  BOOST_TEST(!shows_rounding(text.out), text.out);
  BOOST_TEST(text.out.find("attitude (0, 1, 0, 0)") != std::string::npos, text.out);
  BOOST_TEST(shows_rounding(test::run(command + " --json").out));
}

BOOST_AUTO_TEST_CASE(a_pipe_gets_all_rows) {
  const Scratch folder;
  const std::string file = folder.write("s.toml", rod("", "\"rod\"", "2")).string();
  const std::string pipe = (folder.path() / "pipe").string();
  BOOST_TEST_REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  const Outcome whole =
      test::run("( cat " + pipe + " & timeout 60 " + simulate + " " + file + " --csv " + pipe +
                " >/dev/null; status=$?; wait; exit $status )");
  BOOST_TEST(whole.status == 0, whole.err);
  BOOST_TEST(lines(whole.out) == 202);
  BOOST_TEST(std::filesystem::is_fifo(pipe));
  const Outcome dash = test::run(simulate + " " + file + " --csv -");
  BOOST_TEST(dash.out == whole.out);
  BOOST_TEST(dash.err.find("verner98") != std::string::npos, dash.err);
  BOOST_TEST(test::run(simulate + " - <" + file).status == 0);
}

// 1e4 rows exceed the capacity of a pipe.
BOOST_AUTO_TEST_CASE(a_lost_reader_exits_with_3) {
  const Scratch folder;
  const std::string file = folder.write("s.toml", rod("", "\"rod\"", "100")).string();
  const std::string pipe = (folder.path() / "pipe").string();
  BOOST_TEST_REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  const Outcome outcome = test::run("( head -c 10 " + pipe + " >/dev/null & timeout 60 " +
                                    simulate + " " + file + " --csv " + pipe + " )");
  BOOST_TEST(outcome.status == 3, outcome.err);
  BOOST_TEST(outcome.err.find("Broken pipe") != std::string::npos, outcome.err);
}

// No reader at all, or one that stops reading: each wait ends.
BOOST_AUTO_TEST_CASE(a_signal_ends_a_wait_for_a_reader) {
  const Scratch folder;
  const std::string file = folder.write("s.toml", rod("", "\"rod\"", "100")).string();
  const std::string pipe = (folder.path() / "pipe").string();
  BOOST_TEST_REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  for (const std::string& reader : {std::string("true"), "sleep 30 <" + pipe}) {
    for (const auto& [signal, status] : {std::pair("INT", 130), std::pair("TERM", 143)}) {
      const Outcome outcome = test::run(
          "( " + reader + " & r=$!; timeout 60 env " + simulate + " " + file + " --csv " + pipe +
          " & pid=$!; sleep 2; kill -" + signal + " $pid; wait $pid; s=$?; kill $r; exit $s )");
      BOOST_TEST(outcome.status == status, reader << ": " << outcome.err);
      BOOST_TEST(outcome.err.find("interrupted after t = ") != std::string::npos, outcome.err);
    }
  }
}

BOOST_AUTO_TEST_CASE(devices_are_written_and_not_replaced) {
  const Scratch folder;
  const std::string file = folder.write("s.toml", rod("", "\"rod\"", "0.1")).string();
  const std::string vary = " --members 2 --vary 'body[0].initial.angle=linear(0.1,0.2)' --csv ";
  for (const std::string& command :
       {simulate + " " + file + " --csv ", ensemble + " " + file + vary}) {
    BOOST_TEST(test::run(command + "/dev/null").status == 0);
    BOOST_TEST(std::filesystem::is_character_file("/dev/null"));
    BOOST_TEST(test::run(command + "/dev/full").status == 3);
    BOOST_TEST(std::filesystem::is_character_file("/dev/full"));
  }
}

BOOST_AUTO_TEST_CASE(the_input_is_not_overwritten) {
  const Scratch folder;
  const std::string text = rod("", "\"rod\"", "0.1");
  const std::string file = folder.write("s.toml", text).string();
  std::filesystem::create_symlink("s.toml", folder.path() / "link");
  const std::string vary = " --members 2 --vary 'body[0].initial.angle=linear(0.1,0.2)' --csv ";
  for (const std::string& command :
       {simulate + " " + file + " --csv ", ensemble + " " + file + vary}) {
    for (const std::string& name : {file, (folder.path() / "link").string()}) {
      const Outcome outcome = test::run(command + name);
      BOOST_TEST(outcome.status == 2, outcome.err);
      BOOST_TEST(outcome.err.find("would be overwritten") != std::string::npos, outcome.err);
      BOOST_TEST(folder.read("s.toml") == text);
    }
  }
}

// Files limited to 8 kB: the page and the pictures are larger.
BOOST_AUTO_TEST_CASE(a_truncated_picture_exits_with_3) {
  const Scratch folder;
  const std::string file = folder.write("s.toml", rod("", "\"rod\"", "2")).string();
  for (const std::string& program : {simulate, analyze}) {
    const Outcome outcome = test::run("bash -c \"trap '' XFSZ; ulimit -f 8; " + program + " " +
                                      file + " --plot " + (folder.path() / "out").string() + "\"");
    BOOST_TEST(outcome.status == 3, outcome.err);
    BOOST_TEST(outcome.err.find("File too large") != std::string::npos, outcome.err);
  }
}

BOOST_AUTO_TEST_CASE(endless_input_is_refused) {
  for (const std::string& program : {simulate, analyze}) {
    const Outcome outcome = test::run("timeout 60 " + program + " /dev/zero");
    BOOST_TEST(outcome.status == 2, outcome.err);
    BOOST_TEST(outcome.err.find("is larger than 64 MB") != std::string::npos, outcome.err);
  }
}

BOOST_AUTO_TEST_SUITE_END()
