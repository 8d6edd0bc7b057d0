#include <boost/test/unit_test.hpp>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <numbers>
#include <string>
#include <sys/stat.h>
#include <utility>
#include <vector>

#include <dynamics/file/log_file.hpp>

#include <support/scratch.hpp>

using namespace kreisel;
using test::Scratch;

namespace {

const std::vector<LogRequest> value{
    {"value", {{LogQuantity::number, {"value"}, {{"torque"}, {"moment"}}}}, true}};
const std::vector<LogRequest> motion{
    {"attitude",
     {{LogQuantity::quaternion, {"qw", "qx", "qy", "qz"}, {}},
      {LogQuantity::angle, {"yaw", "pitch", "roll"}, {}}},
     true},
    {"position",
     {{LogQuantity::length, {"x", "y", "z"}, {{"tx", "ty", "tz"}, {"surge", "sway", "heave"}}}},
     false}};

Log read(const std::string& text, const LogOptions& options = {},
         const std::vector<LogRequest>& requests = value) {
  const Scratch folder;
  return read_log(folder.write("log.csv", text), requests, options);
}

/// The values of the log, row by row, t first.
std::vector<std::vector<double>> rows(const Log& log) {
  std::vector<std::vector<double>> result(log.size());
  for (const LogColumn& column : log.columns) {
    for (std::size_t i = 0; i < log.size(); ++i) result[i].push_back(column.values[i]);
  }
  return result;
}

using Rows = std::vector<std::vector<double>>;

/// The error message for a text, without the folder; empty if it is read.
std::string complaint(const std::string& text, const LogOptions& options = {},
                      const std::vector<LogRequest>& requests = value) {
  const Scratch folder;
  try {
    (void)read_log(folder.write("log.csv", text), requests, options);
    return "";
  } catch (const InvalidInput& error) {
    return std::string(error.what()).substr(folder.path().string().size() + 1);
  }
}

LogOptions by_number(std::size_t t, std::size_t x) {
  LogOptions options;
  options.columns = {{"t", t}, {"value", x}};
  return options;
}

/// Rows of a value at equal steps.
std::string steps(double from, double step, int count) {
  std::string text;
  for (int i = 0; i < count; ++i) text += std::to_string(from + i * step) + ",1\n";
  return text;
}

const Rows two{{0, 1.5}, {0.1, -2}};

}  // namespace

BOOST_AUTO_TEST_SUITE(log_file)

BOOST_AUTO_TEST_CASE(usual_spellings_need_no_option) {
  for (const std::string text : {
           "t,value\n0,1.5\n0.1,-2\n",                                 // plain
           "\xEF\xBB\xBFt,value\r\n0,1.5\r\n0.1,-2\r\n",               // spreadsheet
           "t;value\n0;1.5\n0.1;-2\n",                                 //
           "t\tvalue\n0\t1.5\n0.1\t-2\n",                              //
           "t value\n  0   1.5\n  0.1  -2\n",                          //
           "# t,value\n0,1.5\n0.1,-2\n",                               // numpy.savetxt
           "#t,value\n0,1.5\n0.1,-2\n",                                // EuRoC
           "%t,value\n0,1.5\n0.1,-2\n",                                // rostopic
           "# a log\n# t value\n0 1.5\n0.1 -2\n",                      // TUM
           "Time (s), Torque (N m)\n0.0,1.5\n+.1,-2.\n",               //
           "t [s],value [-]\n0,1.5\n0.1,-2\n",                         //
           "time, VALUE\n0,1.5\n\n# remark\n0.1,-2",                   //
           "Rate,100\nSTART\nName,t,value,\na,0,1.5,\nb,0.1,-2,\n",    // preamble
           "t,note,value\n0,\"a, \"\"b\"\"\",1.5\n\"0.1\",,\"-2\"\n",  //
           "t,value\n0e0,+1.5E+000\n1e-001,-20e-01\n",                 //
           "t,value,,\n0,1.5\n0.1,-2,\n",                              // empty at the end
           "t (s) value (N)\n0 1.5\n0.1 -2\n",                         // unit between blanks
       }) {
    BOOST_TEST_CONTEXT(text) { BOOST_TEST((rows(read(text)) == two)); }
  }
}

