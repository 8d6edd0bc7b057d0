#include "request.hpp"

#include <string>
#include <vector>

#include <motor/error.hpp>

#include "../shared/command_line.hpp"
#include "../shared/exit_status.hpp"
#include "../shared/scene_options.hpp"

using namespace kreisel;

using kreisel::InvalidInput;

std::optional<Request> read_request(int argc, char** argv) {
  CLI::App app(
      "Runs a scene file many times with numbers of it varied, and tells where the members end.\n"
      "SI units and radians, where a key does not end in _deg.\n");
  app.name("kreisel ensemble");
  app.footer(exit_status::help);
  Request request;
  std::string scene;
  std::string csv;
  std::string plot;
  std::vector<std::string> varied;
  const auto value = [&app](const std::string& option, std::optional<double>& target,
                            const std::string& help) {
    app.add_option_function<std::string>(
           option,
           [&target, option](const std::string& text) {
             target = kreisel::finite_number(option, text);
             if (!(*target > 0)) throw InvalidInput(option + " must be above 0");
           },
           help)
        ->type_name("NUMBER");
  };
  app.add_option("scene", scene, "the scene file, TOML; -: standard input")
      ->required()
      ->type_name("SCENE.toml");
  app.add_option(
         "--vary", varied,
         "a number of the scene by its keys: replaced (=), added to (+=) or multiplied (*=) "
         "by normal(MEAN,DEVIATION), uniform(FROM,TO) or, in equal steps, linear(FROM,TO). "
         "Keys with commas between share a drawn number. Example: "
         "'body.rotor.mass*=normal(1,0.01)'")
      ->required()
      ->type_name("KEY=DISTRIBUTION");
  app.add_option("--members", request.ensemble.members, "number of runs, 1 to 10000000 [1000]")
      ->check(CLI::Range(1, 10000000).description(""))
      ->type_name("N");
  app.add_option("--seed", request.ensemble.seed, "of all that is drawn [1]")->type_name("N");
  app.add_option(
         "--threads", request.threads,
         "at most 4096; results do not depend on it [0: as many as the machine runs at once]")
      ->check(CLI::Range(0, 4096).description(""))
      ->type_name("N");
  scene_options::add_settings(app, request.ensemble.solve);
  value("--t-end", request.ensemble.solve.t_end, "s, instead of the scene's");
  value("--tolerance", request.ensemble.solve.tolerance,
        "of the global error, instead of the scene's");
  app.add_flag("--json", request.json, "one JSON object on standard output");
  app.add_option("--csv", csv,
                 "a row for each member: what was drawn, joints at the end, error estimate, and "
                 "the reason where it failed")
      ->type_name("FILE");
  app.add_option("--plot", plot, "the members over what was drawn, SVG and PNG, by gnuplot")
      ->type_name("FOLDER");
  if (!command_line::parse(app, argc, argv)) return {};
  request.scene = scene;
  if (!csv.empty()) request.csv = csv;
  if (!plot.empty()) request.plot = plot;
  if (request.ensemble.solve.tolerance &&
      !(*request.ensemble.solve.tolerance >= 1e-15 && *request.ensemble.solve.tolerance <= 1e-2)) {
    throw InvalidInput("--tolerance lies outside [1e-15, 1e-2]");
  }
  for (const std::string& text : varied) {
    request.ensemble.variations.push_back(kreisel::parse_variation(text));
  }
  return request;
}
