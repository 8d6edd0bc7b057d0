// The Cardan gyro and chains of 4 to 256 revolute joints: by kreisel, by hand, and by the installed
// libraries. Only libraries with the same results are timed.

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <fstream>
#include <functional>
#include <iomanip>
#include <iostream>
#include <limits>
#include <memory>
#include <random>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <dynamics/gimbal/cardan_gyro.hpp>
#include <dynamics/guide/resting.hpp>
#include <dynamics/guide/rotating.hpp>
#include <dynamics/tree/body_system.hpp>

#include "chains.hpp"
#include "hand_written.hpp"
#include "peer.hpp"

namespace scenes {

namespace {

using Eigen::VectorXd;
using kreisel::Guide;

constexpr double tolerance = 1e-9;            ///< relative, of answers
constexpr Triple base_turning{0.5, 0.25, 1};  ///< in rad/s
constexpr std::size_t repetitions = 9;
constexpr double repetition_time = 0.02;  ///< in s
constexpr double moment = 0.5;            ///< no moment of a constant-rate guide is special

/// y = (coordinates; rates) and, for inverse dynamics, accelerations.
struct Input {
  VectorXd y;
  VectorXd dv;

  [[nodiscard]] const double* q() const { return y.data(); }
  [[nodiscard]] const double* v() const { return y.data() + dv.size(); }
};

constexpr std::size_t input_count = 16;
using Inputs = std::array<Input, input_count>;

Inputs inputs(std::size_t n, const std::function<double(std::size_t)>& largest_rate) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto size = static_cast<Eigen::Index>(n);
  Inputs result;
  for (Input& input : result) {
    input = {VectorXd(2 * size), VectorXd(size)};
    for (double& x : input.y) x = uniform(random);
    for (double& x : input.dv) x = uniform(random);
    for (std::size_t k = 0; k < n; ++k)
      input.y[size + static_cast<Eigen::Index>(k)] *= largest_rate(k);
  }
  return result;
}

/// A contender that answers a question. It repeats the answer itself, so that nothing else is
/// between two answers.
struct Contender {
  std::string name;
  std::string how;
  std::function<void(const Input&, VectorXd&)> answer;
  std::function<void(const Inputs&, long)> answer_often;
};

template <class F>
Contender contender(std::string name, std::string how, F f) {
  const auto shared = std::make_shared<F>(std::move(f));
  return {std::move(name), std::move(how),
          [shared](const Input& input, VectorXd& out) { (*shared)(input, out); },
          [shared](const Inputs& all, long count) {
            F& work = *shared;
            VectorXd out(all[0].dv.size());
            for (long i = 0; i < count; ++i) {
              work(all[static_cast<std::size_t>(i) % input_count], out);
              asm volatile("" : : "r"(out.data()) : "memory");  // the answer counts as used
            }
          }};
}

/// The contenders for one task, the first of which is the reference, and the libraries that cannot
/// do it.
struct Work {
  std::string title;
  Inputs input;
  std::vector<Contender> contenders;
  std::vector<std::pair<std::string, std::string>> unable = {};
};

std::vector<Library> libraries() {
  return {
#ifdef SCENES_WITH_DART
      dart(),
#endif
#ifdef SCENES_WITH_KDL
      kdl(),
#endif
#ifdef SCENES_WITH_MUJOCO
      mujoco(),
#endif
#ifdef SCENES_WITH_SIMBODY
      simbody(),
#endif
  };
}

std::string missing() {
  std::string names;
#ifndef SCENES_WITH_DART
  names += " DART";
#endif
#ifndef SCENES_WITH_KDL
  names += " Orocos-KDL";
#endif
#ifndef SCENES_WITH_MUJOCO
  names += " MuJoCo";
#endif
#ifndef SCENES_WITH_SIMBODY
  names += " Simbody";
#endif
  return names;
}

enum class Question { forward, inverse };

void add_libraries(Work& work, const Chain& chain, Question question) {
  for (const Library& library : libraries()) {
    try {
      std::shared_ptr<Peer> peer = library.make(chain);
      if (question == Question::inverse) {
        work.contenders.push_back(
            contender(library.name, library.inverse, [peer](const Input& in, VectorXd& out) {
              peer->inverse(in.q(), in.v(), in.dv.data(), out.data());
            }));
      } else {
        work.contenders.push_back(contender(
            library.name, chain.moves() ? library.moving_base : library.forward,
            [peer](const Input& in, VectorXd& out) { peer->forward(in.q(), in.v(), out.data()); }));
      }
    } catch (const std::exception& error) {
      std::string why = error.what();
      std::replace(why.begin(), why.end(), '\n', ' ');  // a row is one line
      work.unable.emplace_back(library.name, why);
    }
  }
}

template <class M>
Contender body_system(const M& guide, const Chain& chain, Question question) {
  const kreisel::BodySystem<M> system(guide, described(chain),
                                      kreisel::UniformGravity<Guide>{vector(chain.gravity)});
  if (question == Question::inverse) {
    return contender("kreisel", "BodySystem::joint_forces",
                     [system, w = system.workspace()](const Input& in, VectorXd& out) mutable {
                       system.joint_forces(moment, in.y, in.dv, out, w);
                     });
  }
  return contender("kreisel", "BodySystem::accelerations",
                   [system, w = system.workspace()](const Input& in, VectorXd& out) mutable {
                     system.accelerations(moment, in.y, {}, out, w);
                   });
}

template <class M>
Contender cardan_gyro(const M& guide, const kreisel::CardanMoments& moments) {
  return contender(
      "kreisel", "CardanGyro::rates",
      [gyro = kreisel::CardanGyro<M>(moments, {}, guide)](const Input& in, VectorXd& out) {
        const typename kreisel::CardanGyro<M>::Vector y = in.y.template head<6>();
        const typename kreisel::CardanGyro<M>::Vector rates = gyro.rates(moment, y);
        for (int k = 0; k < 3; ++k) out[k] = rates[3 + k];
      });
}

Work gyro(bool moves) {
  const kreisel::CardanMoments moments{
      {.005, .005, .008}, {.002, .0015, .0028}, {.006, .0045, .005}};
  const HandWrittenGyro hand{.005, .008, .002, .0015, .0028, .006, .0045, .005};
  Chain chain;
  // The masses have no effect, but no library accepts a body without mass.
  chain.links = {{{1, 0, 0}, {}, 1, {}, {.006, .0045, .005}},
                 {{0, 1, 0}, {}, 1, {}, {.002, .0015, .0028}},
                 {{0, 0, 1}, {}, 1, {}, {.005, .005, .008}}};
  if (moves) chain.turning = base_turning;

  Work work{moves ? "turning at a constant rate" : "at rest",
            inputs(3, [](std::size_t k) { return k == 2 ? 100. : 5.; }),
            {}};
  if (moves) {
    const kreisel::RotatingFrame<> guide{.angular_velocity = vector(chain.turning)};
    work.contenders = {cardan_gyro(guide, moments), body_system(guide, chain, Question::forward),
                       contender("by hand", "Euler's equations",
                                 [hand, u = chain.turning](const Input& in, VectorXd& out) {
                                   hand.moving(u.data(), in.q(), out.data());
                                 })};
  } else {
    const kreisel::RestingFrame<> guide;
    work.contenders = {
        cardan_gyro(guide, moments), body_system(guide, chain, Question::forward),
        contender("by hand", "Lagrange's equations",
                  [hand](const Input& in, VectorXd& out) { hand.resting(in.q(), out.data()); })};
  }
  add_libraries(work, chain, Question::forward);
  return work;
}

template <bool moves>
Contender by_hand(const Chain& chain, Question question) {
  HandWrittenChain<moves> hand(chain);
  if (question == Question::inverse) {
    return contender("by hand", "Newton-Euler", [hand](const Input& in, VectorXd& out) mutable {
      hand.inverse(in.q(), in.v(), in.dv.data(), out.data());
    });
  }
  return contender("by hand", "articulated bodies", [hand](const Input& in, VectorXd& out) mutable {
    hand.forward(in.q(), in.v(), out.data());
  });
}

Work chain(std::size_t n, Question question, bool moves) {
  Chain bodies = random_chain(n);
  Work work{std::to_string(n) + " joints", inputs(n, [](std::size_t) { return 1.; }), {}};
  if (moves) {
    bodies.turning = base_turning;
    work.title += ", base turning";
    work.contenders = {body_system(
        kreisel::RotatingFrame<>{.angular_velocity = vector(base_turning)}, bodies, question)};
  } else {
    work.contenders = {body_system(kreisel::RestingFrame<>{}, bodies, question)};
  }
  work.contenders.push_back(moves ? by_hand<true>(bodies, question)
                                  : by_hand<false>(bodies, question));
  add_libraries(work, bodies, question);
  return work;
}

/// The greatest difference of two answers to one question, relative to the greatest number of the
/// first.
double difference(const Work& work, const Contender& other) {
  double worst = 0;
  VectorXd ours(work.input[0].dv.size());
  VectorXd theirs(ours.size());
  for (const Input& input : work.input) {
    work.contenders.front().answer(input, ours);
    theirs.setConstant(std::numeric_limits<double>::quiet_NaN());  // who answers nothing is wrong
    other.answer(input, theirs);
    const double off = (theirs - ours).cwiseAbs().maxCoeff<Eigen::PropagateNaN>() /
                       ours.cwiseAbs().maxCoeff<Eigen::PropagateNaN>();
    if (!(off <= worst)) worst = off;  // NaN stays
    if (std::isnan(worst)) break;
  }
  return worst;
}

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double time(const Contender& contender, const Inputs& input, long count) {
  const double begin = cpu_seconds();
  contender.answer_often(input, count);
  return cpu_seconds() - begin;
}

/// The number of calls that is enough for one repetition.
long count_for(const Contender& contender, const Inputs& input) {
  for (long count = 1;; count *= 2) {
    const double taken = time(contender, input, count);
    if (taken > repetition_time / 4) {
      return std::max(1L, std::lround(static_cast<double>(count) * repetition_time / taken));
    }
  }
}

struct Measured {
  double median;  ///< in ns
  double spread;  ///< between them lies the middle half
};

/// By turns, so that disturbances of the machine affect all of them.
std::vector<Measured> measure(const std::vector<Contender>& contenders, const Inputs& input) {
  std::vector<long> counts;
  for (const Contender& c : contenders) counts.push_back(count_for(c, input));
  std::vector<std::array<double, repetitions>> times(contenders.size());
  for (std::size_t r = 0; r < repetitions; ++r) {
    for (std::size_t i = 0; i < contenders.size(); ++i) {
      times[i][r] = 1e9 * time(contenders[i], input, counts[i]) / static_cast<double>(counts[i]);
    }
  }
  std::vector<Measured> result;
  for (auto& t : times) {
    std::sort(t.begin(), t.end());
    result.push_back({t[repetitions / 2], t[3 * repetitions / 4] - t[repetitions / 4]});
  }
  return result;
}

/// Three digits; no decimals if the number has more digits before the point.
std::string number(double x) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(x < 10 ? 2 : x < 100 ? 1 : 0) << x;
  return text.str();
}