BOOST_AUTO_TEST_CASE(columns_are_given_by_name_or_number) {
  LogOptions names;
  names.columns = {{"t", "#stamp"}, {"value", "M_x [Nm]"}};
  BOOST_TEST((rows(read("#stamp, M_x [Nm], M_y [Nm]\n0,1.5,7\n0.1,-2,7\n", names)) == two));
  names.columns = {{"t", "STAMP"}, {"value", "m_x"}};
  BOOST_TEST((rows(read("#stamp, M_x [Nm], M_y [Nm]\n0,1.5,7\n0.1,-2,7\n", names)) == two));
  names.columns = {{"t", "stamp"}, {"value", std::size_t(3)}};
  BOOST_TEST((rows(read("stamp,M,M\n0,7,1.5\n0.1,7,-2\n", names)) == two));
  // The array of a program: names that differ only in brackets.
  names.columns = {{"t", "timestamp"}, {"value", "q[1]"}};
  BOOST_TEST((rows(read("timestamp,q[0],q[1]\n0,7,1.5\n0.1,7,-2\n", names)) == two));
  const std::string below_two_rows = "Time;IMU;;\r\ns;X;Y;Z\r\n0;7;1.5;8\r\n0.1;7;-2;8\r\n";
  BOOST_TEST((rows(read(below_two_rows, by_number(1, 3))) == two));
  LogOptions skipping = by_number(1, 3);
  skipping.skip = 2;
  skipping.header = false;
  BOOST_TEST((rows(read(below_two_rows, skipping)) == two));
  LogOptions units;
  units.skip_after_header = 1;
  BOOST_TEST((rows(read("t;value\ns;N m\n0;1.5\n0.1;-2\n", units)) == two));
  units = by_number(1, 2);
  units.skip_after_header = 1;
  BOOST_TEST((rows(read("t;value\n1;2\n0;1.5\n0.1;-2\n", units)) == two));
}

BOOST_AUTO_TEST_CASE(a_named_attitude_comes_without_a_position) {
  const std::string text = "t,w,x,y,z\n0,1,0,0,0\n";
  LogOptions options;
  options.columns = {{"qw", "w"}, {"qx", "x"}, {"qy", "y"}, {"qz", "z"}};
  const Log log = read(text, options, motion);
  BOOST_TEST(log.has("qw"));
  BOOST_TEST(!log.has("x"));
  BOOST_CHECK_THROW((void)log.column("x"), InvalidInput);
  options.columns = {{"t", "t"}};
  BOOST_TEST(read("t,qw,qx,qy,qz,x,y,z\n0,1,0,0,0,1,2,3\n", options, motion).has("x"));
}

BOOST_AUTO_TEST_CASE(a_declared_decimal_comma_is_read) {
  LogOptions german;
  german.decimal = ',';
  BOOST_TEST((rows(read("t;value\n0,000;1,5\n0,1;-20,0e-1\n", german)) == two));
  BOOST_TEST((rows(read("t value\n0,000 1,5\n0,1 -2,0\n", german)) == two));
  const std::string hint =
      " is a number with a decimal comma: give  decimal = \",\"  if all rows "
      "have it, else correct this one";
  BOOST_TEST(complaint("t;value\n0,5;1,5\n") == "log.csv:2: t = '0,5'" + hint);
  BOOST_TEST(complaint("0,5;1,5\n", by_number(1, 2)) == "log.csv:1: t = '0,5'" + hint);
  BOOST_TEST(complaint("t;value\n0.5;1.5\n1;-8,00E-05\n") ==
             "log.csv:3: value = '-8,00E-05'" + hint);
  BOOST_TEST(complaint("t;value\n0,5;1.5\n", german) ==
             "log.csv:2: value = '1.5' is a number with a decimal point: give  decimal = \".\"  if "
             "all rows have it, else correct this one");
}

BOOST_AUTO_TEST_CASE(nanoseconds_since_1970_keep_their_digits) {
  LogOptions options;
  options.time_unit = LogTimeUnit::ns;
  options.time_zero = "1403715524907143168";
  const std::string stamps =
      "timestamp,value\n1403715524907143168,1\n1403715524912143104,2\n1403715524917143040,3\n";
  const Rows exact{{0, 1}, {0.004999936, 2}, {0.009999872, 3}};
  BOOST_TEST((rows(read(stamps, options)) == exact));
  options.time_zero = "first";
  BOOST_TEST((rows(read(stamps, options)) == exact));
  options.time_unit = LogTimeUnit::s;
  BOOST_TEST((rows(read("t,value\n1.403715524907143168e9,1\n1403715524.912143104,2\n"
                        "140371552491.7143040e-2,3\n",
                        options)) == exact));
  options.time_unit = LogTimeUnit::us;
  options.time_zero = "-1e-1";
  BOOST_TEST((rows(read("t,value\n0.2,1\n", options)) == Rows{{0.3e-6, 1}}));
  options.time_zero = "1e-300";
  BOOST_TEST((rows(read("t,value\n1e20,1\n", options)) == Rows{{1e14, 1}}));
  // The double nearest to the written number, if nothing is subtracted.
  for (const std::string t : {"0.1", "1.000000000000000056e-01", "123456789.123456789", "4.9e-324",
                              "1.7976931348623157e308", "9007199254740993"}) {
    BOOST_TEST((rows(read("t,value\n" + t + ",1\n")) == Rows{{std::strtod(t.c_str(), nullptr), 1}}),
               t);
  }
}

