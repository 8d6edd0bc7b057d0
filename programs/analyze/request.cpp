#include "request.hpp"

#include <motor/error.hpp>

#include "../shared/command_line.hpp"
#include "../shared/exit_status.hpp"

using namespace kreisel;

using kreisel::InvalidInput;

namespace {

/// The speeds of "100:3000:30": first, last and number.
std::vector<double> speeds(const std::string& text) {
  const auto refuse = [&text](const char* why) {
    return InvalidInput(fmt::format("--speeds {}: {}", text, why));
  };
  const std::size_t first = text.find(':');
  const std::size_t second = text.find(':', first + 1);
  if (first == std::string::npos || second == std::string::npos) {
    throw refuse("wanted FROM:TO:N, as 100:3000:30");
  }
  const double from = command_line::number("--speeds from", text.substr(0, first));
  const double to = command_line::number("--speeds to", text.substr(first + 1, second - first - 1));
  const double count = command_line::number("--speeds n", text.substr(second + 1));
  if (!(count >= 2 && count <= 100000) || count != std::floor(count)) {
    throw refuse("N is no whole number from 2 to 100000");
  }
  if (from == to) throw refuse("FROM and TO are the same");
  const int last = static_cast<int>(count) - 1;
  if (!std::isfinite((to - from) * last)) throw refuse("FROM and TO lie too far apart");
  std::vector<double> result;
  for (int i = 0; i <= last; ++i) result.push_back(from + (to - from) * i / last);
  return result;
}

}  // namespace

std::optional<Request> read_request(int argc, char** argv) {
  CLI::App app(
      "Equilibrium or steady motion of what a scene file describes, its linear equations there "
      "and\n"
      "whether it is stable, how far precession equations hold. SI units and radians.\n");
  app.name("analyze");
  app.footer(exit_status::help);
  Request request;
  std::string scene;
  std::string body;
  std::string sweep;
  std::string plot;
  app.add_option("scene", scene, "the scene file, TOML")->required()->type_name("SCENE.toml");
  app.add_option("--campbell", body, "how the roots go with the speed of this body")
      ->type_name("BODY");
  app.add_option("--speeds", sweep, "of it, rad/s against what carries it")->type_name("FROM:TO:N");
  app.add_option_function<std::string>(
         "--period",
         [&request](const std::string& text) {
           request.period = command_line::number("--period", text);
           if (!(*request.period > 0)) throw InvalidInput("--period must be above 0");
         },
         "s, of the coefficients: Floquet multipliers [that of a harmonic guide of one frequency]")
      ->type_name("NUMBER");
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
  if (!body.empty()) request.campbell = Sweep{body, speeds(sweep)};
  return request;
}
