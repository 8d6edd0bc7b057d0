// Runs cases, each in a process of its own, with a progress bar.

#include "isolated.hpp"

#include <fmt/core.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <exception>
#include <poll.h>
#include <sstream>
#include <stdexcept>
#include <sys/wait.h>
#include <unistd.h>

namespace stability {

namespace {

volatile std::sig_atomic_t stopped = 0;

/// The first Ctrl-C ends the catalogue, a second one the program.
void stop(int signal) {
  stopped = 1;
  std::signal(signal, SIG_DFL);
}

using Clock = std::chrono::steady_clock;

/// A text without tabs and line breaks, for a line with tabs.
std::string flat(std::string text) {
  for (char& c : text) {
    if (c == '\t' || c == '\n') c = ' ';
  }
  return text;
}

std::vector<std::string> fields(const std::string& line) {
  std::vector<std::string> parts;
  std::istringstream in(line);
  for (std::string part; std::getline(in, part, '\t');) parts.push_back(part);
  return parts;
}

/// The parent's record of a running case.
struct Watch {
  Finding found;
  std::string variant;  ///< of the run that was begun last
  std::string method;
  bool running = false;
  double heard_at = 0;  ///< s the case had computed when it was last heard of

  void read(const std::string& line, double computed) {
    const std::vector<std::string> f = fields(line);
    heard_at = computed;
    // Not stod, which throws on denormal numbers.
    const auto number = [&f](std::size_t i) { return std::strtod(f.at(i).c_str(), nullptr); };
    if (f.at(0) == "begin") {
      variant = f.at(1);
      method = f.at(2);
      running = true;
    } else if (f.at(0) == "drift") {
      found.drift.push_back({f.at(1), number(2), number(3)});
    } else {
      found.rows.push_back({f.at(1), f.at(2), static_cast<Verdict>(std::stoi(f.at(3))), number(4),
                            number(5), number(6), number(7), number(8), number(9),
                            f.size() > 10 ? f[10] : ""});
      running = false;
    }
  }

  void failed(double seconds, const std::string& why) {
    Row row;
    row.variant = running ? variant : "after the last run";
    row.method = running ? method : "-";
    row.seconds = seconds;
    row.note = why;
    found.rows.push_back(row);
  }
};

[[noreturn]] void run_here(const Case& c, bool quick, int pipe) {
  std::signal(SIGINT, SIG_IGN);  // the parent decides
  int status = 0;
  try {
    c.run(Recorder(pipe, quick));
  } catch (const std::exception& error) {
    const std::string what = flat(error.what());
    if (dprintf(pipe, "begin\tthe case itself\t-\n") < 0) status = 1;
    Row row;
    row.variant = "the case itself";
    row.method = "-";
    row.note = "threw: " + what;
    Recorder(pipe, quick).add(row);
  }
  _exit(status);  // not exit(): what the parent has begun is not ours to end
}

/// CPU time of a process, without its waiting.
double cpu_seconds(pid_t process) {
  clockid_t clock{};
  timespec spent{};
  if (clock_getcpuclockid(process, &clock) != 0 || clock_gettime(clock, &spent) != 0) return 0;
  return double(spent.tv_sec) + 1e-9 * double(spent.tv_nsec);
}

Finding run_watched(const Case& c, bool quick) {
  Watch watch;
  watch.found.name = c.name;
  watch.found.extreme = c.extreme;
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error("no pipe for the case " + c.name);
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("no process for the case " + c.name);
  if (child == 0) {
    close(ends[0]);
    run_here(c, quick, ends[1]);
  }
  close(ends[1]);
  const Clock::time_point begin = Clock::now();
  const double limit = quick ? c.time_limit : 20 * c.time_limit;
  constexpr double patience = 20;  // for a machine that has more to do
  std::string text;
  bool open = true;
  bool late = false;
  Clock::time_point heard = begin;
  while (open && !stopped) {
    const double computed = cpu_seconds(child);
    late = computed - watch.heard_at > limit || seconds_since(heard) > patience * limit;
    if (late) break;
    pollfd wait{ends[0], POLLIN, 0};
    if (poll(&wait, 1, 200) <= 0) continue;
    char buffer[4096];
    const ssize_t got = ::read(ends[0], buffer, sizeof buffer);
    open = got > 0;
    if (open) text.append(buffer, std::size_t(got));
    for (std::size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n')) {
      watch.read(text.substr(0, at), computed);
      heard = Clock::now();
      text.erase(0, at + 1);
    }
  }
  close(ends[0]);
  if (open) kill(child, SIGKILL);
  int status = 0;
  waitpid(child, &status, 0);
  const double seconds = seconds_since(begin);
  if (late) watch.failed(seconds, fmt::format("no answer within {:.0f} s", limit));
  if (!open && WIFSIGNALED(status)) {
    watch.failed(seconds, fmt::format("crashed: {}", strsignal(WTERMSIG(status))));
  }
  return watch.found;
}

}  // namespace

bool interrupted() { return stopped != 0; }

void Recorder::send(const std::string& line) const {
  for (std::size_t done = 0; done < line.size();) {
    const ssize_t written = write(pipe_, line.data() + done, line.size() - done);
    if (written <= 0) _exit(1);  // the reader is gone
    done += std::size_t(written);
  }
}

void Recorder::begin(const std::string& variant, const std::string& method) const {
  send(fmt::format("begin\t{}\t{}\n", flat(variant), flat(method)));
}

void Recorder::add(const Row& r) const {
  send(fmt::format("row\t{}\t{}\t{}\t{:.17g}\t{:.17g}\t{:.17g}\t{:.17g}\t{:.17g}\t{:.17g}\t{}\n",
                   flat(r.variant), flat(r.method), int(r.verdict), r.error, r.estimate, r.drift,
                   r.steps, r.evaluations, r.seconds, flat(r.note)));
}

void Recorder::drift(const std::string& series, double t, double value) const {
  send(fmt::format("drift\t{}\t{:.17g}\t{:.17g}\n", flat(series), t, value));
}

std::vector<Finding> run_isolated(const std::vector<Case>& cases, bool quick) {
  std::signal(SIGINT, &stop);
  const bool shown = isatty(STDERR_FILENO) == 1;
  std::vector<Finding> findings;
  for (std::size_t i = 0; i < cases.size() && !stopped; ++i) {
    if (shown) {
      constexpr std::size_t width = 24;
      const std::size_t full = width * i / cases.size();
      fmt::print(stderr, "\r[{}{}] {:3} %  {:40.40}", std::string(full, '#'),
                 std::string(width - full, '.'), 100 * i / cases.size(), cases[i].name);
      std::fflush(stderr);
    }
    findings.push_back(run_watched(cases[i], quick));
  }
  if (shown) fmt::print(stderr, "\r{:79}\r", "");
  return findings;
}

}  // namespace stability