BOOST_AUTO_TEST_CASE(units_in_the_header_are_not_ignored) {
  BOOST_TEST(complaint("t [ms],value\n0,1\n") ==
             "log.csv:1: column 't [ms]' for 't' is in ms: give  time_unit = \"ms\"  (or the unit "
             "that is right)");
  BOOST_TEST(complaint("#timestamp [ns],value\n0,1\n").ends_with("(or the unit that is right)"));
  LogOptions options;
  options.time_unit = LogTimeUnit::ms;
  BOOST_TEST((rows(read("t [ms],value\n0,1.5\n100,-2\n", options)) == two));

  const std::string angles = "t,yaw [deg],pitch [deg],roll [deg]\n0,90,-45,1\n";
  BOOST_TEST(complaint(angles, {}, motion) ==
             "log.csv:1: column 'yaw [deg]' for 'yaw' is in deg: give  angles = \"deg\"  (or "
             "\"rad\" if the header is wrong)");
  const std::vector<LogRequest> rates{
      {"rate", {{LogQuantity::angular_rate, {"wx"}, {}}, {LogQuantity::acceleration, {"ax"}, {}}}}};
  for (const std::string unit : {"deg/s", "dps", "\xC2\xB0/s", "\xB0/s"}) {
    BOOST_TEST(complaint("t,wx (" + unit + ")\n0,1\n", {}, rates).find("angles = \"deg\"") !=
               std::string::npos);
  }
  options = {};
  options.degrees = true;
  BOOST_TEST(read("t,wx [deg/s]\n0,180\n", options, rates).column("wx").values[0] ==
             std::numbers::pi);
  BOOST_TEST(complaint("t,wx [deg/h]\n0,1\n", options, rates).find("convert the file") !=
             std::string::npos);
  BOOST_TEST(complaint("t,ax [g]\n0,1\n", options, rates).find("is read in m/s^2") !=
             std::string::npos);
  BOOST_TEST(complaint("t,ax [m/s^2]\n0,1\n", options, rates) == "");
  // The unit may be in a line of its own.
  options = {};
  options.skip_after_header = 1;
  const std::string own_line = "Time yaw pitch roll\n(s) (deg) (deg) (deg)\n0 90 -45 1\n";
  BOOST_TEST(complaint(own_line, options, motion)
                 .starts_with("log.csv:1: column 'yaw' for 'yaw' is in deg: give  angles"));
  options = {};
  options.degrees = true;
  const double pi = std::numbers::pi;
  const Log log = read(angles, options, motion);
  BOOST_TEST((rows(log) == Rows{{0, 90 * (pi / 180), -45 * (pi / 180), pi / 180}}));
  options.degrees = false;
  BOOST_TEST(read(angles, options, motion).column("yaw").values[0] == 90);
  BOOST_TEST(complaint("t,qw,qx,qy,qz,x [mm],y [mm],z [mm]\n0,1,0,0,0,1,2,3\n", {}, motion) ==
             "log.csv:1: column 'x [mm]' for 'x' is in mm, and is read in m: name the right column "
             "in  columns, or convert the file");
  BOOST_TEST(complaint("t,qw,qx,qy,qz,x [m/s],y [m/s],z [m/s]\n0,1,0,0,0,1,2,3\n", {}, motion)
                 .find("is in m/s, and is read in m:") != std::string::npos);
}

