#include <boost/test/unit_test.hpp>

#include <filesystem>
#include <fstream>
#include <string>

#include <dynamics/file/csv.hpp>

#include <support/scratch.hpp>

using kreisel::CsvTable;
using kreisel::InvalidInput;
using kreisel::test::Scratch;

namespace {

/// The error message for a text and the numbers of its column x; empty if there is none.
std::string complaint(const std::string& text) {
  const Scratch folder;
  const auto path = folder.write("table.csv", text);
  try {
    const CsvTable table = CsvTable::read(path, {"name", "x"});
    for (std::size_t row = 0; row < table.size(); ++row) (void)table.number(row, "x");
    return "";
  } catch (const InvalidInput& error) {
    return std::string(error.what()).substr(folder.path().string().size() + 1);
  }
}

}  // namespace

BOOST_AUTO_TEST_SUITE(csv)

BOOST_AUTO_TEST_CASE(fields_are_read_correctly) {
  const Scratch folder;
  const auto path = folder.write("table.csv",
                                 "\xEF\xBB\xBF# a remark\r\n x , name\r\n\r\n 1.5, plain \r\n"
                                 "-2e-3,\"quoted, with \"\"quotes\"\"\"\r\n# 3,\n,\n");
  const CsvTable table = CsvTable::read(path, {"name", "x"});
  BOOST_TEST(table.size() == 3u);
  BOOST_TEST(table.number(0, "x") == 1.5);
  BOOST_TEST(table.text(0, "name") == "plain");
  BOOST_TEST(table.number(1, "x") == -2e-3);
  BOOST_TEST(table.text(1, "name") == "quoted, with \"quotes\"");
  BOOST_TEST(table.text(2, "name").empty());
  BOOST_TEST(table.has("x"));
  BOOST_TEST(!table.has("y"));
  BOOST_TEST(table.where(1) == path.string() + ":5");
}

BOOST_AUTO_TEST_CASE(written_fields_are_read_back) {
  for (const std::string text : {"plain", "a,b", "\"", "# no remark", "\"\"quoted\"\""}) {
    const Scratch folder;
    const auto path = folder.write("t.csv", "name,x\n" + kreisel::csv_field(text) + ",0\n");
    BOOST_TEST(CsvTable::read(path, {}).text(0, "name") == text);
  }
}

BOOST_AUTO_TEST_CASE(errors_name_their_line) {
  BOOST_TEST(complaint("name,x\na,1\n") == "");
  BOOST_TEST(complaint("") == "table.csv: no row that names the columns");
  BOOST_TEST(complaint("name,x\n") == "table.csv: no rows");
  BOOST_TEST(complaint("name,y\na,1\n") == "table.csv:1: no column 'x'");
  BOOST_TEST(complaint("name,x,x\na,1,2\n") == "table.csv:1: two columns 'x'");
  BOOST_TEST(complaint("name,x\na,1\nb\n") == "table.csv:3: 1 fields where the first row names 2");
  BOOST_TEST(complaint("name,x\n\n\"a,1\n") == "table.csv:3: a quote is not closed");
  BOOST_TEST(complaint("name,x\n\"a\"b,1\n") == "table.csv:2: text after a closing quote");
  for (const std::string bad : {"", "1,", "abc", "1.5m", "nan", "inf", "1e999", "0x10", "--1"}) {
    const std::string said = complaint("name,x\na," + bad + "\n");
    BOOST_TEST(said.starts_with("table.csv:2: "), "'" << bad << "' gives: " << said);
  }
}

BOOST_AUTO_TEST_CASE(a_folder_or_a_missing_file_cannot_be_read) {
  const Scratch folder;
  BOOST_CHECK_THROW((void)CsvTable::read(folder.path(), {}), InvalidInput);
  BOOST_CHECK_THROW((void)CsvTable::read(folder.path() / "none.csv", {}), InvalidInput);
}

BOOST_AUTO_TEST_SUITE_END()
