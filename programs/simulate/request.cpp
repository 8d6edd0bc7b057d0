#include "request.hpp"

#include <string>

#include <motor/error.hpp>

#include "../shared/command_line.hpp"
#include "../shared/exit_status.hpp"
#include "../shared/scene_options.hpp"

using namespace kreisel;

using kreisel::InvalidInput;

namespace {

void check(const Request& request) {
  const auto& [t_end, tolerance, method, settings] = request.solve;
  if (t_end && !(*t_end > 0)) throw InvalidInput("--t-end must be above 0");
  if (tolerance && !(*tolerance >= 1e-15 && *tolerance <= 1e-2)) {
    throw InvalidInput("--tolerance lies outside [1e-15, 1e-2]");
  }
  if (request.resume && !request.csv) throw InvalidInput("--resume needs --csv");
}

}  // namespace

std::optional<Request> read_request(int argc, char** argv) {
  CLI::App app(
      "Computes the motion that a scene file describes, to a tolerance of the global error.\n"
      "SI units and radians.\n");
  app.name("kreisel simulate");
  app.footer(exit_status::help);
  Request request;
  std::string scene;
  std::string csv;
  std::string plot;
  const auto value = [&app](const std::string& option, std::optional<double>& target,
                            const std::string& help) {
    app.add_option_function<std::string>(
           option,
           [&target, option](const std::string& text) {
             target = kreisel::finite_number(option, text);
           },
           help)
        ->type_name("NUMBER")
        ->group("Instead of the scene's");
  };
  app.add_option("scene", scene, "the scene file, TOML; -: standard input")
      ->required()
      ->type_name("SCENE.toml");
  scene_options::add_settings(app, request.solve);
  value("--t-end", request.solve.t_end, "s");
  value("--tolerance", request.solve.tolerance, "of the global error");
  app.add_option_function<std::string>(
         "--method",
         [&request](const std::string& word) {
           request.solve.method = kreisel::method_named(word);
           if (!request.solve.method) {
             throw InvalidInput("--method = '" + word +
                                "' is none of auto, closed form, verner98, gauss16, radau13, "
                                "splitting, taylor");
           }
         },
         "auto, closed form, verner98, gauss16, radau13, splitting, taylor")
      ->type_name("NAME")
      ->group("Instead of the scene's");
  app.add_flag("--reactions", request.reactions, "what every joint carries")->group("Output");
  app.add_flag("--terms", request.terms, "relative, guide and Coriolis part of every body")
      ->group("Output");
  app.add_flag("--json", request.json, "one JSON object on standard output")->group("Output");
  app.add_option("--csv", csv,
                 "the trajectory, written while it is computed; -: standard output, the summary on "
                 "standard error")
      ->type_name("FILE")
      ->group("Output");
  app.add_flag("--resume", request.resume,
               "continue the rows of the --csv file, from the checkpoint FILE.resume to the last "
               "bit; without a valid one from the last row, within the tolerance")
      ->group("Output");
  app.add_option("--plot", plot,
                 "pictures of the run, SVG and PNG, by gnuplot; view.html shows it in motion")
      ->type_name("FOLDER")
      ->group("Output");
  if (!command_line::parse(app, argc, argv)) return {};
  request.scene = scene;
  if (!csv.empty()) request.csv = csv;
  if (!plot.empty()) request.plot = plot;
  check(request);
  return request;
}
