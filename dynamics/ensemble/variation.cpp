#include <sstream>

#include <dynamics/ensemble/variation.hpp>
#include <dynamics/file/finite_number.hpp>

namespace kreisel {

double Variation::drawn(double share, MemberRandom& random) const {
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

Variation parse_variation(const std::string& text) {
  const std::string place = "--vary " + text;
  const auto refuse = [&place](const std::string& why) { return InvalidInput(place + ": " + why); };
  const std::size_t equals = text.rfind('=');
  const std::size_t open = text.find('(', equals == std::string::npos ? 0 : equals);
  const std::size_t comma = text.find(',', open == std::string::npos ? 0 : open);
  if (equals == std::string::npos || open == std::string::npos || comma == std::string::npos ||
      text.back() != ')') {
    throw refuse("wanted KEY=normal(MEAN,DEVIATION), uniform(FROM,TO) or linear(FROM,TO)");
  }
  Variation result;
  result.text = text;
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
  result.first = finite_number(place, text.substr(open + 1, comma - open - 1));
  result.second = finite_number(place, text.substr(comma + 1, text.size() - comma - 2));
  if (result.kind == Variation::Kind::normal && !(result.second >= 0)) {
    throw refuse("the deviation must not be below 0");
  }
  return result;
}

}  // namespace kreisel
