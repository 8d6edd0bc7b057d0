#include <algorithm>
#include <charconv>
#include <utility>

#include <dynamics/file/scene_file.hpp>
#include <dynamics/file/setting_keys.hpp>
#include <dynamics/file/toml_text.hpp>
#include <dynamics/file/unit.hpp>

namespace kreisel {

namespace {

using detail::Mistakes;

/// A walk along the parts of a key, from the root of a file.
struct Walk {
  toml::node* node;                     ///< the last one that exists
  std::string_view rest;                ///< of the key, behind the node; empty if all of it exists
  toml::node* parent = nullptr;         ///< of the node
  std::string_view word = {};           ///< of the node in its parent, if that is a table
  std::vector<std::string> words = {};  ///< keys or names in the node, if the walk ends there
};

/// The part of `rest` after `word`, if `word` is a complete part of the key.
std::optional<std::string_view> behind(std::string_view rest, std::string_view word) {
  if (!rest.starts_with(word)) return std::nullopt;
  rest.remove_prefix(word.size());
  if (rest.starts_with('.')) return rest.substr(1);
  if (rest.empty() || rest.starts_with('[')) return rest;
  return std::nullopt;
}

std::string_view first_word(std::string_view rest) {
  return rest.substr(0, rest.find_first_of(".[", 1));
}

/// The element that "[i]" selects.
toml::node* at_index(toml::array& list, std::string_view& rest) {
  std::size_t i = 0;
  const char* const end = rest.data() + rest.size();
  if (!rest.starts_with('[')) return nullptr;
  const auto [next, error] = std::from_chars(rest.data() + 1, end, i);
  if (error != std::errc{} || next == end || *next != ']' || i >= list.size()) return nullptr;
  rest.remove_prefix(static_cast<std::size_t>(next + 1 - rest.data()));
  if (rest.starts_with('.')) rest.remove_prefix(1);
  return list.get(i);
}

/// The table with the name that `rest` begins with.
toml::node* at_name(toml::array& list, Walk& walk) {
  for (toml::node& element : list) {
    toml::table* const table = element.as_table();
    const auto name = table != nullptr ? (*table)["name"].value<std::string>() : std::nullopt;
    if (!name) continue;
    walk.words.push_back(*name);
    if (const auto left = behind(walk.rest, *name)) {
      walk.rest = *left;
      return table;
    }
  }
  return nullptr;
}

/// The value at the key that `rest` begins with.
toml::node* at_key(toml::table& table, Walk& walk) {
  for (auto&& [word, value] : table) {
    walk.words.emplace_back(word.str());
    if (const auto left = behind(walk.rest, word.str())) {
      walk.word = walk.rest.substr(0, word.length());
      walk.rest = *left;
      return &value;
    }
  }
  return nullptr;
}

Walk walk_along(toml::table& root, std::string_view key) {
  Walk walk{&root, key};
  while (!walk.rest.empty()) {
    walk.words.clear();
    toml::node* next = nullptr;
    if (toml::array* const list = walk.node->as_array()) {
      next = at_index(*list, walk.rest);
      if (next == nullptr) next = at_name(*list, walk);
    } else if (toml::table* const table = walk.node->as_table()) {
      next = at_key(*table, walk);
    }
    if (next == nullptr) break;
    walk.parent = std::exchange(walk.node, next);
  }
  return walk;
}

std::string not_in_file(const Walk& walk) {
  const std::string_view word = first_word(walk.rest);
  return "there is no '" + std::string(word) + "' in the file" +
         detail::did_you_mean(word, walk.words);
}

/// The number of a node, in the unit of its key.
double number_of(const toml::node& node, const std::string& key) {
  if (const auto value = node.value<double>()) return *value;
  const auto text = node.value<std::string>();
  if (!text || !detail::begins_with_number(*text)) throw InvalidInput(key + ": is no number");
  try {
    return key.ends_with("_deg") ? detail::value_with_unit(*text, std::nullopt)
                                 : detail::value_with_unit(*text);
  } catch (const InvalidInput& error) {
    throw InvalidInput(key + ": " + error.what());
  }
}

/// The value of a setting, as the only one of a table. A text that is no TOML stands for itself.
toml::table value_of(const SceneSetting& setting, Mistakes& mistakes) {
  const bool is_bare = setting.value.find_first_of("\"'[{\n") != 0;
  try {
    Mistakes own("");
    return detail::parse_toml("value = " + setting.value, setting.place, is_bare ? own : mistakes);
  } catch (const SceneMistakes&) {
    if (!is_bare) throw;
    return detail::parse_toml("value = '" + setting.value + "'", setting.place, mistakes);
  }
}

/// Adds a value at the rest of a key, with tables on the way to it.
void add(toml::table* table, std::string_view rest, toml::node&& value) {
  const toml::source_region place = value.source();
  for (auto dot = rest.find('.'); dot != std::string_view::npos; dot = rest.find('.')) {
    const toml::key word(rest.substr(0, dot), place);
    table = table->insert(word, toml::table{}).first->second.as_table();
    rest.remove_prefix(dot + 1);
  }
  table->insert(toml::key(rest, place), std::move(value));
}

/// True if the text is words with one dot between each.
bool is_path(std::string_view text) {
  const std::string dotted = '.' + std::string(text) + '.';
  return dotted.find("..") == std::string::npos && text.find_first_of("[]") == std::string::npos;
}

void replace(const Walk& walk, toml::node&& value) {
  if (toml::table* const table = walk.parent->as_table()) {
    table->insert_or_assign(walk.word, std::move(value));
    return;
  }
  toml::array& list = *walk.parent->as_array();
  const auto at = std::find_if(list.begin(), list.end(), [&walk](const toml::node& element) {
    return &element == walk.node;
  });
  list.replace(at, std::move(value));
}

void apply(const SceneSetting& setting, toml::table& root, Mistakes& mistakes) {
  toml::table parsed = value_of(setting, mistakes);
  toml::node& value = *parsed.get("value");
  const auto refuse = [&](const std::string& why) {
    mistakes.add(value.source(), setting.key, why);
  };
  constexpr int deepest = 64;
  if (parsed.size() > 1) return refuse("give one value");
  if (std::count(setting.key.begin(), setting.key.end(), '.') > deepest) {
    return refuse("is nested more than 64 deep; no scene is");
  }
  if (setting.key.empty() || setting.key.back() == '.') return refuse("is no key");
  const Walk walk = walk_along(root, setting.key);
  if (walk.rest.empty() && walk.node->source().path) return refuse("is given twice");
  if (walk.rest.empty()) return replace(walk, std::move(value));
  toml::table* const table = walk.node->as_table();
  if (table == nullptr || !is_path(walk.rest)) return refuse(not_in_file(walk));
  add(table, walk.rest, std::move(value));
}

}  // namespace

SceneSetting parse_setting(const std::string& option, std::string_view text) {
  const std::size_t equals = text.find('=');
  const std::string place = option + ' ' + std::string(text);
  if (equals == 0 || equals == std::string_view::npos || equals + 1 == text.size()) {
    throw InvalidInput(place + ": wanted KEY=VALUE, as body.rotor.mass=2");
  }
  return {std::string(text.substr(0, equals)), std::string(text.substr(equals + 1)), place};
}

std::optional<double> number_in_scene(std::string_view text, const std::string& key) {
  Mistakes mistakes("scene");
  toml::table root = detail::parse_toml(text, {}, mistakes);
  const Walk walk = walk_along(root, key);
  if (walk.rest.empty()) return number_of(*walk.node, key);
  if (walk.node->is_table() && walk.rest.find('[') == std::string_view::npos) return std::nullopt;
  throw InvalidInput(key + ": " + not_in_file(walk));
}

void detail::apply_settings(const std::vector<SceneSetting>& settings, toml::table& root,
                            Mistakes& mistakes) {
  for (const SceneSetting& setting : settings) apply(setting, root, mistakes);
}

}  // namespace kreisel
