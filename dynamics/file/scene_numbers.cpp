#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <string_view>
#include <utility>

#include <dynamics/file/scene_numbers.hpp>
#include <dynamics/file/scene_section.hpp>

namespace kreisel {

namespace {

/// The part of `rest` after `word`, if `word` is a complete part of the key.
std::optional<std::string_view> behind(std::string_view rest, std::string_view word) {
  if (!rest.starts_with(word)) return std::nullopt;
  rest.remove_prefix(word.size());
  if (rest.starts_with('.')) return rest.substr(1);
  if (rest.empty() || rest.starts_with('[')) return rest;
  return std::nullopt;
}

/// The element that "[i]" selects.
const toml::node* at_place(const toml::array& list, std::string_view& rest) {
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
const toml::node* named(const toml::array& list, std::string_view& rest,
                        std::vector<std::string>& words) {
  for (const toml::node& element : list) {
    const toml::table* const table = element.as_table();
    const auto name = table != nullptr ? (*table)["name"].value<std::string>() : std::nullopt;
    if (!name) continue;
    words.push_back(*name);
    if (const auto left = behind(rest, *name)) {
      rest = *left;
      return table;
    }
  }
  return nullptr;
}

const toml::node& find(const toml::table& root, const std::string& key) {
  const toml::node* node = &root;
  std::string_view rest = key;
  while (!rest.empty()) {
    const toml::node* next = nullptr;
    std::vector<std::string> words;
    const std::string_view asked = rest.substr(0, rest.find_first_of(".[", 1));
    if (const toml::array* const list = node->as_array()) {
      next = at_place(*list, rest);
      if (next == nullptr) next = named(*list, rest, words);
    } else if (const toml::table* const table = node->as_table()) {
      for (const auto& [word, value] : *table) {
        words.emplace_back(word.str());
        const auto left = behind(rest, word.str());
        if (!left) continue;
        rest = *left;
        next = &value;
        break;
      }
    }
    if (next == nullptr) {
      throw InvalidInput(key + ": there is no '" + std::string(asked) + "' in the file" +
                         detail::did_you_mean(asked, words));
    }
    node = next;
  }
  return *node;
}

/// The value of a number, or of a text with a unit on one line.
double value_of(const toml::node& node, const std::string& key) {
  if (const auto value = node.value<double>()) return *value;
  const auto* const text = node.as_string();
  const auto& [begin, end] = std::pair(node.source().begin, node.source().end);
  const bool is_plain = text != nullptr && detail::begins_with_number(text->get()) &&
                        begin.line == end.line &&
                        end.column - begin.column == text->get().size() + 2;
  if (!is_plain) throw InvalidInput(key + ": is no number");
  try {
    return detail::value_with_unit(text->get());
  } catch (const InvalidInput& error) {
    throw InvalidInput(key + ": " + error.what());
  }
}

/// The byte offset of a position of toml++, which counts UTF-8 characters.
std::size_t offset(std::string_view text, const toml::source_position& position) {
  std::size_t at = 0;
  for (toml::source_index line = 1; line < position.line; ++line) at = text.find('\n', at) + 1;
  for (toml::source_index column = 1; column < position.column; ++column) {
    ++at;
    while (at < text.size() && (static_cast<unsigned char>(text[at]) & 0xC0U) == 0x80U) ++at;
  }
  return at;
}

}  // namespace

SceneNumbers::SceneNumbers(std::string text, const std::vector<std::string>& keys)
    : text_(std::move(text)) {
  toml::table root;
  try {
    root = toml::parse(text_);
  } catch (const toml::parse_error& error) {
    throw InvalidInput("no TOML: " + std::string(error.description()));
  }
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const toml::node& node = find(root, keys[i]);
    values_.push_back(value_of(node, keys[i]));
    const std::size_t begin = offset(text_, node.source().begin);
    const bool is_quoted = node.is_string();
    const std::size_t end = is_quoted ? text_.find(text_[begin], begin + 1) + 1
                                      : text_.find_first_of(" \t\r\n,]}#", begin);
    places_.push_back({begin, std::min(end, text_.size()), i});
  }
  std::sort(places_.begin(), places_.end(),
            [](const Place& a, const Place& b) { return a.begin < b.begin; });
  for (std::size_t i = 1; i < places_.size(); ++i) {
    if (places_[i].begin == places_[i - 1].begin) {
      throw InvalidInput(keys[places_[i].key] + ": is named twice");
    }
  }
}

std::string SceneNumbers::with(const std::vector<double>& values) const {
  std::string result;
  std::size_t done = 0;
  for (const auto& [begin, end, key] : places_) {
    std::array<char, 32> number{};
    const auto written =
        std::to_chars(number.data(), number.data() + number.size(), values.at(key));
    result.append(text_, done, begin - done).append(number.data(), written.ptr);
    // Integers of TOML have 64 bits.
    const std::string_view digits(number.data(),
                                  static_cast<std::size_t>(written.ptr - number.data()));
    if (digits.size() > 17 && digits.find_first_of(".e") == std::string_view::npos) result += ".0";
    done = end;
  }
  return result.append(text_, done);
}

}  // namespace kreisel
