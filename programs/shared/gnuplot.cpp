#include "gnuplot.hpp"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <spawn.h>
#include <sstream>
#include <sys/mman.h>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>
#include <utility>

#include <dynamics/file/atomic_file.hpp>
#include <dynamics/file/printable.hpp>
#include <motor/error.hpp>

#include "signals.hpp"

extern char** environ;  // NOLINT: how POSIX has it

namespace {

[[noreturn]] void fail(const std::string& why) {
  throw kreisel::ComputationFailed("--plot: gnuplot " + why);
}

/// A file descriptor, closed by its destructor.
class Descriptor {
 public:
  explicit Descriptor(int file) : file_(file) {
    if (file < 0) fail("does not start");
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() { close(); }

  [[nodiscard]] int get() const { return file_; }
  void close() {
    if (file_ >= 0) ::close(std::exchange(file_, -1));
  }

 private:
  int file_;
};

/// An unnamed file with the text.
int text_file(const std::string& text) {
  const int file = ::memfd_create("gnuplot", MFD_CLOEXEC);
  std::size_t done = 0;
  while (file >= 0 && done < text.size()) {
    const ssize_t count = ::write(file, text.data() + done, text.size() - done);
    if (count <= 0) fail("does not get its script");
    done += static_cast<std::size_t>(count);
  }
  if (file >= 0) ::lseek(file, 0, SEEK_SET);
  return file;
}

/// The rest of the file, up to its end or an error, such as a signal.
std::string rest_of(int file) {
  std::string text;
  std::array<char, 65536> part{};
  for (ssize_t n = 1; n > 0;) {
    n = ::read(file, part.data(), part.size());
    if (n > 0) text.append(part.data(), static_cast<std::size_t>(n));
  }
  return text;
}

/// The last line that is not blank.
std::string last_line(const std::string& text) {
  std::istringstream all(text);
  std::string last;
  for (std::string line; std::getline(all, line);) {
    const std::size_t first = line.find_first_not_of(" \t\r");
    if (first != std::string::npos) last = line.substr(first);
  }
  return kreisel::printable(last, 200);
}

/// The exit status of the child, which is terminated after a signal.
int wait_for(pid_t child) {
  if (signals::caught() != 0) ::kill(child, SIGTERM);
  int status = -1;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) ::kill(child, SIGTERM);
  return status;
}

/// The standard output of gnuplot for a script on its standard input.
std::string output_of(const std::string& script) {
  const Descriptor input(text_file(script));
  const Descriptor complaints(text_file(""));
  std::array<int, 2> ends{-1, -1};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) fail("does not start");
  const Descriptor picture(ends[0]);
  Descriptor output(ends[1]);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, input.get(), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, output.get(), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, complaints.get(), STDERR_FILENO);
  // -d: ignores the settings of the user
  std::array<std::string, 2> words{"gnuplot", "-d"};
  std::array<char*, 3> arguments{words[0].data(), words[1].data(), nullptr};
  pid_t child = 0;
  const int error =
      ::posix_spawnp(&child, words[0].c_str(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  output.close();
  if (error != 0) fail("does not start");
  std::string result = rest_of(picture.get());
  const int status = wait_for(child);
  if (signals::caught() != 0) fail("was interrupted");
  if (status != 0 || result.empty()) {
    ::lseek(complaints.get(), 0, SEEK_SET);
    fail("failed: " + last_line(rest_of(complaints.get())));
  }
  return result;
}

}  // namespace

namespace gnuplot {

bool is_installed() {
  const char* const path = std::getenv("PATH");
  std::istringstream folders(path != nullptr ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (std::filesystem::exists(std::filesystem::path(folder) / "gnuplot")) return true;
  }
  return false;
}

void require_installed() {
  if (!is_installed()) fail("is not installed");
}

void open_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw kreisel::InvalidInput("--plot " + folder.string() + ": " + error.message());
}

std::string terminal(bool svg, std::size_t height) {
  return svg ? fmt::format("set terminal svg size 800,{} font 'Helvetica,14' background 'white'\n",
                           height)
             : fmt::format(
                   "set terminal pngcairo size 1600,{} font 'Helvetica,11' fontscale 2 linewidth "
                   "2 pointscale 2\n",
                   2 * height);
}

void draw_picture(const std::filesystem::path& file, const std::string& script) {
  kreisel::AtomicFile picture(file);
  picture.stream() << output_of(script);
  picture.commit();
}

void draw(const std::filesystem::path& place, std::size_t height, const std::string& script) {
  for (const bool svg : {true, false}) {
    draw_picture(place.string() + (svg ? ".svg" : ".png"), terminal(svg, height) + script);
  }
  wrote(place.string() + ".svg and .png");
}

void wrote(const std::filesystem::path& file) {
  fmt::print(stderr, "wrote {}\n", kreisel::printable(file.string()));
}

}  // namespace gnuplot
