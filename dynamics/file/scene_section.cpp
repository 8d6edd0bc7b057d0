#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>
#include <tuple>

#include <dynamics/file/printable.hpp>
#include <dynamics/file/quoted.hpp>
#include <dynamics/file/scene_file.hpp>
#include <dynamics/file/scene_section.hpp>

namespace kreisel::detail {

namespace {

std::string kind_of(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::table: return "a table";
    case toml::node_type::array: return "a list";
    case toml::node_type::string: return "a text";
    case toml::node_type::integer: return "a whole number";
    case toml::node_type::floating_point: return "a number";
    case toml::node_type::boolean: return "true or false";
    default: return "a date or a time";
  }
}

std::string shown(double value) {
  std::ostringstream text;
  text.precision(10);
  text << value;
  return text.str();
}

std::string listed(const std::vector<std::string>& words) {
  std::string result;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) result += i + 1 == words.size() ? " or " : ", ";
    result += "'" + words[i] + "'";
  }
  return result;
}

}  // namespace

void Mistakes::add(const toml::source_region& where, std::string_view key,
                   std::string_view reason) {
  std::string text;
  if (!key.empty()) text = printable(key, 200) + ": ";
  list_.push_back(
      {where.path ? *where.path : std::string(), where.begin, text + printable(reason)});
}

void Mistakes::throw_any() const {
  if (list_.empty()) return;
  std::vector<Mistake> sorted = list_;
  std::stable_sort(sorted.begin(), sorted.end(), [](const Mistake& a, const Mistake& b) {
    return std::tie(a.place, a.where.line, a.where.column) <
           std::tie(b.place, b.where.line, b.where.column);
  });
  sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
  std::ostringstream all;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    const auto& [place, where, text] = sorted[i];
    all << (i > 0 ? "\n" : "");
    if (place.empty()) {  // the root has no position
      all << file_ << ':' << std::max(where.line, toml::source_index(1)) << ':'
          << std::max(where.column, toml::source_index(1));
    } else {
      all << printable(place);
    }
    all << ": " << text;
  }
  throw SceneMistakes(all.str());
}

std::string Section::path_to(std::string_view key) const {
  std::string shown_key(key);
  for (char& c : shown_key) {
    if (static_cast<unsigned char>(c) < 0x20) c = '?';
  }
  return path_.empty() ? shown_key : path_ + "." + shown_key;
}

const toml::node* Section::find(std::string_view key) {
  if (std::find(known_.begin(), known_.end(), key) == known_.end()) known_.emplace_back(key);
  return table_->get(key);
}

std::string shown_time(double t) {
  std::ostringstream text;
  text.precision(15);
  text << t;
  return text.str();
}

bool Section::has(std::string_view key) { return find(key) != nullptr; }

void Section::refuse(std::string_view key, std::string_view reason) {
  const toml::node* const node = table_->get(key);
  mistakes_->add(node != nullptr ? node->source() : table_->source(), path_to(key), reason);
}

void Section::refuse_all(std::string_view reason) {
  mistakes_->add(table_->source(), path_, reason);
}

void Section::refuse_missing(std::string_view key) { refuse(key, "is missing"); }

bool Section::has_number(std::string_view key) {
  const toml::node* const node = find(key);
  return node != nullptr && (node->is_number() || begins_with_number(peek(key)));
}

std::optional<double> Section::number_in(const toml::node& node, const std::string& key,
                                         const KeyDimension& of, Range range) {
  const auto refuse_it = [&](const std::string& reason) {
    mistakes_->add(node.source(), key, reason);
    return std::nullopt;
  };
  double value = 0;
  if (const auto* const whole = node.as_integer()) {
    value = static_cast<double>(whole->get());
  } else if (const auto* const real = node.as_floating_point()) {
    value = real->get();
  } else if (const auto* const text = node.as_string();
             text != nullptr && begins_with_number(text->get())) {
    try {
      value = value_with_unit(text->get(), of);
    } catch (const InvalidInput& error) {
      return refuse_it(error.what());
    }
  } else {
    return refuse_it("must be a number, not " + kind_of(node));
  }
  if (!std::isfinite(value)) {
    return refuse_it("is " + std::string(std::isnan(value) ? "NaN" : "infinite") +
                     ", not a finite number");
  }
  if (range == Range::positive && !(value > 0)) {
    return refuse_it(shown(value) + " must be above 0");
  }
  if (range == Range::not_negative && !(value >= 0)) {
    return refuse_it(shown(value) + " must not be below 0");
  }
  return value;
}

std::optional<double> Section::number(std::string_view key, const KeyDimension& of, Range range) {
  const toml::node* const node = find(key);
  return node == nullptr ? std::nullopt : number_in(*node, path_to(key), of, range);
}

