#include <boost/test/unit_test.hpp>

#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <thread>
#include <unistd.h>

#include <dynamics/file/atomic_file.hpp>
#include <dynamics/file/text_file.hpp>

#include <support/scratch.hpp>

using kreisel::AtomicFile;
using kreisel::ComputationFailed;
using kreisel::InvalidInput;
using kreisel::read_text;
using kreisel::test::Scratch;

namespace {

void write(const std::filesystem::path& place, const std::string& text) {
  AtomicFile file(place);
  file.stream() << text;
  file.commit();
}

}  // namespace

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

BOOST_AUTO_TEST_CASE(a_long_text_is_written_whole) {
  const Scratch folder;
  const std::string text(300'001, 'x');
  write(folder.path() / "result.csv", text);
  BOOST_TEST((folder.read("result.csv") == text));
}

BOOST_AUTO_TEST_CASE(a_missing_folder_is_bad_input) {
  const Scratch folder;
  BOOST_CHECK_THROW(AtomicFile(folder.path() / "none" / "result.csv"), InvalidInput);
  BOOST_CHECK_THROW(AtomicFile{folder.path()}, InvalidInput);
}

// On Linux every write to /dev/full fails as on a full disk.
BOOST_AUTO_TEST_CASE(a_full_device_is_an_error) {
  BOOST_CHECK_THROW(write("/dev/full", "new"), ComputationFailed);
  BOOST_TEST(std::filesystem::is_character_file("/dev/full"));
}

BOOST_AUTO_TEST_CASE(a_full_disk_leaves_the_old_file) {
  const Scratch folder;
  const auto place = folder.write("result.csv", "old");
  std::signal(SIGXFSZ, SIG_IGN);
  const rlimit limit{1000, RLIM_INFINITY};
  setrlimit(RLIMIT_FSIZE, &limit);
  BOOST_CHECK_THROW(write(place, std::string(100'000, 'x')), ComputationFailed);
  const rlimit none{RLIM_INFINITY, RLIM_INFINITY};
  setrlimit(RLIMIT_FSIZE, &none);
  BOOST_TEST(folder.read("result.csv") == "old");
  BOOST_TEST(folder.size() == 1u);
}

// A device stays a device: /dev/null must stay one when root writes to it.
BOOST_AUTO_TEST_CASE(a_device_is_written_and_not_replaced) {
  write("/dev/null", "new");
  BOOST_TEST(std::filesystem::is_character_file("/dev/null"));
  BOOST_TEST(!std::filesystem::exists("/dev/null.part"));
}

BOOST_AUTO_TEST_CASE(a_pipe_gets_all_and_stays_a_pipe) {
  const Scratch folder;
  const auto pipe = folder.path() / "pipe";
  BOOST_TEST_REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  std::string found;
  std::thread reader([&] { found = read_text(pipe, 1000); });
  write(pipe, "rows");
  reader.join();
  BOOST_TEST(found == "rows");
  BOOST_TEST(std::filesystem::is_fifo(pipe));
}

BOOST_AUTO_TEST_CASE(a_link_stays_and_leads_to_the_new_file) {
  const Scratch folder;
  folder.write("result.csv", "old");
  std::filesystem::create_directory(folder.path() / "links");
  const auto link = folder.path() / "links" / "link";
  std::filesystem::create_symlink("../result.csv", link);
  write(link, "new");
  BOOST_TEST(std::filesystem::is_symlink(link));
  BOOST_TEST(folder.read("result.csv") == "new");
  const auto dangling = folder.path() / "dangling";
  std::filesystem::create_symlink("other.csv", dangling);
  write(dangling, "new");
  BOOST_TEST(folder.read("other.csv") == "new");
  std::filesystem::create_symlink("loop", folder.path() / "loop");
  BOOST_CHECK_THROW(AtomicFile(folder.path() / "loop"), InvalidInput);
}

// Writing through a link in place of the draft would overwrite another file.
BOOST_AUTO_TEST_CASE(a_draft_is_never_written_through_a_link) {
  const Scratch folder;
  folder.write("precious", "old");
  std::filesystem::create_symlink("precious", folder.path() / "result.csv.part");
  BOOST_CHECK_THROW(AtomicFile(folder.path() / "result.csv"), InvalidInput);
  BOOST_TEST(folder.read("precious") == "old");
}

BOOST_AUTO_TEST_CASE(a_draft_of_a_killed_process_is_removed) {
  const Scratch folder;
  folder.write("result.csv.part", "half of something longer");
  write(folder.path() / "result.csv", "new");
  BOOST_TEST(folder.read("result.csv") == "new");
  BOOST_TEST(folder.size() == 1u);
}

BOOST_AUTO_TEST_CASE(two_processes_do_not_share_a_draft) {
  const Scratch folder;
  AtomicFile file(folder.path() / "result.csv");
  BOOST_CHECK_THROW(AtomicFile(folder.path() / "result.csv"), InvalidInput);
  file.stream() << "first";
  file.commit();
  BOOST_TEST(folder.read("result.csv") == "first");
}

BOOST_AUTO_TEST_CASE(the_permissions_of_the_old_file_stay) {
  const Scratch folder;
  const auto place = folder.write("result.csv", "old");
  std::filesystem::permissions(place, std::filesystem::perms(0640));
  write(place, "new");
  BOOST_TEST((std::filesystem::status(place).permissions() == std::filesystem::perms(0640)));
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(text_file)

BOOST_AUTO_TEST_CASE(a_file_is_read_as_it_is) {
  const Scratch folder;
  std::string text(200'000, 'x');
  text[7] = '\0';
  text[8] = '\r';
  BOOST_TEST((read_text(folder.write("a", text), 200'000) == text));
  BOOST_TEST(read_text(folder.write("b", ""), 0).empty());
}

BOOST_AUTO_TEST_CASE(an_endless_file_is_refused) {
  BOOST_CHECK_THROW((void)read_text("/dev/zero", 1U << 20U), InvalidInput);
}

BOOST_AUTO_TEST_CASE(the_reason_is_named) {
  const Scratch folder;
  const auto says = [](const char* words) {
    return [words](const InvalidInput& e) {
      return std::string(e.what()).find(words) != std::string::npos;
    };
  };
  BOOST_CHECK_EXCEPTION((void)read_text(folder.path() / "none", 10), InvalidInput,
                        says("none: cannot be read: No such file or directory"));
  BOOST_CHECK_EXCEPTION((void)read_text(folder.path(), 10), InvalidInput,
                        says("cannot be read: Is a directory"));
}

BOOST_AUTO_TEST_SUITE_END()
