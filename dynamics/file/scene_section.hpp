#pragma once

// Knows toml++: for the .cpp files of this folder alone.
#include <Eigen/Geometry>

#include <optional>
#include <string>
#include <string_view>
#include <toml++/toml.h>
#include <vector>

#include <motor/motor.hpp>

namespace kreisel::detail {

inline constexpr double radian_per_degree = 0.017453292519943295;  ///< rad

/// What is wrong with a file, line by line.
class Mistakes {
 public:
  explicit Mistakes(std::string file) : file_(std::move(file)) {}

  void add(const toml::source_region& where, std::string_view key, std::string_view reason);

  /// Throws : SceneMistakes with all of them in the order of the file, if there are any
  void throw_any() const;

  [[nodiscard]] bool none() const { return list_.empty(); }
  [[nodiscard]] std::size_t count() const { return list_.size(); }

 private:
  struct Mistake {
    toml::source_position where;
    std::string text;
  };

  std::string file_;
  std::vector<Mistake> list_;
};

/// Of the words the one that was probably meant, in the form " (did you mean 'x'?)"; empty where
/// none is near.
[[nodiscard]] std::string did_you_mean(std::string_view word,
                                       const std::vector<std::string>& words);

/// Bounds of a number.
enum class Range { any, not_negative, positive };

/// A table of the file while it is read. What is asked for is known; finish() tells what else was
/// there. A mistake is noted, and some legal value handed out, so that reading can go on.
class Section {
 public:
  Section(const toml::table& table, std::string path, Mistakes& mistakes)
      : table_(&table), path_(std::move(path)), mistakes_(&mistakes) {}

  /// A table in a list at a key.
  [[nodiscard]] Section element(std::string_view key, std::size_t index,
                                const toml::table& table) const {
    return {table, path_to(key) + "[" + std::to_string(index) + "]", *mistakes_};
  }

  [[nodiscard]] bool has(std::string_view key);

  /// Notes a mistake of the value at that key, or of the section where it has none.
  void refuse(std::string_view key, std::string_view reason);
  /// Notes a mistake of the section as a whole.
  void refuse_all(std::string_view reason);

  [[nodiscard]] std::optional<double> number(std::string_view key, Range range = Range::any);
  [[nodiscard]] double required_number(std::string_view key, Range range = Range::any);

  /// An angle, or its rate: the key itself, or key_deg in degrees.
  [[nodiscard]] std::optional<double> angle(const std::string& key);

  [[nodiscard]] std::optional<std::vector<double>> numbers(std::string_view key);
  [[nodiscard]] std::optional<std::vector<double>> numbers(std::string_view key, std::size_t count);
  /// One number if `count` is 1, else `count` in brackets; angles as angle() takes them.
  [[nodiscard]] std::optional<std::vector<double>> angles(const std::string& key,
                                                          std::size_t count);
  /// One number, which then counts `count` times, or `count` in brackets.
  [[nodiscard]] std::optional<std::vector<double>> number_or_list(std::string_view key,
                                                                  std::size_t count);
  /// The same of angles: the key itself, or key_deg in degrees.
  [[nodiscard]] std::optional<std::vector<double>> angle_or_list(const std::string& key,
                                                                 std::size_t count);
  [[nodiscard]] std::optional<Vector3<double>> vector(std::string_view key);
  [[nodiscard]] Vector3<double> required_vector(std::string_view key);

  /// A list of  [time, value],  value being one number or `width` in brackets: rows of the time and
  /// the numbers. Times have to increase.
  [[nodiscard]] std::optional<std::vector<std::vector<double>>> timed_rows(std::string_view key,
                                                                           std::size_t width);

  /// One number as a list.
  [[nodiscard]] std::optional<std::vector<double>> single(std::string_view key);

  [[nodiscard]] std::optional<std::string> text(std::string_view key);
  /// A list of texts; empty where it is not there.
  [[nodiscard]] std::vector<std::string> texts(std::string_view key);
  /// A text that is there, or nothing; notes no mistake.
  [[nodiscard]] std::string peek(std::string_view key) const;
  [[nodiscard]] std::string required_text(std::string_view key);
  [[nodiscard]] bool flag(std::string_view key);

  /// One of the words, or the first of them where the key is missing or wrong.
  [[nodiscard]] std::string choice(std::string_view key, const std::vector<std::string>& words);
  [[nodiscard]] std::string required_choice(std::string_view key,
                                            const std::vector<std::string>& words);

  [[nodiscard]] std::optional<Section> section(std::string_view key);
  [[nodiscard]] std::optional<Section> required_section(std::string_view key);
  /// A list of tables.
  [[nodiscard]] std::vector<Section> sections(std::string_view key);

  /// The keys that are there, in the order of the alphabet.
  [[nodiscard]] std::vector<std::string> keys() const;

  [[nodiscard]] const toml::node* find(std::string_view key);
  void refuse_missing(std::string_view key);

  /// Passes over what else the section holds.
  void ignore_rest() { ignores_ = true; }

  /// Notes the keys that nobody asked for.
  void finish();

  /// The section's name in messages.
  void rename(std::string path) { path_ = std::move(path); }

 private:
  [[nodiscard]] std::string path_to(std::string_view key) const;
  [[nodiscard]] std::optional<double> number_in(const toml::node& node, const std::string& key,
                                                Range range);
  [[nodiscard]] std::optional<std::vector<double>> numbers_in(const toml::node& node,
                                                              const std::string& key);
  [[nodiscard]] std::optional<std::vector<double>> timed_row_in(const toml::node& node,
                                                                const std::string& key,
                                                                std::size_t width);
  /// What `read` returns for the key, or for key_deg turned into radian.
  template <class Read>
  [[nodiscard]] std::optional<std::vector<double>> in_radian(const std::string& key,
                                                             const Read& read);

  const toml::table* table_;
  std::string path_;
  Mistakes* mistakes_;
  std::vector<std::string> known_;
  bool ignores_ = false;
};

/// A quaternion [w, x, y, z] of norm 1, but for what rounding to a few digits takes; normalised.
[[nodiscard]] std::optional<Eigen::Quaterniond> quaternion(Section& section, std::string_view key);

}  // namespace kreisel::detail
