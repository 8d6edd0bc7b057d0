#include <boost/test/unit_test.hpp>

#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <dynamics/file/scene_file.hpp>

#include <support/scratch.hpp>

using namespace kreisel;
using test::Scratch;

namespace {

const std::string rest =
    "[[body]]\nname = \"a\"\nmass = 1\ninertia = [1, 1, 1]\njoint = { kind = \"fixed\" }\n"
    "[solve]\nt_end = 0.3\n";

const std::string plain = "t,qw,qx,qy,qz\n0,1,0,0,0\n0.1,1,0,0,0\n0.2,1,0,0,0\n0.3,1,0,0,0\n";

/// The motion of a guide with these keys and a log with this text.
MotionLog<> motion(const std::string& log, const std::string& keys = "") {
  const Scratch folder;
  folder.write("log.csv", log);
  const SceneFile scene =
      parse_scene("[guide]\nkind = \"table\"\nfile = \"log.csv\"\n" + keys + "\n" + rest,
                  folder.path() / "s.toml");
  return std::get<scene_guide::Table>(scene.guide.front()).log;
}

/// All reported mistakes, without the folder.
std::string mistakes(const std::string& log, const std::string& keys = "") {
  const Scratch folder;
  folder.write("log.csv", log);
  try {
    (void)parse_scene("[guide]\nkind = \"table\"\nfile = \"log.csv\"\n" + keys + "\n" + rest,
                      folder.path() / "s.toml");
    return "";
  } catch (const SceneMistakes& error) {
    std::string said = error.what();
    const std::string path = folder.path().string() + "/";
    for (std::size_t i = said.find(path); i != std::string::npos; i = said.find(path)) {
      said.erase(i, path.size());
    }
    return said;
  }
}

/// A row for each time stamp, with the same attitude.
std::string rows(const std::vector<std::string>& stamps, const std::string& attitude) {
  std::string text;
  for (const std::string& t : stamps) text += t + attitude + "\n";
  return text;
}

const std::vector<double> times{0, 0.1, 0.2, 0.3};

}  // namespace

BOOST_AUTO_TEST_SUITE(log_options)

BOOST_AUTO_TEST_CASE(each_key_reads_its_logs) {
  const std::vector<std::string> s{"0.0", "0.1", "0.2", "0.3"};
  const std::pair<std::string, std::string> cases[] = {
      {plain, ""},
      // TUM: blanks, w last, seconds since 1970
      {"# ground truth\n# timestamp tx ty tz qx qy qz qw\n" +
           rows({"1311868163.8697", "1311868163.9697", "1311868164.0697", "1311868164.1697"},
                " 1 2 3 0 0 0 1"),
       "time_zero = 1311868163.8697"},
      // EuRoC: nanoseconds since 1970
      {"#timestamp, p_x [m], p_y [m], p_z [m], q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z []\n" +
           rows({"1403715524900000001", "1403715525000000001", "1403715525100000001",
                 "1403715525200000001"},
                ",1,2,3,1,0,0,0"),
       "time_unit = \"ns\"\ntime_zero = 1403715524900000001\ncolumns = { t = \"#timestamp\", qw = "
       "\"q_RS_w []\", qx = \"q_RS_x []\", qy = \"q_RS_y []\", qz = \"q_RS_z []\" }"},
      // RepoIMU: two rows of headers
      {"Time;Vicon;;;;\r\ns;W;X;Y;Z;\r\n" + rows(s, ";1;0;0;0;\r"),
       "columns = { t = 1, qw = 2, qx = 3, qy = 4, qz = 5 }"},
      {"Time;Vicon;;;;\r\ns;W;X;Y;Z;\r\n" + rows(s, ";1;0;0;0;\r"),
       "columns = { t = \"Time\", qw = 2, qx = 3, qy = 4, qz = 5 }\nskip_after_header = 1"},
      // MicroStrain: a preamble, degrees or radians
      {"FILE_INFO\nStartTime,02/10/2017\n\nDATA_START\nGPS Week,GPS TOW,Roll [x800C],Pitch [x800C],"
       "Yaw [x800C]\n" +
           rows({"1969,137649.863", "1969,137649.963", "1969,137650.063", "1969,137650.163"},
                ",0,0,0"),
       "columns = { t = \"GPS TOW\", yaw = \"Yaw\", pitch = \"Pitch\", roll = \"Roll\" }\n"
       "time_zero = \"first\""},
      {"x,y\n" + plain, "skip = 1"},
      {rows(s, ",1,0,0,0"),
       "header = \"none\"\ncolumns = { t = 1, qw = 2, qx = 3, qy = 4, qz = 5 }"},
      {"t;qw;qx;qy;qz\n" + rows({"0,0", "0,1", "0,2", "0,3"}, ";1,0;0,0;0,0;0,0"),
       "decimal = \",\"\nseparator = \";\""},
      {"t\tqw\tqx\tqy\tqz\n" + rows(s, "\t1\t0\t0\t0"), "separator = \"tab\""},
      {"t qw qx qy qz\n" + rows(s, "  1 0 0 0"), "separator = \"blanks\""},
      {"t [ms],qw,qx,qy,qz\n" + rows({"5", "105", "205", "305"}, ",1,0,0,0"),
       "time_unit = \"ms\"\ntime_zero = 5"},
      {"t,qw,qx,qy,qz\n" + rows({"0", "0.1", "0.1", "0.2", "0.3"}, ",1,0,0,0"),
       "duplicates = \"mean\""},
      {"t,qw,qx,qy,qz\n" + rows({"-0.1", "0", "0.1", "0.2", "0.3", "0.4"}, ",1,0,0,0"),
       "window = [0, 0.3]"},
      {"t,yaw,pitch,roll\n" + rows(s, ",0,0,0"), "angles = \"deg\""},
      {plain, "longest_gap = \"any\""},
  };
  for (const auto& [log, keys] : cases) {
    BOOST_TEST_CONTEXT(keys << "\n" << log) {
      const MotionLog<> read = motion(log, keys);
      BOOST_TEST(read.times == times);
      BOOST_TEST(read.attitudes.back().w() == 1);
    }
  }
}

