#include <boost/test/unit_test.hpp>

#include <filesystem>

#include <dynamics/file/atomic_file.hpp>

#include <support/scratch.hpp>

using kreisel::AtomicFile;
using kreisel::test::Scratch;

BOOST_AUTO_TEST_SUITE(atomic_file)

BOOST_AUTO_TEST_CASE(a_committed_file_replaces_the_old_one_whole) {
  const Scratch folder;
  const auto place = folder.write("result.csv", "old");
  AtomicFile file(place);
  file.stream() << "new";
  BOOST_TEST(folder.read("result.csv") == "old");
  file.commit();
  BOOST_TEST(folder.read("result.csv") == "new");
  BOOST_TEST(folder.size() == 1u);
}

BOOST_AUTO_TEST_CASE(a_file_given_up_leaves_nothing_behind) {
  const Scratch folder;
  const auto place = folder.write("result.csv", "old");
  {
    AtomicFile file(place);
    file.stream() << "half";
  }
  BOOST_TEST(folder.read("result.csv") == "old");
  BOOST_TEST(folder.size() == 1u);
}

BOOST_AUTO_TEST_CASE(a_folder_that_is_not_there_is_bad_input) {
  const Scratch folder;
  BOOST_CHECK_THROW(AtomicFile(folder.path() / "none" / "result.csv"), kreisel::InvalidInput);
}

// A full disk, as Linux plays it: every write to /dev/full fails.
BOOST_AUTO_TEST_CASE(a_full_disk_is_an_error_and_the_place_is_untouched) {
  const Scratch folder;
  const auto place = folder.write("result.csv", "old");
  std::filesystem::create_symlink("/dev/full", place.string() + ".part");
  {
    AtomicFile file(place);
    file.stream() << "new";
    BOOST_CHECK_THROW(file.commit(), kreisel::ComputationFailed);
  }
  BOOST_TEST(folder.read("result.csv") == "old");
}

BOOST_AUTO_TEST_SUITE_END()
