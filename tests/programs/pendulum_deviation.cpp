// The program from its user's side: command line in, numbers, files and exit status out.

#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <sys/wait.h>
#include <utility>

#include <dynamics/file/csv.hpp>

#include <support/hostile.hpp>
#include <support/json.hpp>
#include <support/program.hpp>
#include <support/scratch.hpp>

using kreisel::test::hostile_names;
using kreisel::test::lines;
using kreisel::test::Outcome;
using kreisel::test::Scratch;
using kreisel::test::word;
using nlohmann::json;

namespace {

/// Runs the program; the arguments are a shell's words.
Outcome run(const std::string& arguments) {
  return kreisel::test::run(std::string(KREISEL_PENDULUM_DEVIATION) + " " + arguments);
}

/// Runs it in the folder, to which relative names refer.
Outcome run_in(const Scratch& folder, const std::string& arguments) {
  return kreisel::test::run("cd '" + folder.path().string() + "' && HOME=. " +
                            KREISEL_PENDULUM_DEVIATION + " " + arguments);
}

std::string list_of(const std::string& name) {
  return "name,latitude,height,azimuth\n" + kreisel::csv_field(name) + ",10,0,90\nB,20,0,90\n";
}

bool has_control_characters(const std::string& text) {
  return std::any_of(text.begin(), text.end(),
                     [](char c) { return static_cast<unsigned char>(c) < 0x20 && c != '\n'; }) ||
         text.find("\u009b") != std::string::npos;
}

json answer(const std::string& arguments) {
  const Outcome outcome = run(arguments + " --json");
  BOOST_REQUIRE_MESSAGE(outcome.status == 0, arguments << ": " << outcome.err);
  return kreisel::test::parsed(outcome.out);
}

json references(const std::string& file) { return kreisel::test::reference_file(file).at("cases"); }

/// The command line of a reference case.
std::string options(const json& inputs) {
  const auto text = [&](const char* key) { return inputs.at(key).get<std::string>(); };
  return "--latitude " + text("latitude_deg") + " --azimuth " + text("alpha_deg") + " --gravity " +
         text("g_eff") + " --rotation-rate " + text("u") + " --mass " + text("m") + " --arm " +
         text("a") + " --theta-a " + text("ThA") + " --theta-b " + text("ThB") + " --theta-c " +
         text("ThC") + " --phi-a " + text("PhA") + " --phi-b " + text("PhB") + " --phi-c " +
         text("PhC") + " --amplitude 0.1";
}

/// Twelve digits, within the error that the program states; null if there is none.
void compare(const json& found, const json& wanted, const json& estimate, const std::string& what) {
  if (wanted.is_null()) {
    BOOST_TEST(found.is_null(), what);
    return;
  }
  const long double truth = std::stold(wanted.get<std::string>());
  const long double error = std::abs(found.get<double>() - truth);
  BOOST_TEST(error <= 1e-12L * std::abs(truth), what << ": " << found << " for " << wanted);
  if (!estimate.is_null()) {
    BOOST_TEST(error <= estimate.get<double>(),
               what << ": error " << error << " exceeds the estimate " << estimate);
  }
}

}  // namespace

BOOST_AUTO_TEST_SUITE(pendulum_deviation)

BOOST_AUTO_TEST_CASE(every_reference_has_twelve_digits) {
  for (const char* const file : {"pendulum.json", "pendulum-extra.json"}) {
    for (const json& reference : references(file)) {
      const json found = answer(options(reference.at("inputs")));
      const std::string name = reference.at("name").get<std::string>() + ", ";
      const json& error = found.at("error_estimate");
      const json& equilibrium = found.at("equilibrium");
      const json& period = found.at("period");
      compare(equilibrium.at("formula_24"), reference.at("phi0_eq24_rad"), {}, name + "(24)");
      compare(equilibrium.at("linear"), reference.at("phi0_linear_rad"), {}, name + "linear");
      compare(equilibrium.at("exact"), reference.at("phi0_exact_rad"), error.at("equilibrium"),
              name + "exact");
      compare(period.at("simple"), reference.at("T00_s"), {}, name + "T_00");
      compare(period.at("relative_change_formula_25"), reference.at("eq25_corrected_relative_term"),
              {}, name + "(25)");
      compare(period.at("linear"), reference.at("T_linear_s"), {}, name + "T linear");
      compare(period.at("exact_small"), reference.at("T_small_exact_s"), error.at("period"),
              name + "T small");
      compare(period.at("relative_change_exact"), reference.at("T_small_exact_rel_to_T00_minus_1"),
              error.at("relative_change_exact"), name + "change");
      compare(period.at("at_amplitude"), reference.at("finite_amplitude").at("period_s"),
              error.at("period_at_amplitude"), name + "T at amplitude");
      const json& all = reference.at("equilibria_rad");
      BOOST_REQUIRE_EQUAL(found.at("equilibria").size(), all.size());
    }
  }
}