// Units of scene files are known in headers, too, also at the end of a name.
BOOST_AUTO_TEST_CASE(all_units_in_the_header_are_known) {
  const std::vector<LogRequest> rates{{"rate", {{LogQuantity::angular_rate, {"wx"}, {}}}}};
  const std::vector<LogRequest> forces{
      {"force", {{LogQuantity::number, {"F"}, {}, detail::dimension::force}}}};
  const std::string angles = ",pitch,roll\n0,0,0,0\n";
  for (const auto& [text, requests] : std::vector<std::pair<std::string, std::vector<LogRequest>>>{
           {"t [min],wx\n0,1\n", rates},
           {"t [h],wx\n0,1\n", rates},
           {"t_ms,wx\n0,1\n", rates},
           {"t,wx [rpm]\n0,1\n", rates},
           {"t,wx [RPM]\n0,1\n", rates},
           {"t,wx [rev/s]\n0,1\n", rates},
           {"t,F [mN]\n0,1\n", forces},
           {"t,F [kN]\n0,1\n", forces},
           {"t,F [N m]\n0,1\n", forces},
           {"t,yaw [mrad]" + angles, motion},
           {"t,yaw [arcmin]" + angles, motion},
           {"t,yaw [gon]" + angles, motion},
           {"t,yaw_deg" + angles, motion},
           {"t,Yaw/deg" + angles, motion}}) {
    LogOptions options;
    const std::string header = text.substr(0, text.find('\n'));
    if (header.find("aw_") + 1 != 0 || header.find("aw/") + 1 != 0) {
      options.columns = {{"t", "t"},
                         {"yaw", header.substr(2, header.find(',', 2) - 2)},
                         {"pitch", "pitch"},
                         {"roll", "roll"}};
    }
    if (header.starts_with("t_ms")) options.columns = {{"t", "t_ms"}, {"wx", "wx"}};
    BOOST_TEST(complaint(text, options, requests).find(" is in ") != std::string::npos, header);
  }
  for (const char* const header : {"t [s],F [N]", "t,F [x]", "t,F [1]", "t,F"}) {
    const std::string found = complaint(header + std::string("\n0,1\n"), {}, forces);
    BOOST_TEST((found.empty() || header == std::string("t,F [1]")), header << found);
  }
}

BOOST_AUTO_TEST_CASE(a_column_is_taken_once) {
  LogOptions options;
  options.columns = {{"t", std::size_t(1)}, {"value", std::size_t(1)}};
  BOOST_TEST(complaint("t,value\n0,1\n", options).find("'t' and 'value' are the same column") !=
             std::string::npos);
}

BOOST_AUTO_TEST_CASE(a_wrong_separator_is_named) {
  LogOptions options;
  options.separator = ';';
  BOOST_TEST(complaint("t,value\n0,1\n", options).find("the line holds commas, but is not split") !=
             std::string::npos);
}

BOOST_AUTO_TEST_CASE(undeclared_degrees_are_detected) {
  const std::string text = "# Time, surge, sway, heave, roll, pitch, yaw\n0,14,0,0,0.49,4.95,0.3\n";
  BOOST_TEST(complaint(text, {}, motion) ==
             "log.csv:2: pitch = 4.95 is more than a right angle in radian: give  angles = \"deg\" "
             " (or \"rad\" if it is)");
  LogOptions options;
  options.degrees = false;
  BOOST_TEST(read(text, options, motion).column("pitch").values[0] == 4.95);
  BOOST_TEST(complaint("t,yaw,pitch [rad],roll\n0,0,4.95,0\n", {}, motion) == "");
}

