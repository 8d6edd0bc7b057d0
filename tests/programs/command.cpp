// The command kreisel: one name for all programs, their versions, pages of the manual and completion.

#include <boost/test/unit_test.hpp>

#include <regex>
#include <set>
#include <string>

#include <support/program.hpp>

using namespace kreisel;
using test::Outcome;

namespace {

const std::string kreisel_command = KREISEL_COMMAND;
const std::string packaging = KREISEL_PACKAGING;
const std::string commands[] = {"simulate", "analyze", "ensemble", "deviation"};

Outcome run(const std::string& arguments) { return test::run(kreisel_command + ' ' + arguments); }

/// The long options in the --help of a command.
std::set<std::string> options(const std::string& help) {
  static const std::regex line("\n *(?:-h,)?(--[a-z-]+)");
  std::set<std::string> result;
  for (std::sregex_iterator at(help.begin(), help.end(), line), end; at != end; ++at) {
    result.insert((*at)[1]);
  }
  return result;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(command)

BOOST_AUTO_TEST_CASE(every_program_prints_its_version) {
  const Outcome all = run("--version");
  BOOST_TEST(all.out == "kreisel " KREISEL_VERSION "\n");
  for (const std::string& name : commands) {
    const Outcome one = run(name + " --version");
    BOOST_TEST(one.status == 0);
    BOOST_TEST(one.out == "kreisel " + name + " " KREISEL_VERSION "\n");
  }
}

BOOST_AUTO_TEST_CASE(arguments_and_exit_status_are_passed_on) {
  const Outcome outcome = run("simulate 'no such file.toml'");
  BOOST_TEST(outcome.status == 2);
  BOOST_TEST(outcome.err.find("no such file.toml: cannot be read") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(an_unknown_command_is_refused) {
  for (const char* const word : {"", "simulat", "--csv"}) {
    const Outcome outcome = run(word);
    BOOST_TEST(outcome.status == 2, word);
    BOOST_TEST(outcome.err.find("give simulate, analyze, ensemble or deviation") !=
               std::string::npos);
    BOOST_TEST(outcome.out == "");
  }
}

BOOST_AUTO_TEST_CASE(a_link_finds_the_programs) {
  const test::Scratch folder;
  const std::string link = (folder.path() / "k").string();
  BOOST_TEST(
      test::run("ln -s " + kreisel_command + ' ' + link + " && " + link + " analyze --version")
          .status == 0);
}

BOOST_AUTO_TEST_CASE(manual_pages_have_every_option) {
  for (const std::string& name : commands) {
    const std::string help = run(name + " --help").out;
    const std::string page =
        test::run(kreisel_command + ' ' + name + " --help | awk -f " + packaging +
                  "/man.awk -v name=kreisel-" + name + " -v about=- -v version=1")
            .out;
    BOOST_TEST(options(help).size() > 5);
    for (std::string option : options(help)) {
      option = std::regex_replace(option, std::regex("-"), "\\-");
      BOOST_TEST(page.find(option) != std::string::npos, name << ' ' << option);
    }
    BOOST_TEST(page.starts_with(".TH KREISEL-"));
    BOOST_TEST(page.find(".SH SYNOPSIS\nkreisel " + name) != std::string::npos);
    BOOST_TEST(page.find(".B 130\ninterrupted") != std::string::npos);
  }
}

BOOST_AUTO_TEST_CASE(bash_completes_every_option) {
  for (const std::string& name : commands) {
    const Outcome outcome =
        test::run("bash -c 'source " + packaging + "/completion.bash; COMP_WORDS=(" +
                  kreisel_command + ' ' + name + " --); COMP_CWORD=2; _kreisel " + kreisel_command +
                  "; printf \"%s\\n\" \"\" \"${COMPREPLY[@]}\"'");
    BOOST_TEST(options(outcome.out) == options(run(name + " --help").out), outcome.out);
  }
}

BOOST_AUTO_TEST_SUITE_END()
