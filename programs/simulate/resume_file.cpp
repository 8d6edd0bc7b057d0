#include "resume_file.hpp"

#include <fmt/core.h>

#include <cstdlib>
#include <iterator>
#include <random>
#include <sstream>
#include <string>
#include <system_error>
#include <variant>

#include <dynamics/file/atomic_file.hpp>
#include <dynamics/file/text_file.hpp>
#include <dynamics/version.hpp>
#include <motor/error.hpp>

using namespace kreisel;

namespace {

constexpr std::size_t largest_checkpoint = std::size_t(1) << 30U;

/// The text with the hash of all its lines as its last line.
std::string with_sum(const std::string& text) {
  Hash hash;
  hash.add(text);
  return fmt::format("{}sum {}\n", text, hash.value());
}

/// The text before the last line; nothing if that line is not its hash.
std::optional<std::string> without_sum(const std::string& text) {
  const std::size_t sum = text.rfind("sum ");
  if (sum == std::string::npos || with_sum(text.substr(0, sum)) != text) return std::nullopt;
  return text.substr(0, sum);
}

/// Adds a table to the hash. A table that can be read only once, as from a pipe, gets a random
/// number.
void add_table(Hash& hash, const std::filesystem::path& file) {
  std::error_code error;
  if (std::filesystem::is_regular_file(file, error)) {
    hash.add(kreisel::read_text(file, largest_checkpoint));
  } else {
    hash.add(static_cast<double>(std::random_device()()));
  }
}

}  // namespace

std::uint64_t identity(std::string_view scene_text, const kreisel::SceneFile& scene) {
  Hash hash;
  hash.add(std::string_view(kreisel::version()));
  hash.add(scene_text);
  for (const auto& file : scene.log_files()) add_table(hash, file);
  for (const double x : {scene.t_end, scene.tolerance, static_cast<double>(scene.method),
                         static_cast<double>(scene.reactions)}) {
    hash.add(x);
  }
  for (const double t : scene.output_times) hash.add(t);
  return hash.value();
}

ResumeFile::ResumeFile(const std::filesystem::path& csv, std::uint64_t run)
    : place_(csv.string() + ".resume"), run_(run) {}

std::optional<Checkpoint> ResumeFile::read(std::string& why_not) const {
  std::error_code error;
  why_not = "is missing";
  if (!std::filesystem::is_regular_file(place_, error)) return std::nullopt;
  why_not = "is damaged";
  const auto text = without_sum(kreisel::read_text(place_, largest_checkpoint));
  if (!text) return std::nullopt;
  std::istringstream words(*text);
  std::string word;
  std::string version;
  Checkpoint checkpoint;
  std::uint64_t rows = 0;
  std::uint64_t run = 0;
  std::size_t count = 0;
  words >> word >> version >> checkpoint.t >> checkpoint.begin >> checkpoint.row.bytes >> rows >>
      run >> count;
  if (!words || word != "kreisel") return std::nullopt;
  while (words >> word) checkpoint.numbers.push_back(std::strtod(word.c_str(), nullptr));
  if (checkpoint.numbers.size() != count) return std::nullopt;
  checkpoint.row.hash = Hash(rows);
  why_not = version == kreisel::version()
                ? "is of another run: scene, table, t_end, tolerance, method, output times or "
                  "reactions differ"
                : "is of version " + version + " of the program";
  if (run != run_) return std::nullopt;
  why_not.clear();
  return checkpoint;
}

void ResumeFile::write(const Checkpoint& checkpoint) const {
  const auto& [begin, t, row, numbers] = checkpoint;
  std::string text = fmt::format("kreisel {} {:.17g} {:.17g} {} {} {} {}\n", kreisel::version(), t,
                                 begin, row.bytes, row.hash.value(), run_, numbers.size());
  for (const double x : numbers) fmt::format_to(std::back_inserter(text), "{:a}\n", x);
  try {
    kreisel::AtomicFile file(place_);
    file.stream() << with_sum(text);
    file.commit();
  } catch (const kreisel::Error&) {
    // The run continues as long as the rows can be written.
  }
}

void ResumeFile::remove() const {
  std::error_code ignored;  // a file that remains is overwritten by the next run
  std::filesystem::remove(place_, ignored);
}