BOOST_AUTO_TEST_CASE(headers_that_do_not_fit_are_refused) {
  BOOST_TEST(complaint("Time;M 1;M 2\n0;1;2\n") ==
             "log.csv:1: no column for value among 'Time', 'M 1', 'M 2': name the columns, or give "
             "their numbers from 1, for example  columns = { t = \"Time\", value = 2 }");
  BOOST_TEST(complaint("0;1;2\n1;2;3\n") ==
             "log.csv:1: no line names the columns: give their numbers from 1, for example  "
             "columns = { t = 1, value = 2 }");
  BOOST_TEST(
      complaint("#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [],"
                " q_RS_y [], q_RS_z []\n0,1,2,3,1,0,0,0\n",
                {}, motion)
          .ends_with("columns = { t = \"timestamp\", qw = \"q_RS_w []\", qx = \"q_RS_x []\", "
                     "qy = \"q_RS_y []\", qz = \"q_RS_z []\", x = \"p_RS_R_x [m]\", y = "
                     "\"p_RS_R_y [m]\", z = \"p_RS_R_z [m]\" }"));
  // ROS: a comment above rows that contain text.
  BOOST_TEST(complaint("%time,field.frame_id,field.moment\n1,imu,2\n")
                 .ends_with("columns = { t = \"time\", value = 2 }"));
  BOOST_TEST(complaint("Time,PtfmRoll,PtfmPitch,PtfmYaw\n0,1,2,3\n", {}, motion)
                 .ends_with("columns = { t = \"Time\", yaw = \"PtfmYaw\", pitch = \"PtfmPitch\", "
                            "roll = \"PtfmRoll\" }"));
  // Motion capture: names that occur twice are replaced by numbers.
  BOOST_TEST(complaint("Frame,Time (Seconds),QX,QY,QZ,QX\n0,0,0,0,0,1\n", {}, motion)
                 .ends_with("columns = { t = \"Time (Seconds)\", qw = 2, qx = 3, qy = \"QY\", qz = "
                            "\"QZ\" }"));
  // A name in another encoding than UTF-8 cannot be pasted.
  BOOST_TEST(complaint("Zeit,pitch \xB0,roll,yaw\n0,1,2,3\n", {}, motion)
                 .ends_with("among 'Zeit', 'pitch ?', 'roll', 'yaw': name the columns, or give "
                            "their numbers from 1, for example  columns = { t = \"Zeit\", yaw = "
                            "\"yaw\", pitch = 2, roll = \"roll\" }"));
  BOOST_TEST(complaint("t,value,value\n0,1,2\n") ==
             "log.csv:1: columns 2, 3 all fit 'value': give its number,  columns = { .., value = 2 "
             "}");
  LogOptions one_of_two;
  one_of_two.columns = {{"t", "t"}, {"value", "M"}};
  BOOST_TEST(complaint("t,M,M\n0,1,2\n", one_of_two)
                 .starts_with("log.csv:1: columns 2, 3 all fit 'value'"));
  BOOST_TEST(complaint("t,torque,moment\n0,1,2\n") ==
             "log.csv:1: the value may be torque or moment: name the columns,  columns = { .., "
             "value = \"torque\", .. }");
  BOOST_TEST(complaint("t,value\n3,0,1\n") ==
             "log.csv:1: the header names 2 columns, the row in line 2 has 3: correct the header, "
             "or give the columns by number with  skip = 1");
  BOOST_TEST(complaint("t;value\ns;N m\n0;1\n") ==
             "log.csv:2: the line below the header is not a row of numbers: give  "
             "skip_after_header = 1");
  LogOptions none = by_number(1, 2);
  none.header = false;
  BOOST_TEST(complaint("t;value\ns;N m\n0;1\n", none) ==
             "log.csv:1: is not a row of numbers: give  skip = 2");
  LogOptions half;
  half.header = false;
  BOOST_TEST(complaint("0;1\n", half) ==
             "log.csv: header = \"none\" needs the number of every column,  columns = { t = 1, .. "
             "}");
  BOOST_TEST(
      complaint("0;1\n1;2\n", by_number(1, 3)).starts_with("log.csv:1: column 3 for 'value'"));
  // A column of text where numbers are needed.
  BOOST_TEST(complaint("0,a\n1,b\n", by_number(1, 2)).starts_with("log.csv:1: value = 'a' is not"));
  // A row of text that contains a number.
  BOOST_TEST(complaint("7,a\n0,1\n", by_number(1, 2)) ==
             "log.csv:1: value = 'a' is not a finite number; if it is above the rows, give  skip = "
             "1");
  // The separator may be a semicolon or a comma.
  BOOST_TEST(complaint("0,5;1,0\n", by_number(1, 2)).find("decimal comma") != std::string::npos);
  // A position needs three coordinates.
  BOOST_TEST(complaint("t,qw,qx,qy,qz,x\n0,1,0,0,0,0\n", {}, motion)
                 .starts_with("log.csv:1: no column for y, z among"));
  LogOptions part;
  part.columns = {{"qw", std::size_t(2)}};
  BOOST_TEST(complaint("t,w\n0,1\n", part, motion) ==
             "log.csv: columns: qw, qx, qy, qz belong together, but 'qx' is not given");
}