/// Returns true if all answers were the same.
bool report(std::ostream& out, Work work) {
  bool all_agree = true;
  std::vector<double> off;
  for (std::size_t i = 0; i < work.contenders.size();) {
    const Contender& c = work.contenders[i];
    const double d = difference(work, c);
    if (d <= tolerance) {
      off.push_back(d);
      ++i;
      continue;
    }
    std::ostringstream why;
    why << "WRONG, not timed: differs by " << std::setprecision(1) << std::scientific << d;
    work.unable.emplace_back(c.name, why.str());
    work.contenders.erase(work.contenders.begin() + static_cast<std::ptrdiff_t>(i));
    all_agree = false;
  }
  const std::vector<Measured> times = measure(work.contenders, work.input);
  for (std::size_t i = 0; i < times.size(); ++i) {
    const Contender& c = work.contenders[i];
    out << "| " << work.title << " | " << c.name << " | " << number(times[i].median) << " | "
        << number(times[i].spread) << " | " << number(times[i].median / times[0].median) << " | ";
    if (i == 0) {
      out << '-';
    } else {
      out << std::scientific << std::setprecision(0) << off[i];
    }
    out << " | " << c.how << " |\n";
  }
  for (const auto& [name, why] : work.unable) {
    out << "| " << work.title << " | " << name << " | - | - | - | - | " << why << " |\n";
  }
  out << std::flush;
  return all_agree;
}