double Section::required_number(std::string_view key, const KeyDimension& of, Range range) {
  if (!has(key)) refuse_missing(key);
  return number(key, of, range).value_or(1);
}

std::optional<double> Section::number_at(std::string_view key, std::size_t index,
                                         const toml::node& node, const KeyDimension& of) {
  return number_in(node, path_to(key) + "[" + std::to_string(index) + "]", of);
}

std::optional<double> Section::angle(const std::string& key, const Dimension& of) {
  const auto value = angles(key, 1, of);
  return value ? std::optional(value->front()) : std::nullopt;
}

std::optional<std::vector<double>> Section::numbers_in(const toml::node& node,
                                                       const std::string& key,
                                                       const std::vector<KeyDimension>& of) {
  const toml::array* const list = node.as_array();
  if (list == nullptr) {
    mistakes_->add(node.source(), key, "must be a list of numbers, not " + kind_of(node));
    return std::nullopt;
  }
  std::vector<double> values;
  bool good = true;
  for (std::size_t i = 0; i < list->size(); ++i) {
    const auto value = number_in(*list->get(i), key + "[" + std::to_string(i) + "]",
                                 of[std::min(i, of.size() - 1)]);
    good = good && value;
    values.push_back(value.value_or(0));
  }
  return good ? std::optional(values) : std::nullopt;
}

std::optional<std::vector<double>> Section::numbers(std::string_view key, const KeyDimension& of) {
  const toml::node* const node = find(key);
  return node == nullptr ? std::nullopt : numbers_in(*node, path_to(key), {of});
}

std::optional<std::vector<double>> Section::numbers(std::string_view key, std::size_t count,
                                                    const KeyDimension& of) {
  return counted(key, count, numbers(key, of));
}

std::optional<std::vector<double>> Section::counted(std::string_view key, std::size_t count,
                                                    std::optional<std::vector<double>> values) {
  if (values && values->size() != count) {
    refuse(key,
           "must be " + std::to_string(count) + " numbers, not " + std::to_string(values->size()));
    return std::nullopt;
  }
  return values;
}

std::optional<std::vector<double>> Section::timed_row_in(const toml::node& node,
                                                         const std::string& key, std::size_t width,
                                                         const KeyDimension& of) {
  const toml::array* const pair = node.as_array();
  if (pair == nullptr || pair->size() != 2) {
    const std::string value = width == 1 ? "value" : "[x, y, z]";
    mistakes_->add(node.source(), key, "must be [time, " + value + "]");
    return std::nullopt;
  }
  const auto time = number_in(*pair->get(0), key + "[0]", dimension::time);
  const toml::node& value = *pair->get(1);
  std::optional<std::vector<double>> row;
  if (width > 1) {
    row = numbers_in(value, key + "[1]", {of});
    if (row && row->size() != width) {
      mistakes_->add(
          value.source(), key + "[1]",
          "must be " + std::to_string(width) + " numbers, not " + std::to_string(row->size()));
      return std::nullopt;
    }
  } else if (const auto number = number_in(value, key + "[1]", of)) {
    row = {*number};
  }
  if (!time || !row) return std::nullopt;
  row->insert(row->begin(), *time);
  return row;
}

std::optional<std::vector<std::vector<double>>> Section::timed_rows(std::string_view key,
                                                                    std::size_t width,
                                                                    const KeyDimension& of) {
  const toml::node* const node = find(key);
  const toml::array* const list = node == nullptr ? nullptr : node->as_array();
  if (list == nullptr || list->empty()) {
    refuse(key, list == nullptr ? "must be a list of [time, value]" : "is empty");
    return std::nullopt;
  }
  std::vector<std::vector<double>> rows;
  bool good = true;
  for (std::size_t i = 0; i < list->size(); ++i) {
    const std::string name = path_to(key) + "[" + std::to_string(i) + "]";
    auto row = timed_row_in(*list->get(i), name, width, of);
    good = good && row;
    if (!good) continue;
    if (!rows.empty() && !(row->front() > rows.back().front())) {
      mistakes_->add(list->get(i)->source(), name,
                     "begins at " + shown(row->front()) + " s, not after " +
                         shown(rows.back().front()) + " s, the time before it");
      good = false;
    }
    rows.push_back(std::move(*row));
  }
  return good ? std::optional(rows) : std::nullopt;
}

template <class Read>
std::optional<std::vector<double>> Section::in_radian(const std::string& key, const Dimension& of,
                                                      const Read& read) {
  const std::string in_degrees = key + "_deg";
  if (!has(in_degrees)) return read(key, of);
  if (has(key)) refuse(in_degrees, "is given in radian too, as '" + key + "'");
  auto values = read(in_degrees, std::nullopt);
  if (values)
    std::for_each(values->begin(), values->end(), [](double& x) { x *= radian_per_degree; });
  return values;
}