BOOST_AUTO_TEST_CASE(papers_pendulum_has_thirteen_digits) {
  const Outcome outcome = run("--latitude 45 --azimuth 90 --reduced-length 0.5 --gravity 9.81");
  BOOST_TEST(outcome.status == 0);
  BOOST_TEST(outcome.err == "");
  BOOST_TEST(outcome.out.find("+1.355120825006e-10 rad = +2.795137344112e-05 arcsec") !=
             std::string::npos);
}

// Three ways to describe the same rod.
BOOST_AUTO_TEST_CASE(all_descriptions_of_a_rod_agree) {
  const std::string site = "--latitude 30 --azimuth 60 --gravity 9.8 ";
  const json a = answer(site + "--reduced-length 0.5");
  const json b = answer(site + "--rod 0.75");
  const json c = answer(site + "--arm 0.375 --theta-a 0 --theta-b 0.1875 --theta-c 0.1875");
  for (const char* const key : {"equilibrium", "period", "equilibria", "input"}) {
    BOOST_TEST(a.at(key) == b.at(key));
    BOOST_TEST(a.at(key) == c.at(key));
  }
}

BOOST_AUTO_TEST_CASE(a_list_of_sites_agrees_with_single_runs) {
  const Scratch folder;
  const auto list = folder.write("sites.csv",
                                 "name,latitude,height,azimuth\n"
                                 "\"Quito, Observatory\",-0.215,2818,90\nKew,51.469,5,45\n");
  const json many = answer("--sites '" + list.string() + "'");
  BOOST_REQUIRE_EQUAL(many.at("sites").size(), 2u);
  BOOST_TEST(many.at("sites")[0].at("name") == "Quito, Observatory");
  const json one = answer("--latitude 51.469 --height 5 --azimuth 45");
  BOOST_TEST(many.at("sites")[1].at("period") == one.at("period"));
  BOOST_TEST(many.at("sites")[1].at("equilibrium") == one.at("equilibrium"));
}

BOOST_AUTO_TEST_CASE(a_sweep_hits_both_its_ends) {
  const json sweep = answer("--sweep latitude=-90:90:0.1 --gravity 9.81");
  const json& sites = sweep.at("sites");
  BOOST_REQUIRE_EQUAL(sites.size(), 1801u);
  BOOST_TEST(sites.front().at("input").at("latitude") == -90.0);
  BOOST_TEST(sites.back().at("input").at("latitude") == 90.0);
  BOOST_TEST(sites.back().at("equilibrium").at("exact") == 0.0);
  BOOST_TEST(answer("--latitude 10 --sweep azimuth=90:0:-45").at("sites").size() == 3u);
}

// The gravity gradient changes the rod's period some 870 times as much as the rotation does.
BOOST_AUTO_TEST_CASE(the_gravity_gradient_is_optional) {
  const std::string site = "--latitude 0 --gravity 9.81 ";
  const double without = answer(site).at("period").at("relative_change_exact");
  const double with = answer(site + "--gravity-gradient").at("period").at("relative_change_exact");
  BOOST_TEST((with - without) / std::abs(without) == -870, boost::test_tools::tolerance(0.01));
}