void head(std::ostream& out, const char* title, const char* what) {
  out << "\n## " << title << "\n\n| " << what
      << " | program | ns | spread | times kreisel | differs by | by |\n"
         "|---|---|---|---|---|---|---|\n";
}

bool run(std::ostream& out) {
  out << "# The same work by kreisel and by others\n\n"
      << "kreisel and the code by hand, built here: " SCENES_BUILD "\n\n";
  for (const Library& library : libraries())
    out << "- " << library.name << ' ' << library.version << '\n';
  if (!missing().empty()) out << "- not installed:" << missing() << '\n';
  out << "\nThe libraries are as installed. Debian builds them with -O2 for any amd64 and with "
         "their "
         "assertions. The code that calls them here is built for any amd64 too.\n\n"
         "CPU time of one evaluation in ns: median of "
      << repetitions
      << " repetitions, all programs in turn, and the width of their middle half. A library is "
         "timed only if its answers to "
      << input_count << " random inputs differ from kreisel's by at most " << tolerance
      << " of the greatest number in each.\n";

  bool agree = true;
  head(out, "Cardan gyro: accelerations of the three joints", "base");
  for (const bool moves : {false, true}) agree = report(out, gyro(moves)) && agree;
  for (const Question question : {Question::forward, Question::inverse}) {
    head(out,
         question == Question::forward ? "Chain of revolute joints: forward dynamics"
                                       : "Chain of revolute joints: inverse dynamics",
         "chain");
    for (const std::size_t n : {4U, 16U, 64U, 256U})
      agree = report(out, chain(n, question, false)) && agree;
    agree = report(out, chain(16, question, true)) && agree;
  }
  return agree;
}

}  // namespace

}  // namespace scenes

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  if (!arguments.empty() && !(arguments.size() == 2 && arguments[0] == "--out")) {
    std::cerr << "scenes [--out FILE]: kreisel's scenes beside those of other libraries\n";
    return EXIT_FAILURE;
  }
  std::ostringstream text;
  const bool agree = scenes::run(text);
  std::cout << text.str();
  if (!arguments.empty()) {
    std::ofstream file(arguments[1]);
    file << text.str();
    file.close();
    if (!file) {
      std::cerr << "scenes: cannot write " << arguments[1] << '\n';
      return EXIT_FAILURE;
    }
  }
  return agree ? EXIT_SUCCESS : EXIT_FAILURE;
}
