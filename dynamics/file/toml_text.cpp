#include <memory>
#include <string>

#include <dynamics/file/toml_text.hpp>

namespace kreisel::detail {

namespace {

toml::source_path_ptr path_of(std::string_view place) {
  return place.empty() ? nullptr : std::make_shared<const std::string>(place);
}

/// Refuses deeply nested keys, because the parser is recursive. No scene needs such keys.
void refuse_depth(std::string_view text, std::string_view place, Mistakes& mistakes) {
  constexpr int deepest = 64;
  toml::source_region where{{1, 1}, {1, 1}, path_of(place)};
  int brackets = 0;
  int dots = 0;
  bool in_key = true;
  char quote = 0;
  for (const char c : text) {
    ++where.begin.column;
    if (c == '\n') {
      where.begin = {where.begin.line + 1, 1};
      dots = 0;
      in_key = true;
      quote = 0;
    } else if (quote != 0) {
      if (c == quote) quote = 0;
    } else if (c == '#') {
      quote = '\n';  // up to the end of the line
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '=') {
      in_key = false;
    } else if (c == '.') {
      ++dots;
    } else if (c == ',' || c == '{') {
      dots = 0;
      in_key = true;
    }
    if (quote == 0 && (c == '[' || c == '{')) ++brackets;
    if (quote == 0 && (c == ']' || c == '}')) --brackets;
    if (brackets > deepest || (in_key && dots > deepest)) {
      mistakes.add(where, "", "is nested more than 64 deep; no scene is");
      mistakes.throw_any();
    }
  }
}

}  // namespace

toml::table parse_toml(std::string_view text, std::string_view place, Mistakes& mistakes) {
  refuse_depth(text, place, mistakes);
  try {
    return toml::parse(text, std::string(place));
  } catch (const toml::parse_error& error) {
    mistakes.add(error.source(), "", "is no TOML: " + std::string(error.description()));
    mistakes.throw_any();
    throw;
  }
}

}  // namespace kreisel::detail