BOOST_AUTO_TEST_CASE(a_csv_carries_seventeen_digits) {
  const Scratch folder;
  const auto file = folder.path() / "out.csv";
  const json found = answer("--sweep latitude=10:20:5 --csv '" + file.string() + "'");
  const auto table = kreisel::CsvTable::read(file, {"name", "latitude", "equilibrium_exact"});
  BOOST_REQUIRE_EQUAL(table.size(), 3u);
  for (std::size_t row = 0; row < 3; ++row) {
    BOOST_TEST(table.number(row, "equilibrium_exact") ==
               found.at("sites")[row].at("equilibrium").at("exact").get<double>());
  }
}

BOOST_AUTO_TEST_CASE(a_plot_is_a_picture) {
  const Scratch folder;
  for (const char* const name : {"a.svg", "a.png"}) {
    const Outcome outcome =
        run("--sweep latitude=-90:90:5 --plot '" + (folder.path() / name).string() + "'");
    BOOST_TEST(outcome.status == 0, outcome.err);
  }
  BOOST_TEST(folder.read("a.svg").find("<svg") != std::string::npos);
  BOOST_TEST(folder.read("a.png").substr(1, 3) == "PNG");
  BOOST_TEST(folder.size() == 2u);
}

// No field of a list exceeds the end of its line.
BOOST_AUTO_TEST_CASE(hostile_names_of_sites_are_only_shown) {
  for (const std::string& name : hostile_names()) {
    const Scratch folder;
    folder.write("s.csv", list_of(name));
    const Outcome table = run_in(folder, "--sites s.csv --plot p.svg --csv out.csv");
    BOOST_TEST(!std::filesystem::exists(folder.path() / "hit"), name);
    BOOST_TEST(!has_control_characters(table.out + table.err), name);
    if (name.find('\n') != std::string::npos) {
      BOOST_TEST(table.status == 2, name);
      BOOST_TEST(lines(table.err) == 1, table.err);
      continue;
    }
    BOOST_TEST(table.status == 0, name << ": " << table.err);
    BOOST_TEST(lines(table.out) == 4, name);
    BOOST_TEST(kreisel::CsvTable::read(folder.path() / "out.csv", {}).text(0, "name") == name);
    const std::string picture = folder.read("p.svg");
    BOOST_TEST(picture.find("</svg>") != std::string::npos, name);
    BOOST_TEST(picture.find("</script>") == std::string::npos, name);
    BOOST_TEST(picture.find('\x1b') == std::string::npos, name);
    const Outcome found = run_in(folder, "--sites s.csv --json");
    BOOST_TEST(kreisel::test::parsed(found.out).at("sites")[0].at("name") == name);
    BOOST_TEST(folder.size() == 3u, name);
  }
}

// A name with a slash belongs to another folder; all others are names of files here.
BOOST_AUTO_TEST_CASE(hostile_paths_are_names_of_files) {
  for (const std::string& name : hostile_names()) {
    if (name.find('/') != std::string::npos || name.size() > 200) continue;
    const Scratch folder;
    folder.write("s" + name, list_of("A"));
    const Outcome outcome = run_in(folder, "--sites=" + word("s" + name) + " --csv=" + word(name) +
                                               " --plot=" + word(name + ".svg"));
    BOOST_TEST(outcome.status == 0, name << ": " << outcome.err);
    BOOST_TEST(lines(folder.read(name)) == 3, name);
    BOOST_TEST(folder.read(name + ".svg").find("</svg>") != std::string::npos, name);
    for (const std::string& wrong :
         {"--sites=" + word("no " + name), "--sweep=" + word(name + "=0:1:1"),
          "--latitude=" + word(name), "--latitude 1 --plot=" + word(name)}) {
      const Outcome refused = run_in(folder, wrong);
      BOOST_TEST(refused.status == 2, wrong);
      BOOST_TEST(lines(refused.err) == 1, wrong << ": " << refused.err);
      BOOST_TEST(!has_control_characters(refused.err), wrong);
    }
    BOOST_TEST(folder.size() == 3u, name);
  }
}