BOOST_AUTO_TEST_CASE(broken_rows_are_named_by_line) {
  const std::string good = "t,value\n0,1\n";
  BOOST_TEST(complaint(good + "1,2,3\n") == "log.csv:3: 3 fields where line 2 has 2");
  BOOST_TEST(complaint(good + "1\n") == "log.csv:3: 1 fields where line 2 has 2");
  BOOST_TEST(complaint(good + "1,\"2\n") ==
             "log.csv:3: a quote is not closed, or text follows a closed one");
  BOOST_TEST(complaint(good + "1,\"2\"3\n") ==
             "log.csv:3: a quote is not closed, or text follows a closed one");
  BOOST_TEST(complaint(good + "1,\n") ==
             "log.csv:3: value is empty: leave such rows out by  window = [from, to]");
  BOOST_TEST(complaint(good + "1,nan\n") ==
             "log.csv:3: value = 'nan' is not a finite number: leave such rows out by  window = "
             "[from, to]");
  BOOST_TEST(complaint(good + "16:13:02,1\n") ==
             "log.csv:3: t = '16:13:02' is a time of the clock: convert the column to seconds, or "
             "name another");
  for (const std::string bad : {"1e999", "0x10", "--1", "+-1", "1.5m", "1 2", "+"}) {
    std::string text = good;
    text.append("1,").append(bad).append("\n");
    std::string expected = "log.csv:3: value = '";
    expected.append(bad).append("' is not a finite number");
    BOOST_TEST(complaint(text) == expected);
  }
  BOOST_TEST(complaint(good + "-1,2\n") ==
             "log.csv:3: t = -1 s is earlier than in line 2 (t = 0 s)");
  BOOST_TEST(complaint("") == "log.csv: is empty");
  LogOptions far;
  far.skip = 900000;
  BOOST_TEST(complaint("t,value\n", far) == "log.csv: has no lines after the skipped ones");
  BOOST_TEST(complaint(std::string(900001, '\n') + "t,value\n0,1\n", far) == "");
  BOOST_TEST(complaint(std::string(2U << 20U, '\n'), far) ==
             "log.csv: skip leads beyond the first megabyte, where rows must begin");
  BOOST_TEST(complaint("t,value\n") == "log.csv:1: the log has no rows below this line");
  BOOST_TEST(complaint(good + std::string("1,\0\n", 4)) ==
             "log.csv:3: the file is not text: the line holds a zero byte");
  BOOST_TEST(
      complaint(std::string("t,value\n\0", 9)).starts_with("log.csv:2: the file is not text"));
  BOOST_TEST(complaint("t,value\r0,1\r1,2\r").starts_with("log.csv:1: the lines end in CR alone"));
  BOOST_TEST(complaint("\xFF\xFEt,value\n").starts_with("log.csv:1: the text is in UTF-16"));
  BOOST_TEST(complaint(good + std::string(2U << 20U, ' ')) ==
             "log.csv:3: the line is longer than 1 MB");
}

BOOST_AUTO_TEST_CASE(quaternions_must_have_norm_one) {
  const std::string header = "t;qw;qx;qy;qz\n0.901;-0.99866;-6.5e-005;-0.00093;0.05182\n";
  BOOST_TEST(complaint(header + "0.907;0.026989;9.8e-007;2.7e-005;-0.0014243\n", {}, motion) ==
             "log.csv:3: the quaternion has norm 0.02702656992 and not 1 (t = 0.907 s): check  "
             "columns, or leave such rows out by  window = [from, to]");
  BOOST_TEST(complaint(header + "0.907;0.992;0;0;0\n0.91;-1.008;0;0;0\n", {}, motion) == "");
  for (const std::string w : {"0.985", "-1.015"}) {
    std::string text = header;
    text.append("0.907;").append(w).append(";0;0;0\n");
    BOOST_TEST(complaint(text, {}, motion).starts_with("log.csv:3: the quaternion has norm"));
  }
  LogOptions options;
  options.window = {0.91, 2};
  const std::string bad = "0.907;0.027;0;0;0\n0.913;0.99865;6e-005;0.00093;-0.051868\n";
  BOOST_TEST(read(header + bad, options, motion).lines == std::vector<std::size_t>{4});
}

BOOST_AUTO_TEST_CASE(equal_times_are_an_error_or_merged) {
  const std::string text = "t,value\n0,1\n1,2\n1,3\n1,7\n2,5\n";
  BOOST_TEST(complaint(text) ==
             "log.csv:4: t = 1 s is the same as in line 3 (t = 1 s): give  duplicates = \"first\"  "
             "(or \"last\" or \"mean\")");
  const auto merged = [&](LogDuplicates way) {
    LogOptions options;
    options.duplicates = way;
    return rows(read(text, options));
  };
  BOOST_TEST((merged(LogDuplicates::first) == Rows{{0, 1}, {1, 2}, {2, 5}}));
  BOOST_TEST((merged(LogDuplicates::last) == Rows{{0, 1}, {1, 7}, {2, 5}}));
  BOOST_TEST((merged(LogDuplicates::mean) == Rows{{0, 1}, {1, 4}, {2, 5}}));
  // q and -q are one attitude; so are angles that differ by a full turn.
  LogOptions mean;
  mean.duplicates = LogDuplicates::mean;
  BOOST_TEST((rows(read("t,qw,qx,qy,qz\n0,0.8,0.6,0,0\n0,-0.8,-0.6,0,0\n", mean, motion)) ==
              Rows{{0, 0.8, 0.6, 0, 0}}));
  mean.degrees = true;
  const Log angles = read("t,yaw,pitch,roll\n0,179,0,0\n0,-179,0,0\n", mean, motion);
  BOOST_TEST(std::abs(angles.column("yaw").values[0] - std::numbers::pi) < 1e-14);
}