std::optional<std::vector<double>> Section::angles(const std::string& key, std::size_t count,
                                                   const Dimension& of) {
  return in_radian(key, of, [this, count](const std::string& name, const KeyDimension& own) {
    return count == 1 ? single(name, own) : numbers(name, count, own);
  });
}

std::optional<std::vector<double>> Section::number_or_list(std::string_view key, std::size_t count,
                                                           const KeyDimension& of) {
  const toml::node* const node = find(key);
  if (count > 1 && node != nullptr && node->is_array()) return numbers(key, count, of);
  const auto value = number(key, of);
  return value ? std::optional(std::vector<double>(count, *value)) : std::nullopt;
}

std::optional<std::vector<double>> Section::number_or_list(std::string_view key,
                                                           const std::vector<Dimension>& each) {
  const toml::node* const node = find(key);
  if (node == nullptr) return std::nullopt;
  if (each.size() > 1 && node->is_array()) {
    return counted(key, each.size(), numbers_in(*node, path_to(key), {each.begin(), each.end()}));
  }
  std::vector<double> values;
  for (const Dimension& of : each) {
    const auto value = number(key, of);
    if (!value) return std::nullopt;
    values.push_back(*value);
  }
  return values;
}

std::optional<std::vector<double>> Section::angle_or_list(const std::string& key, std::size_t count,
                                                          const Dimension& of) {
  return in_radian(key, of, [this, count](const std::string& name, const KeyDimension& own) {
    return number_or_list(name, count, own);
  });
}

std::optional<Vector3<double>> Section::vector(std::string_view key, const Dimension& of) {
  const auto values = numbers(key, 3, of);
  if (!values) return std::nullopt;
  return Vector3<double>((*values)[0], (*values)[1], (*values)[2]);
}

std::optional<Vector3<double>> Section::vector_at(std::string_view key, std::size_t index,
                                                  const toml::node& node, const Dimension& of) {
  const std::string name = path_to(key) + "[" + std::to_string(index) + "]";
  const auto values = numbers_in(node, name, {of});
  if (!values) return std::nullopt;
  if (values->size() == 3) return Vector3<double>(values->data());
  mistakes_->add(node.source(), name, "must be 3 numbers, not " + std::to_string(values->size()));
  return std::nullopt;
}

std::optional<std::vector<std::pair<double, double>>> Section::pairs(std::string_view key,
                                                                     const Dimension& first,
                                                                     const Dimension& second) {
  const toml::node* const node = find(key);
  if (node == nullptr) return std::nullopt;
  const toml::array* const list = node->as_array();
  if (list == nullptr) {
    refuse(key, "must be a list of pairs of numbers, not " + kind_of(*node));
    return std::nullopt;
  }
  std::vector<std::pair<double, double>> result;
  bool good = true;
  for (std::size_t i = 0; i < list->size(); ++i) {
    const std::string name = path_to(key) + "[" + std::to_string(i) + "]";
    const auto pair = numbers_in(*list->get(i), name, {first, second});
    if (pair && pair->size() == 2) {
      result.emplace_back((*pair)[0], (*pair)[1]);
      continue;
    }
    if (pair) mistakes_->add(list->get(i)->source(), name, "must be two numbers");
    good = false;
  }
  return good ? std::optional(result) : std::nullopt;
}

Vector3<double> Section::required_vector(std::string_view key, const Dimension& of) {
  if (!has(key)) refuse_missing(key);
  return vector(key, of).value_or(Vector3<double>::UnitX());
}

std::optional<Matrix3<double>> Section::matrix(std::string_view key, const Dimension& of) {
  const toml::node* const node = find(key);
  const toml::array* const rows = node == nullptr ? nullptr : node->as_array();
  if (rows == nullptr || rows->empty() || !rows->get(0)->is_array()) {
    const auto diagonal = vector(key, of);
    return diagonal ? std::optional<Matrix3<double>>(diagonal->asDiagonal()) : std::nullopt;
  }
  Matrix3<double> result;
  bool good = rows->size() == 3;
  for (std::size_t i = 0; good && i < 3; ++i) {
    const auto row = numbers_in(*rows->get(i), path_to(key) + "[" + std::to_string(i) + "]", {of});
    if (!row) return std::nullopt;
    good = row->size() == 3;
    if (good) result.row(static_cast<Eigen::Index>(i)) << (*row)[0], (*row)[1], (*row)[2];
  }
  if (good) return result;
  refuse(key, "must be 3 numbers, or 3 rows of 3 numbers");
  return std::nullopt;
}

