#include "request.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <sstream>

#include <motor/error.hpp>

#include "../shared/command_line.hpp"
#include "../shared/exit_status.hpp"
#include "../shared/scene_options.hpp"

using namespace kreisel;
using namespace kreisel::scene_analysis;

namespace {

/// The ends and the number of a range FROM:TO:N.
struct Range {
  double from;
  double to;
  int count;

  /// option, example : for messages
  Range(const std::string& option, const std::string& text, const char* example) {
    const auto refuse = [&](const std::string& why) {
      return InvalidInput(fmt::format("{} {}: {}", option, text, why));
    };
    const std::size_t first = text.find(':');
    const std::size_t second = text.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) {
      throw refuse(fmt::format("wanted FROM:TO:N, as {}", example));
    }
    from = kreisel::finite_number(option + " from", text.substr(0, first));
    to = kreisel::finite_number(option + " to", text.substr(first + 1, second - first - 1));
    const double n = kreisel::finite_number(option + " n", text.substr(second + 1));
    if (!(n >= 2 && n <= 100000) || n != std::floor(n)) {
      throw refuse("N is no whole number from 2 to 100000");
    }
    if (from == to) throw refuse("FROM and TO are the same");
    count = static_cast<int>(n);
    if (!std::isfinite((to - from) * count)) throw refuse("FROM and TO lie too far apart");
  }
};

/// The speeds of "100:3000:30": first, last and number.
std::vector<double> speeds(const std::string& text) {
  const Range range("--speeds", text, "100:3000:30");
  std::vector<double> result(static_cast<std::size_t>(range.count));
  for (int i = 0; i < range.count; ++i) {
    result[static_cast<std::size_t>(i)] =
        range.from + (range.to - range.from) * i / (range.count - 1);
  }
  return result;
}

/// The frequencies of "0.1:100:200", equally spaced on a logarithmic scale.
std::vector<double> frequencies(const std::string& text) {
  const Range range("--frequencies", text, "0.1:100:200");
  if (!(range.from > 0 && range.to > range.from)) {
    throw InvalidInput("--frequencies " + text + ": FROM must be above 0 and below TO");
  }
  std::vector<double> result(static_cast<std::size_t>(range.count));
  const double ratio = std::log(range.to / range.from);
  for (int i = 0; i < range.count; ++i) {
    result[static_cast<std::size_t>(i)] = range.from * std::exp(ratio * i / (range.count - 1));
  }
  result.back() = range.to;
  if (std::adjacent_find(result.begin(), result.end(), std::greater_equal<>()) != result.end()) {
    throw InvalidInput("--frequencies " + text + ": FROM and TO lie too close for N frequencies");
  }
  return result;
}

/// The orders of "1,2".
std::vector<double> orders(const std::string& text) {
  std::vector<double> result;
  std::istringstream all(text);
  for (std::string one; std::getline(all, one, ',');) {
    result.push_back(kreisel::finite_number("--orders", one));
    if (!(result.back() > 0)) {
      throw InvalidInput("--orders " + text + ": an order is frequency/speed and must be above 0");
    }
  }
  if (result.empty()) throw InvalidInput("--orders: wanted numbers, as 1,2");
  return result;
}

}  // namespace

std::optional<Request> read_request(int argc, char** argv) {
  CLI::App app(
      "Equilibrium or steady motion of what a scene file describes, its linear equations there "
      "and\n"
      "whether it is stable, how far precession equations hold. SI units and radians.\n");
  app.name("kreisel analyze");
  app.footer(exit_status::help);
  Request request;
  std::string scene;
  std::string body;
  std::string sweep;
  std::string order_list;
  std::string plot;
  std::string input;
  std::string output;
  std::string range;
  std::string csv;
  std::string state_space;
  app.add_option("scene", scene, "the scene file, TOML; -: standard input")
      ->required()
      ->type_name("SCENE.toml");
  scene_options::add_settings(app, request.solve);
  app.add_option("--campbell", body, "modes, whirl and critical speeds over the speed of this body")
      ->type_name("BODY");
  app.add_option("--speeds", sweep, "of it, rad/s against what carries it")->type_name("FROM:TO:N");
  app.add_option("--orders", order_list,
                 "critical speeds, where the frequency of a mode is this multiple of the speed [1]")
      ->type_name("N,N,..");
  app.add_option_function<std::string>(
         "--period",
         [&request](const std::string& text) {
           request.period = kreisel::finite_number("--period", text);
           if (!(*request.period > 0)) throw InvalidInput("--period must be above 0");
         },
         "s, of the coefficients: Floquet multipliers [found from joints at constant rates and "
         "from "
         "functions of time]")
      ->type_name("NUMBER");
  app.add_option(
         "--response", input,
         "the amplitude and phase that this input causes: joint.BODY, "
         "load.BODY.torque.x, CONTROLLER.reference, guide.roll, .., or unbalance.ROTOR, whose "
         "speed is then the frequency")
      ->type_name("INPUT");
  app.add_option("--to", output, "in this output: a column of a joint, a sensor or a controller")
      ->type_name("OUTPUT");
  app.add_option("--frequencies", range, "rad/s, equally spaced on a logarithmic scale")
      ->type_name("FROM:TO:N");
  app.add_option("--csv", csv, "the response as a table: frequency, amplitude, phase")
      ->type_name("FILE")
      ->group("Output");
  app.add_option("--state-space", state_space,
                 "the linear plant as JSON: A, B, C, D, names and units")
      ->type_name("FILE")
      ->group("Output");
  app.add_flag("--json", request.json, "one JSON object on standard output")->group("Output");
  app.add_option("--plot", plot, "pictures of what is found, SVG and PNG, by gnuplot")
      ->type_name("FOLDER")
      ->group("Output");
  if (!command_line::parse(app, argc, argv)) return {};
  request.scene = scene;
  if (!plot.empty()) request.plot = plot;
  if (body.empty() != sweep.empty()) {
    throw InvalidInput("--campbell BODY and --speeds FROM:TO:N go together");
  }
  const bool any = !input.empty() || !output.empty() || !range.empty();
  if (any && (input.empty() || output.empty() || range.empty())) {
    throw InvalidInput("--response INPUT, --to OUTPUT and --frequencies FROM:TO:N go together");
  }
  if (any) request.response = ResponseRequest{input, output, frequencies(range)};
  if (!csv.empty() && !any) throw InvalidInput("--csv FILE needs --response");
  if (!csv.empty()) request.response_file = csv;
  if (!state_space.empty()) request.state_space = state_space;
  if (!order_list.empty() && body.empty()) throw InvalidInput("--orders needs --campbell");
  if (!body.empty()) request.campbell = Sweep{body, speeds(sweep)};
  if (!order_list.empty()) request.campbell->orders = orders(order_list);
  return request;
}
