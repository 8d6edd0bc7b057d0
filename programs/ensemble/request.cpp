#include "request.hpp"

#include <sstream>

#include <motor/error.hpp>

#include "../shared/command_line.hpp"
#include "../shared/exit_status.hpp"

using namespace kreisel;

using kreisel::InvalidInput;

namespace {

/// KEY=normal(MEAN,DEVIATION), KEY+=uniform(FROM,TO), KEY,KEY*=linear(FROM,TO)
Variation variation(const std::string& text) {
  const auto refuse = [&text](const std::string& why) {
    return InvalidInput(fmt::format("--vary {}: {}", text, why));
  };
  const std::size_t equals = text.rfind('=');
  const std::size_t open = text.find('(', equals == std::string::npos ? 0 : equals);
  const std::size_t comma = text.find(',', open == std::string::npos ? 0 : open);
  if (equals == std::string::npos || open == std::string::npos || comma == std::string::npos ||
      text.back() != ')') {
    throw refuse("wanted KEY=normal(MEAN,DEVIATION), uniform(FROM,TO) or linear(FROM,TO)");
  }
  Variation result;
  const char operation = equals > 0 ? text[equals - 1] : '=';
  if (operation == '+') result.use = Variation::Use::added;
  if (operation == '*') result.use = Variation::Use::factor;
  std::istringstream keys(text.substr(0, equals - (result.use == Variation::Use::instead ? 0 : 1)));
  for (std::string key; std::getline(keys, key, ',');) result.keys.push_back(key);
  if (result.keys.empty()) throw refuse("names no number of the scene");
  const std::string kind = text.substr(equals + 1, open - equals - 1);
  if (kind == "uniform") {
    result.kind = Variation::Kind::uniform;
  } else if (kind == "linear") {
    result.kind = Variation::Kind::linear;
  } else if (kind != "normal") {
    throw refuse("'" + kind + "' is none of normal, uniform, linear");
  }
  result.first = command_line::number("--vary " + text, text.substr(open + 1, comma - open - 1));
  result.second =
      command_line::number("--vary " + text, text.substr(comma + 1, text.size() - comma - 2));
  if (result.kind == Variation::Kind::normal && !(result.second >= 0)) {
    throw refuse("the deviation must not be below 0");
  }
  return result;
}

}  // namespace

double Variation::drawn(double share, kreisel::MemberRandom& random) const {
  switch (kind) {
    case Kind::normal: return random.normal(first, second);
    case Kind::uniform: return random.uniform(first, second);
    case Kind::linear: break;
  }
  return first + (second - first) * share;
}

double Variation::applied(double given, double drawn) const {
  switch (use) {
    case Use::added: return given + drawn;
    case Use::factor: return given * drawn;
    case Use::instead: break;
  }
  return drawn;
}

std::optional<Request> read_request(int argc, char** argv) {
  CLI::App app(
      "Runs a scene file many times with numbers of it varied, and tells where the members end.\n"
      "SI units and radians, where a key does not end in _deg.\n");
  app.name("ensemble");
  app.footer(exit_status::help);
  Request request;
  std::string scene;
  std::string csv;
  std::vector<std::string> varied;
  const auto value = [&app](const std::string& option, std::optional<double>& target,
                            const std::string& help) {
    app.add_option_function<std::string>(
           option,
           [&target, option](const std::string& text) {
             target = command_line::number(option, text);
             if (!(*target > 0)) throw InvalidInput(option + " must be above 0");
           },
           help)
        ->type_name("NUMBER");
  };
  app.add_option("scene", scene, "the scene file, TOML")->required()->type_name("SCENE.toml");
  app.add_option("--vary", varied,
                 "a number of the file, by its keys, and what stands there instead (=), what is "
                 "added to it (+=) or what it is multiplied by (*=): normal(MEAN,DEVIATION), "
                 "uniform(FROM,TO), or linear(FROM,TO) in equal steps, as in "
                 "'body.rotor.mass*=normal(1,0.01)' 'gravity.vector[2]+=uniform(-1,1)'. Numbers "
                 "that go together, with commas between, share what is drawn")
      ->required()
      ->type_name("KEY=DISTRIBUTION");
  app.add_option("--members", request.members)->check(CLI::Range(1, 10000000));
  app.add_option("--seed", request.seed, "of all that is drawn");
  app.add_option("--threads", request.threads,
                 "0: as many as the machine runs at once. Results do not depend on it")
      ->check(CLI::Range(0, 4096));
  value("--t-end", request.solve.t_end, "s, instead of the scene's");
  value("--tolerance", request.solve.tolerance, "of the global error, instead of the scene's");
  app.add_flag("--json", request.json, "one JSON object on standard output");
  app.add_option("--csv", csv,
                 "a row for each member: what was drawn, joints at the end, error estimate, and "
                 "the reason where it failed")
      ->type_name("FILE");
  if (!command_line::parse(app, argc, argv)) return {};
  request.scene = scene;
  if (!csv.empty()) request.csv = csv;
  if (request.solve.tolerance &&
      !(*request.solve.tolerance >= 1e-15 && *request.solve.tolerance <= 1e-2)) {
    throw InvalidInput("--tolerance lies outside [1e-15, 1e-2]");
  }
  for (const std::string& text : varied) request.variations.push_back(variation(text));
  return request;
}
