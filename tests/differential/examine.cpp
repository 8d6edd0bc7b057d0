#include "examine.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <poll.h>
#include <stdexcept>
#include <sys/wait.h>
#include <unistd.h>

namespace differential {

namespace {

/// Lines of the protocol between the two processes: a letter, a blank, words.
void send(int pipe, char letter, std::string words) {
  std::replace(words.begin(), words.end(), '\n', ' ');
  const std::string line = std::string(1, letter) + ' ' + words + '\n';
  for (std::size_t done = 0; done < line.size();) {
    const ssize_t n = write(pipe, line.data() + done, line.size() - done);
    if (n <= 0) _exit(4);
    done += static_cast<std::size_t>(n);
  }
}

std::string note(const Scene& scene, const Answer& answer, const Answer& way,
                 const ReferenceMotion& reference) {
  if (!answer.answered) {
    return fmt::format("{}: {}", answer.asked,
                       answer.out_of_budget ? "out of budget" : answer.message);
  }
  std::string result =
      fmt::format("{} ({}): error {:.2g}{}, {:.3g} evaluations", answer.asked, answer.method,
                  answer.estimate, answer.kept ? "" : " (not kept)", answer.evaluations);
  if (const auto off = greatest_off(scene, answer, way, reference)) {
    result += fmt::format(", off by {:.2g} (known to {:.1g})", off->first, off->second);
  }
  return result;
}

[[noreturn]] void work(const Scene& scene, const Examination& how, int pipe) {
  const auto begin = [pipe](const std::string& part) { send(pipe, 'b', part); };
  const Answers answers = run(scene, how.methods, how.limits, how.folder, begin);
  ReferenceMotion reference;
  const bool answered = std::any_of(answers.by_method.begin(), answers.by_method.end(),
                                    [](const Answer& answer) { return answer.answered; });
  const bool failed =
      std::any_of(answers.by_method.begin(), answers.by_method.end(),
                  [](const Answer& answer) { return !answer.answered && !answer.out_of_budget; });
  if (answers.refused.empty() && (answered || failed)) {
    begin("the independent integrator");
    reference = integrate(scene, scene.times(), how.limits.work);
  }
  for (const Answer& answer : answers.by_method) {
    send(pipe, 'n', note(scene, answer, answers.way, reference));
  }
  for (const Fault& fault : judge(scene, answers, reference)) {
    send(pipe, 'k', fault.kind);
    send(pipe, 'd', fault.detail);
  }
  if (answered) send(pipe, 'a', "");
  if (reference.complete) send(pipe, 'r', "");
  send(pipe, 'e', "");
  _exit(0);
}

/// Reads a pipe until it is closed; false if that takes longer than the given seconds.
bool receive(int pipe, double seconds, std::string& text) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::duration<double>(seconds);
  char buffer[4096];
  while (true) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now());
    if (left.count() <= 0) return false;
    pollfd waiting{pipe, POLLIN, 0};
    if (poll(&waiting, 1, static_cast<int>(left.count())) <= 0) continue;
    const ssize_t n = read(pipe, buffer, sizeof buffer);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return true;
    text.append(buffer, static_cast<std::size_t>(n));
  }
}

/// Reads the lines; returns the name of the last part of the work.
std::string take(const std::string& text, Verdict& verdict) {
  std::string part = "the start";
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text.find('\n', at);
    const std::string words = text.substr(at + 2, end - at - 2);
    switch (text[at]) {
      case 'b': part = words; break;
      case 'k': verdict.faults.push_back({words, ""}); break;
      case 'd': verdict.faults.back().detail = words; break;
      case 'n': verdict.notes += words + "; "; break;
      case 'a': verdict.answered = true; break;
      case 'r': verdict.referenced = true; break;
      default: return {};
    }
    at = end == std::string::npos ? text.size() : end + 1;
  }
  return part;
}

}  // namespace

Verdict examine(const Scene& scene, const Examination& how) {
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error("a pipe cannot be made");
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("a process cannot be started");
  if (child == 0) {
    close(ends[0]);
    work(scene, how, ends[1]);
  }
  close(ends[1]);
  std::string text;
  const double patience =
      20 + how.limits.work / 2e7 + 5 * how.limits.seconds * static_cast<double>(how.methods.size());
  const bool came_to_an_end = receive(ends[0], patience, text);
  if (!came_to_an_end) kill(child, SIGKILL);
  int status = 0;
  waitpid(child, &status, 0);
  close(ends[0]);
  Verdict verdict;
  const std::string part = take(text, verdict);
  if (!came_to_an_end) {
    verdict.faults.push_back({"hangs: " + part, fmt::format("{} s", patience)});
  } else if (!part.empty()) {
    verdict.faults.push_back({"crashes: " + part, fmt::format("status {}", status)});
  }
  return verdict;
}

}  // namespace differential
