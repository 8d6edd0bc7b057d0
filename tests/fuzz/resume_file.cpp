// Arbitrary bytes as the rows and the checkpoint of a run, with an empty line between: they are
// accepted or refused.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <programs/simulate/resume_file.hpp>
#include <string>
#include <unistd.h>

#include <motor/error.hpp>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  const std::string csv =
      std::filesystem::temp_directory_path() / ("fuzz" + std::to_string(getpid()));
  const std::size_t gap = std::min(text.find("\n\n"), size);
  std::ofstream(csv) << text.substr(0, std::min(gap + 1, size));
  std::ofstream(csv + ".resume") << text.substr(std::min(gap + 2, size));
  const ResumeFile file(csv, 7);
  std::string why_not;
  if (file.read(why_not).has_value() != why_not.empty()) std::abort();
  try {
    RowFile rows(csv, {"t", "rod.angle", "rod.rate"});
    double before = -1e300;
    for (const RowFile::Row& row : rows.read_rows()) {
      if (!(row.values.front() >= before) || row.values.size() != 3) std::abort();
      before = row.values.front();
    }
  } catch (const kreisel::InvalidInput&) {  // the expected refusal
  }
  file.remove();
  std::filesystem::remove(csv);
  return 0;
}