std::optional<std::string> Section::text(std::string_view key) {
  const toml::node* const node = find(key);
  if (node == nullptr) return std::nullopt;
  const auto* const value = node->as_string();
  if (value == nullptr) {
    refuse(key, "must be a text, not " + kind_of(*node));
    return std::nullopt;
  }
  return value->get();
}

std::vector<std::string> Section::texts(std::string_view key) {
  const toml::node* const node = find(key);
  if (node == nullptr) return {};
  const toml::array* const list = node->as_array();
  if (list == nullptr) {
    refuse(key, "must be a list of texts, not " + kind_of(*node));
    return {};
  }
  std::vector<std::string> result;
  for (std::size_t i = 0; i < list->size(); ++i) {
    const toml::node& entry = *list->get(i);
    if (const auto* const text = entry.as_string()) {
      result.push_back(text->get());
    } else {
      mistakes_->add(entry.source(), path_to(key) + "[" + std::to_string(i) + "]",
                     "must be a text, not " + kind_of(entry));
    }
  }
  return result;
}

std::optional<std::vector<double>> Section::single(std::string_view key, const KeyDimension& of) {
  const auto value = number(key, of);
  return value ? std::optional(std::vector<double>{*value}) : std::nullopt;
}

std::string Section::peek(std::string_view key) const {
  const auto* const node = table_->get_as<std::string>(key);
  return node == nullptr ? std::string() : node->get();
}

std::string Section::required_text(std::string_view key) {
  if (!has(key)) refuse_missing(key);
  return text(key).value_or("");
}

bool Section::flag(std::string_view key) {
  const toml::node* const node = find(key);
  if (node == nullptr) return false;
  const auto* const value = node->as_boolean();
  if (value == nullptr) refuse(key, "must be true or false, not " + kind_of(*node));
  return value != nullptr && value->get();
}

std::string Section::choice(std::string_view key, const std::vector<std::string>& words) {
  const auto word = text(key);
  if (!word) return words.front();
  if (std::find(words.begin(), words.end(), *word) != words.end()) return *word;
  refuse(key, in_quotes(*word) + " is none of " + listed(words) + did_you_mean(*word, words));
  return words.front();
}

std::string Section::required_choice(std::string_view key, const std::vector<std::string>& words) {
  if (!has(key)) refuse_missing(key);
  return choice(key, words);
}

std::optional<Section> Section::section(std::string_view key) {
  const toml::node* const node = find(key);
  if (node == nullptr) return std::nullopt;
  const toml::table* const table = node->as_table();
  if (table == nullptr) {
    refuse(key, "must be a table, not " + kind_of(*node));
    return std::nullopt;
  }
  return Section(*table, path_to(key), *mistakes_, logs_);
}

std::optional<Section> Section::required_section(std::string_view key) {
  if (!has(key)) refuse_missing(key);
  return section(key);
}

std::optional<Eigen::Quaterniond> quaternion(Section& section, std::string_view key) {
  const auto values = section.numbers(key, 4, dimension::number);
  if (!values) return std::nullopt;
  const Eigen::Quaterniond q((*values)[0], (*values)[1], (*values)[2], (*values)[3]);
  if (!(std::abs(q.norm() - 1) <= 1e-3)) {
    section.refuse(
        key, "is a quaternion [w, x, y, z] of norm " + std::to_string(q.norm()) + ", not of 1");
    return std::nullopt;
  }
  return q.normalized();
}

std::vector<std::string> Section::keys() const {
  std::vector<std::string> result;
  for (const auto& [key, value] : *table_) result.emplace_back(key.str());
  return result;
}

std::vector<Section> Section::sections(std::string_view key) {
  const toml::node* const node = find(key);
  if (node == nullptr) return {};
  const toml::array* const list = node->as_array();
  if (list == nullptr) {
    refuse(key, "must be a list of tables, not " + kind_of(*node));
    return {};
  }
  std::vector<Section> result;
  for (std::size_t i = 0; i < list->size(); ++i) {
    const std::string path = path_to(key) + "[" + std::to_string(i) + "]";
    const toml::table* const table = list->get(i)->as_table();
    if (table == nullptr) {
      mistakes_->add(list->get(i)->source(), path,
                     "must be a table, not " + kind_of(*list->get(i)));
    } else {
      result.emplace_back(*table, path, *mistakes_, logs_);
    }
  }
  return result;
}

void Section::finish() {
  if (ignores_) return;
  for (const auto& [key, value] : *table_) {
    if (std::find(known_.begin(), known_.end(), key.str()) != known_.end()) continue;
    const std::string similar = did_you_mean(key.str(), known_);
    const std::string allowed = known_.empty() ? "" : "; allowed: " + listed(known_);
    mistakes_->add(key.source(), path_to(key.str()),
                   "is no key here" + (similar.empty() ? allowed : similar));
  }
}

}  // namespace kreisel::detail
