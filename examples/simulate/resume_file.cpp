#include "resume_file.hpp"

#include <fmt/core.h>
#include <fmt/ostream.h>

#include <cstdlib>
#include <fstream>
#include <string>
#include <system_error>
#include <variant>

#include <dynamics/file/atomic_file.hpp>
#include <motor/error.hpp>

#include "../shared/text_of.hpp"

namespace {

/// Fowler, Noll and Vo's hash, FNV-1a.
class Hash {
 public:
  void add(const std::string& text) {
    for (const char c : text) {
      value_ = (value_ ^ static_cast<unsigned char>(c)) * 1099511628211U;
    }
  }
  void add(double x) { add(fmt::format("{:a};", x)); }
  [[nodiscard]] std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 14695981039346656037U;
};

}  // namespace

std::uint64_t identity(const std::filesystem::path& scene_file, const kreisel::SceneFile& scene) {
  Hash hash;
  hash.add(text_of(scene_file));
  for (const auto& link : scene.guide) {
    const auto* const table = std::get_if<kreisel::scene_guide::Table>(&link);
    if (table != nullptr) hash.add(text_of(table->file));
  }
  for (const double x : {scene.t_end, scene.tolerance, static_cast<double>(scene.method),
                         static_cast<double>(scene.reactions)}) {
    hash.add(x);
  }
  return hash.value();
}

ResumeFile::ResumeFile(const std::filesystem::path& csv, std::uint64_t run)
    : place_(csv.string() + ".resume"), run_(run) {}

std::optional<ResumeFile::Bookmark> ResumeFile::read() const {
  std::ifstream file(place_);
  std::string word;
  std::uint64_t run = 0;
  Bookmark bookmark;
  std::size_t count = 0;
  file >> word >> run >> bookmark.t >> bookmark.bytes >> count;
  if (!file || word != "kreisel" || run != run_) return std::nullopt;
  while (file >> word) bookmark.numbers.push_back(std::strtod(word.c_str(), nullptr));
  if (bookmark.numbers.size() != count) return std::nullopt;
  return bookmark;
}

void ResumeFile::write(const Bookmark& bookmark) const {
  try {
    kreisel::AtomicFile file(place_);
    fmt::print(file.stream(), "kreisel {} {:.17g} {} {}\n", run_, bookmark.t, bookmark.bytes,
               bookmark.numbers.size());
    for (const double x : bookmark.numbers) fmt::print(file.stream(), "{:a}\n", x);
    file.commit();
  } catch (const kreisel::Error&) {
    // As long as the rows can be written the run has no reason to end.
  }
}

void ResumeFile::remove() const {
  std::error_code ignored;  // what stays is overwritten by the next run
  std::filesystem::remove(place_, ignored);
}
