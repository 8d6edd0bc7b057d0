#include <boost/test/unit_test.hpp>

#include <cstddef>
#include <string>
#include <vector>

#include <dynamics/ensemble/part_files.hpp>

#include <support/scratch.hpp>

using kreisel::InvalidInput;
using kreisel::PartFiles;
using kreisel::test::Scratch;

namespace {

std::vector<std::string> rows(std::size_t count) {
  std::vector<std::string> result;
  for (std::size_t i = 0; i < count; ++i) result.push_back(std::to_string(i) + ",0.5");
  return result;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(part_files)

// 300 members: one whole part and 44 of the next.
BOOST_AUTO_TEST_CASE(list_the_missing_parts) {
  const Scratch folder;
  const PartFiles parts(folder.path() / "parts", "seed 1", 300);
  BOOST_TEST(parts.size() == 2U);
  BOOST_TEST(parts.range(1).first == 256U);
  BOOST_TEST(parts.range(1).count == 44U);
  BOOST_TEST(parts.missing() == (std::vector<std::size_t>{0, 1}));
  parts.write(1, rows(44));
  BOOST_TEST(parts.missing() == std::vector<std::size_t>{0});
  BOOST_TEST(parts.read(1) == rows(44));
}

BOOST_AUTO_TEST_CASE(are_refused_if_they_do_not_match) {
  const Scratch folder;
  const PartFiles parts(folder.path(), "seed 1", 300);
  BOOST_CHECK_THROW((void)parts.read(0), InvalidInput);
  parts.write(0, rows(255));
  BOOST_CHECK_THROW((void)parts.read(0), InvalidInput);
  parts.write(1, rows(44));
  BOOST_CHECK_THROW((void)PartFiles(folder.path(), "seed 2", 300).read(1), InvalidInput);
  BOOST_CHECK_THROW((void)PartFiles(folder.path(), "seed 1", 301).read(1), InvalidInput);
}

BOOST_AUTO_TEST_CASE(need_a_folder) {
  const Scratch folder;
  BOOST_CHECK_THROW(PartFiles(folder.write("file", "") / "parts", "seed 1", 1), InvalidInput);
}

BOOST_AUTO_TEST_SUITE_END()