BOOST_AUTO_TEST_CASE(gaps_name_both_lines_and_their_length) {
  const std::string text = "t,value\n" + steps(0, 0.01, 101) + steps(1.5, 0.01, 101);
  BOOST_TEST(complaint(text) ==
             "log.csv:103: a gap of 0.5 s between line 102 (t = 1 s) and line 103 (t = 1.5 s); "
             "allowed are 0.1 s, 10 times the median step of 0.01 s: give  longest_gap = 0.5  to "
             "interpolate across, or  window = [0, 1]  to read one side of it");
  LogOptions options;
  options.longest_gap = 0.5;
  BOOST_TEST(complaint(text, options) == "");
  options.longest_gap = std::numeric_limits<double>::infinity();
  BOOST_TEST(complaint(text, options) == "");
  options.longest_gap = 0.3;
  BOOST_TEST(complaint(text, options).find("allowed are 0.3 s: give") != std::string::npos);
  options = {};
  options.window = {0, 1};
  BOOST_TEST(read(text, options).size() == 101u);
  // A gap after the run does not matter; rows beyond the run are not read.
  options = {};
  options.run = {0, 0.9};
  BOOST_TEST(read(text, options).size() == 101u);
  options.run = {1.6, 1.7};
  const Log late = read(text, options);
  BOOST_TEST(late.column("t").values.front() == 1.5);
  options.run = {0.9, 1.6};
  BOOST_TEST(complaint(text, options).starts_with("log.csv:103: a gap of 0.5 s"));
}

BOOST_AUTO_TEST_CASE(rows_far_from_the_run_are_not_read) {
  const std::string text = "t,value\n" + steps(-10, 0.01, 1000) + steps(0, 0.01, 101) +
                           steps(1.01, 0.01, 1000) + "12,x\n";
  LogOptions options;
  options.run = {0, 1};
  const Log log = read(text, options);
  BOOST_TEST(log.size() >= 101u + 2 * 64u);
  BOOST_TEST(log.size() <= 101u + 3 * 64u);
  BOOST_TEST(log.column("t").values.back() == 1.64);
  BOOST_TEST(log.first_time == -10);
  BOOST_TEST(log.last_time == 12);
  BOOST_TEST(log.where(0).ends_with("log.csv:" + std::to_string(log.lines[0])));
  options.window = {20, 30};
  BOOST_TEST(complaint(text, options) ==
             "log.csv: no rows between 20 and 30 s, the window; the log goes from t = -10 s to 12 "
             "s");
}

BOOST_AUTO_TEST_CASE(spacing_of_the_written_numbers_is_reported) {
  const auto resolution = [](const std::string& a, const std::string& b) {
    return read("t,value\n0.000," + a + "\n0.010," + b + "\n").column("value").resolution;
  };
  BOOST_TEST(resolution("1.0000", "0.0008") == 1e-4);
  BOOST_TEST(resolution("0.99866", "-6.5197e-005") == 1e-5);  // five digits
  BOOST_TEST(resolution("0", "0") == 0.0);
  BOOST_TEST(resolution("0", "3") == 1.0);
  BOOST_TEST(resolution("0.00", "0.00") == 1e-2);
  BOOST_TEST(resolution("1.250e+01", "1.000e-03") == 1e-2);
  LogOptions options;
  options.time_unit = LogTimeUnit::ms;
  options.degrees = true;
  const Log log = read("t,yaw,pitch,roll\n0.1,0.1,0,0\n0.2,0.2,0,0\n", options, motion);
  BOOST_TEST(std::abs(log.column("t").resolution / 1e-4 - 1) < 1e-14);
  BOOST_TEST(std::abs(log.column("yaw").resolution / (0.1 * std::numbers::pi / 180) - 1) < 1e-14);
}