BOOST_AUTO_TEST_CASE(mistakes_in_keys_have_their_position) {
  const std::pair<std::string, std::string> cases[] = {
      {"colums = { t = 1 }", "s.toml:4:1: guide.colums: is no key here (did you mean 'columns'?)"},
      {"columns = { time = 1 }", "s.toml:4:13: guide.columns.time: is no key here"},
      {"columns = { t = 0 }",
       "s.toml:4:17: guide.columns.t: is no column: they are numbered from 1 to 100000"},
      {"columns = { t = 1.5 }",
       "s.toml:4:17: guide.columns.t: must be the name of a column, or its number from 1"},
      {"columns = { t = \"\" }", "s.toml:4:17: guide.columns.t: is empty"},
      {"columns = { qw = 1 }", "s.toml:4:11: guide.columns: names qw but not qx, qy, qz"},
      {"columns = { qw = 1, qx = 2, qy = 3, qz = 4, yaw = 5, pitch = 6, roll = 7 }",
       "s.toml:4:11: guide.columns: gives the attitude twice, by qw, qx, qy, qz and by yaw, pitch, "
       "roll"},
      {"angles = \"grad\"", "s.toml:4:10: guide.angles: 'grad' is none of 'rad' or 'deg'"},
      {"separator = \"|\"",
       "s.toml:4:13: guide.separator: '|' is none of 'auto', ',', ';', 'tab' or 'blanks'"},
      {"separator = \",\"\ndecimal = \",\"",
       "s.toml:5:11: guide.decimal: ',' is the separator too"},
      {"skip = -1", "s.toml:4:8: guide.skip: must be a whole number of lines, 0 to 1000000"},
      {"skip = 5", "log.csv: has no lines after the skipped ones"},
      {"header = \"none\"", "log.csv: header = \"none\" needs the number of every column"},
      {"header = \"none\"\nskip_after_header = 1",
       "s.toml:5:21: guide.skip_after_header: needs a header; without one give 'skip'"},
      {"time_unit = \"min\"",
       "s.toml:4:13: guide.time_unit: 'min' is none of 's', 'ms', 'us' or 'ns'"},
      {"time_zero = \"last\"",
       "s.toml:4:13: guide.time_zero: must be a number in time_unit, or \"first\""},
      {"time_zero = inf", "s.toml:4:13: guide.time_zero: is infinite, not a finite number"},
      {"window = [1, 1]", "s.toml:4:10: guide.window: must increase: [from, to]"},
      {"window = [1]", "s.toml:4:10: guide.window: must be 2 numbers, not 1"},
      {"longest_gap = 0", "s.toml:4:15: guide.longest_gap: 0 must be above 0"},
      {"longest_gap = \"none\"", "s.toml:4:15: guide.longest_gap: 'none' is none of 'any'"},
      {"duplicates = \"all\"",
       "s.toml:4:14: guide.duplicates: 'all' is none of 'error', 'first', 'last' or 'mean'"},
      {"time_stamps = \"regular\"",
       "s.toml:4:15: guide.time_stamps: 'regular' is none of 'auto' or 'exact'"},
  };
  for (const auto& [keys, reason] : cases) {
    const std::string found = mistakes(plain, keys);
    BOOST_TEST(found.find(reason) != std::string::npos, "wanted " << reason << "\nfound " << found);
  }
  // Mistakes in all keys are reported at once, before the log is read.
  BOOST_TEST(mistakes(plain, "skip = -1\nangles = 3\nsigma = 0") ==
             "s.toml:4:8: guide.skip: must be a whole number of lines, 0 to 1000000\n"
             "s.toml:5:10: guide.angles: must be a text, not a whole number");
}

BOOST_AUTO_TEST_CASE(a_log_outside_the_run_names_the_helpful_key) {
  const std::string at = "s.toml:3:8: guide.file: 'log.csv' ";
  const auto header = [](const std::string& name) { return name + ",qw,qx,qy,qz\n"; };
  BOOST_TEST(mistakes(header("t") + rows({"0.01", "0.11", "0.21", "0.31"}, ",1,0,0,0")) ==
             at + "begins at t = 0.01 s, the run at t = 0 s: give  time_zero = \"first\"");
  BOOST_TEST(mistakes(header("t") + rows({"0", "0.1", "0.2", "0.25"}, ",1,0,0,0")) ==
             at + "ends at t = 0.25 s, the run at t = 0.3 s: give  t_end = 0.25  in [solve]");
  BOOST_TEST(mistakes(header("#timestamp") + rows({"1403715524900000000", "1403715525000000000",
                                                   "1403715525100000000", "1403715525200000000"},
                                                  ",1,0,0,0"))
                 .ends_with(": give  time_unit = \"ns\"  and  time_zero = \"first\""));
  BOOST_TEST(mistakes(header("t") + rows({"123456", "133456", "143456", "153456"}, ",1,0,0,0"))
                 .ends_with(": give  time_unit = \"us\"  and  time_zero = \"first\""));
  BOOST_TEST(mistakes(plain + "0.4,1,0,0,0\n", "window = [0.1, 0.4]")
                 .ends_with("the window of 'log.csv' begins at t = 0.1 s, the run at t = 0 s: "
                            "increase  time_zero  by 0.1 s and move  window  back by as much"));
}

BOOST_AUTO_TEST_SUITE_END()