BOOST_AUTO_TEST_CASE(an_endless_list_is_refused) {
  const Outcome outcome = run("--sites /dev/zero");
  BOOST_TEST(outcome.status == 2, outcome.err);
  BOOST_TEST(outcome.err.find("is larger than 64 MB") != std::string::npos, outcome.err);
}

BOOST_AUTO_TEST_CASE(bad_input_exits_with_2_and_writes_nothing) {
  const Scratch folder;
  const auto half = folder.write("half.csv", "name,latitude,height,azimuth\nA,10,0,90\nB,20,0\n");
  // A number does not end at a byte 0.
  const auto cut = folder.write(
      "cut.csv", std::string("name,latitude,height,azimuth\nA,45") + '\0' + "6,0,90\n");
  const auto beyond =
      folder.write("beyond.csv", "name,latitude,height,azimuth\nA,10,0,90\nB,95,0,90\n");
  const std::string out = " --csv '" + (folder.path() / "out.csv").string() + "'";
  const std::string theta = "--latitude 45 --arm 0.3 --theta-a 0.02 ";
  const std::pair<std::string, std::string> cases[] = {
      {"", "--latitude is missing"},
      {"--latitude 91", "latitude = 91"},
      {"--latitude nan", "--latitude = 'nan'"},
      {"--latitude inf", "--latitude = 'inf'"},
      {"--latitude 4x", "--latitude = '4x'"},
      {"--latitude", "--latitude"},
      {"--latitude 45 --colour red", "--colour"},
      {"--latitude 45 --gravity heavy", "--gravity = 'heavy'"},
      {"--latitude 45 --gravity -9.81", "gravity = -9.81"},
      {"--latitude 45 --mass 0", "mass = 0"},
      {"--latitude 45 --rod -1", "rod must be a length above 0 m"},
      {"--latitude 45 --rod 1 --reduced-length 0.5", "given twice"},
      {"--latitude 45 --amplitude 4", "amplitude = 4"},
      {theta + "--theta-b 0.21", "needs arm, theta a, theta b and theta c"},
      {theta + "--theta-b 0.21 --theta-c 0.5", "triangle inequality"},
      {theta + "--theta-b -0.21 --theta-c 0.2", "principal moments"},
      {"--sites '" + half.string() + "'", "half.csv:3: 3 fields"},
      {"--sites '" + beyond.string() + "'", "beyond.csv:3: latitude = 95"},
      {"--sites '" + cut.string() + "'", "cut.csv:2: latitude = '45"},
      {"--sites none.csv", "none.csv: cannot be read"},
      {"--sites '" + half.string() + "' --latitude 45", "of its own"},
      {"--sweep latitude=0:91:1", "latitude = 91"},
      {"--sweep latitude=0:10:-1", "does not lead"},
      {"--sweep latitude=0:10:0", "does not lead"},
      {"--sweep longitude=0:10:1", "none of"},
      {"--sweep latitude=0:1:9e-7", "more than a million steps"},
      {"--sweep latitude=0:10", "wanted QUANTITY"},
      {"--sweep azimuth=0:10:1", "--latitude is missing"},
      {"--sweep latitude=0:10:1 --plot x.pdf", "neither .svg nor .png"},
      {"--latitude 45 --plot x.svg", "--plot needs"},
  };
  for (const auto& [arguments, reason] : cases) {
    const Outcome outcome = run(arguments + out);
    BOOST_TEST(outcome.status == 2, arguments << " exits with " << outcome.status);
    BOOST_TEST(outcome.out == "");
    BOOST_TEST(outcome.err.starts_with("pendulum_deviation: "), arguments);
    BOOST_TEST(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1, outcome.err);
    BOOST_TEST(outcome.err.find(reason) != std::string::npos, arguments << ": " << outcome.err);
  }
  BOOST_TEST(folder.size() == 3u);  // the three lists, and no output
}

BOOST_AUTO_TEST_CASE(a_full_disk_exits_with_3) {
  const std::string command =
      std::string(KREISEL_PENDULUM_DEVIATION) + " --latitude 45 >/dev/full 2>/dev/null";
  BOOST_TEST(WEXITSTATUS(std::system(command.c_str())) == 3);
}

BOOST_AUTO_TEST_SUITE_END()