/// Samples k/rate, k from `first` on, with their times in so many decimals; none at `missing`.
std::string rounded_stamps(double rate, int decimals, int first, int count, int missing = -1) {
  std::string text = "t,value\n";
  for (int k = first; k < first + count; ++k) {
    char time[32];
    std::snprintf(time, sizeof time, "%.*f", decimals, k / rate);
    if (k != missing) text += std::string(time) + "," + std::to_string(k) + "\n";
  }
  return text;
}

// The first and the last stamp are exact here, so all times are.
BOOST_AUTO_TEST_CASE(rounded_stamps_of_a_regular_rate_are_replaced) {
  struct Case {
    double rate;
    int decimals;
  };
  for (const auto [rate, decimals] :
       {Case{30, 2}, Case{60, 3}, Case{300, 3}, Case{600, 3}, Case{1.0 / 3, 0}, Case{128, 3}}) {
    BOOST_TEST_CONTEXT(rate << " Hz, " << decimals << " decimals") {
      const int first = rate < 1 ? -3 : static_cast<int>(-rate);
      const int count = rate < 1 ? 61 : static_cast<int>(3 * rate) + 1;
      const Log log = read(rounded_stamps(rate, decimals, first, count, first + 7));
      BOOST_TEST(log.late == (rate < 1 ? 0 : 0.5 * std::pow(10, -decimals)));
      for (std::size_t i = 0; i < log.size(); ++i) {
        const double exact = log.column("value").values[i] / rate;
        BOOST_TEST(std::abs(log.column("t").values[i] - exact) < 1e-14);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(other_stamps_stay_as_they_are) {
  const std::string text = rounded_stamps(30, 2, 0, 19);
  BOOST_TEST(read(text).column("t").values.at(1) == 0.03);  // too few
  BOOST_TEST(read(text).late == 0);
  const std::string more = rounded_stamps(30, 2, 0, 31);
  BOOST_TEST(read(more).column("t").values.at(1) != 0.03);
  LogOptions exact;
  exact.time_stamps = LogTimeStamps::exact;
  BOOST_TEST(read(more, exact).column("t").values.at(1) == 0.03);
  BOOST_TEST(read(more, exact).late == 0);
  // One stamp is 1.7 of its last digit away from its regular time.
  std::string irregular = more;
  irregular.replace(irregular.find("\n0.33,"), 5, "\n0.35");
  BOOST_TEST(read(irregular).column("t").values.at(1) == 0.03);
  // Values that were taken at the stamps themselves.
  std::string sampled = "t,value\n";
  for (int k = 0; k <= 60; ++k) {
    char row[64];
    const double t = std::round(100.0 * k / 30) / 100;
    std::snprintf(row, sizeof row, "%.2f,%.17g\n", t, std::sin(t));
    sampled += row;
  }
  BOOST_TEST(read(sampled).column("t").values.at(1) == 0.03);
  BOOST_TEST(read(sampled).late == 0);
}

BOOST_AUTO_TEST_CASE(stamps_of_several_rows_are_coarse) {
  LogOptions options;
  for (const LogDuplicates rule :
       {LogDuplicates::first, LogDuplicates::last, LogDuplicates::mean}) {
    options.duplicates = rule;
    BOOST_TEST(read("t,value\n0,1\n1,2\n1,3\n2,4\n", options).late == 1);
    BOOST_TEST(read("t,value\n0.0,1\n0.1,2\n0.1,3\n0.2,4\n", options).late == 0.1);
    BOOST_TEST(read("t,value\n0,1\n1,2\n1,2\n2,4\n", options).late == 0);  // the same row again
  }
}

BOOST_AUTO_TEST_CASE(only_files_can_be_read) {
  const Scratch folder;
  const auto said = [](const std::filesystem::path& path) {
    try {
      (void)read_log(path, value);
      return std::string();
    } catch (const InvalidInput& error) {
      return std::string(error.what()).substr(path.string().size());
    }
  };
  BOOST_TEST(said(folder.path()) == ": cannot be read: it is a folder, not a file");
  BOOST_TEST(said(folder.path() / "none.csv") == ": cannot be read: there is no such file");
  BOOST_TEST(said("/dev/zero") == ": cannot be read: it is a device or a pipe, not a file");
  const std::filesystem::path pipe = folder.path() / "pipe";
  BOOST_REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  BOOST_TEST(said(pipe) == ": cannot be read: it is a device or a pipe, not a file");
}

BOOST_AUTO_TEST_SUITE_END()
