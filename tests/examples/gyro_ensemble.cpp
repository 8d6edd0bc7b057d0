// gyro_ensemble as a user runs it: the same rows from any number of threads, parts and ranks.

#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include <support/program.hpp>

using namespace kreisel;

namespace {

// Three parts, the last of them not full and without whole packs.
const std::string members = " --members 603 --t-end 0.1 --seed 5 ";

test::Outcome run(const std::string& words) {
  return test::run(KREISEL_GYRO_ENSEMBLE + members + words);
}

std::string path(const test::Scratch& folder, const char* name) {
  return (folder.path() / name).string();
}

std::string csv_of_one_thread(const test::Scratch& folder) {
  const test::Outcome outcome = run("--threads 1 --csv " + path(folder, "one.csv"));
  BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
  return folder.read("one.csv");
}

}  // namespace

BOOST_AUTO_TEST_SUITE(gyro_ensemble)

BOOST_AUTO_TEST_CASE(rows_do_not_depend_on_threads_and_parts) {
  const test::Scratch folder;
  const std::string csv = csv_of_one_thread(folder);
  BOOST_TEST(std::count(csv.begin(), csv.end(), '\n') == 604);
  BOOST_TEST(run("--threads 2 --csv " + path(folder, "two.csv")).status == 0);
  BOOST_TEST((folder.read("two.csv") == csv));
  const std::string parts = "--parts " + path(folder, "parts") + " --csv ";
  BOOST_TEST(run(parts + path(folder, "parts.csv")).status == 0);
  BOOST_TEST((folder.read("parts.csv") == csv));
  BOOST_TEST(test::run(KREISEL_GYRO_ENSEMBLE " --members 603 --t-end 0.1 --seed 6 --csv " +
                       path(folder, "other.csv"))
                 .status == 0);
  BOOST_TEST((folder.read("other.csv") != csv));
}

// Existing parts are used without change: a row changed by hand appears in the result.
BOOST_AUTO_TEST_CASE(continues_from_existing_parts) {
  const test::Scratch folder;
  const std::string csv = csv_of_one_thread(folder);
  const std::string words =
      "--parts " + path(folder, "parts") + " --csv " + path(folder, "all.csv");
  BOOST_TEST(run(words).status == 0);
  const auto part = folder.path() / "parts" / "members-256.csv";
  std::filesystem::remove(part);
  const auto kept = folder.path() / "parts" / "members-512.csv";
  const auto time = std::filesystem::last_write_time(kept);
  const test::Outcome again = run(words);
  BOOST_TEST(again.status == 0);
  BOOST_TEST(again.err.find("2 of 3 parts are there") != std::string::npos);
  BOOST_TEST((folder.read("all.csv") == csv));
  BOOST_TEST((std::filesystem::last_write_time(kept) == time));
  const test::Outcome other = run("--tolerance 1e-6 " + words);
  BOOST_TEST(other.status == 2);
  BOOST_TEST(other.err.find("belongs to another ensemble") != std::string::npos);
  std::ofstream(part, std::ios::app) << "one row too many\n";
  BOOST_TEST(run(words).status == 2);
}

#ifdef KREISEL_GYRO_ENSEMBLE_MPI
BOOST_AUTO_TEST_CASE(rows_do_not_depend_on_ranks) {
  const test::Scratch folder;
  const std::string csv = csv_of_one_thread(folder);
  const test::Outcome ranks =
      test::run(KREISEL_TWO_RANKS " " KREISEL_GYRO_ENSEMBLE_MPI + members + "--threads 1 --parts " +
                path(folder, "parts") + " --csv " + path(folder, "ranks.csv"));
  BOOST_TEST(ranks.status == 0, ranks.err);
  BOOST_TEST((folder.read("ranks.csv") == csv));
  const test::Outcome alone = test::run(KREISEL_TWO_RANKS " " KREISEL_GYRO_ENSEMBLE_MPI + members);
  BOOST_TEST(alone.status == 2);
  BOOST_TEST(alone.err.find("--parts") != std::string::npos);
}

// Rank 1 is killed when the first part exists. The failure is reported, finished parts stay, and
// the same command computes the others.
BOOST_AUTO_TEST_CASE(survives_the_loss_of_a_rank) {
  const test::Scratch folder;
  const std::string many = " --members 1403 --t-end 4 --threads 1 --csv ";
  BOOST_TEST(test::run(KREISEL_GYRO_ENSEMBLE + many + path(folder, "one.csv")).status == 0);
  const std::string parts = path(folder, "parts");
  const std::string program =
      KREISEL_GYRO_ENSEMBLE_MPI + many + path(folder, "ranks.csv") + " --parts " + parts;
  const auto script = folder.write("rank.sh",
                                   "if [ \"$OMPI_COMM_WORLD_RANK\" = 0 ]; then\n"
                                   "  exec " +
                                       program +
                                       "\n"
                                       "fi\n" +
                                       program +
                                       " &\n"
                                       "until ls " +
                                       parts +
                                       "/*.csv; do sleep 0.01; done\n"
                                       "kill -9 $!\n"
                                       "wait $!\n");
  const test::Outcome killed = test::run(KREISEL_TWO_RANKS " sh " + script.string());
  BOOST_TEST(killed.status != 0);
  BOOST_TEST((killed.err + killed.out).find("exit") != std::string::npos, killed.err);
  BOOST_TEST(!std::filesystem::exists(folder.path() / "ranks.csv"));
  BOOST_TEST(std::filesystem::exists(parts));
  const test::Outcome again = test::run(KREISEL_TWO_RANKS " " + program);
  BOOST_TEST(again.status == 0, again.err);
  BOOST_TEST(again.err.find("of 6 parts are there") != std::string::npos, again.err);
  BOOST_TEST((folder.read("ranks.csv") == folder.read("one.csv")));
}
#endif

BOOST_AUTO_TEST_CASE(refuses_invalid_options) {
  BOOST_TEST(test::run(KREISEL_GYRO_ENSEMBLE " --members 0").status == 2);
  BOOST_TEST(test::run(KREISEL_GYRO_ENSEMBLE " --tolerance 1").status == 2);
  BOOST_TEST(test::run(KREISEL_GYRO_ENSEMBLE " --csv /nowhere/at/all --members 2").status == 2);
}

BOOST_AUTO_TEST_SUITE_END()
