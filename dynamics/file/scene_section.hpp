#pragma once

// Includes toml++: only for the .cpp files of this folder.
#include <Eigen/Geometry>

#include <optional>
#include <string>
#include <string_view>
#include <toml++/toml.h>
#include <utility>
#include <vector>

#include <dynamics/file/did_you_mean.hpp>
#include <dynamics/file/unit.hpp>
#include <motor/motor.hpp>

namespace kreisel::detail {

/// The mistakes in a file, with their lines.
class Mistakes {
 public:
  explicit Mistakes(std::string file) : file_(std::move(file)) {}

  void add(const toml::source_region& where, std::string_view key, std::string_view reason);

  /// Throws : SceneMistakes with all mistakes, if there are any: first those in the file, in its
  ///          order, then those in values from outside of it
  void throw_any() const;

  [[nodiscard]] bool none() const { return list_.empty(); }
  [[nodiscard]] std::size_t count() const { return list_.size(); }

 private:
  struct Mistake {
    std::string place;  ///< of a value that is not in the file
    toml::source_position where;
    std::string text;

    friend bool operator==(const Mistake&, const Mistake&) = default;
  };

  std::string file_;
  std::vector<Mistake> list_;
};

class SignalLogs;

/// Bounds of a number.
enum class Range { any, not_negative, positive };

/// A time in a message, in 15 digits.
[[nodiscard]] std::string shown_time(double t);

/// A table of the file while it is read. Each key that is requested counts as known; finish()
/// reports all others as mistakes. After a mistake the reader gets a legal value and continues.
class Section {
 public:
  /// `logs` collects the logs of functions of time in the section.
  Section(const toml::table& table, std::string path, Mistakes& mistakes,
          SignalLogs* logs = nullptr)
      : table_(&table), path_(std::move(path)), mistakes_(&mistakes), logs_(logs) {}

  [[nodiscard]] SignalLogs* signal_logs() const { return logs_; }
  [[nodiscard]] std::size_t mistakes() const { return mistakes_->count(); }

  /// The section of a table in a list.
  [[nodiscard]] Section element(std::string_view key, std::size_t index,
                                const toml::table& table) const {
    return {table, path_to(key) + "[" + std::to_string(index) + "]", *mistakes_, logs_};
  }

  [[nodiscard]] bool has(std::string_view key);

  /// Notes a mistake in the value of a key, or in the section if it has no such key.
  void refuse(std::string_view key, std::string_view reason);
  /// Notes a mistake in the section as a whole.
  void refuse_all(std::string_view reason);

  /// True if the value of a key is a number, possibly as a text with a unit.
  [[nodiscard]] bool has_number(std::string_view key);

  // The readers of numbers. `of` is the dimension of a number: a text with a unit must have it.

  [[nodiscard]] std::optional<double> number(std::string_view key, const KeyDimension& of,
                                             Range range = Range::any);
  [[nodiscard]] double required_number(std::string_view key, const KeyDimension& of,
                                       Range range = Range::any);

  /// An angle, its rate or the like: the value of the key, or of key_deg in degrees.
  [[nodiscard]] std::optional<double> angle(const std::string& key, const Dimension& of);

  [[nodiscard]] std::optional<std::vector<double>> numbers(std::string_view key,
                                                           const KeyDimension& of);
  [[nodiscard]] std::optional<std::vector<double>> numbers(std::string_view key, std::size_t count,
                                                           const KeyDimension& of);
  /// One number if `count` is 1, else `count` numbers in brackets; angles as in angle().
  [[nodiscard]] std::optional<std::vector<double>> angles(const std::string& key, std::size_t count,
                                                          const Dimension& of);
  /// One number, repeated `count` times, or `count` numbers in brackets.
  [[nodiscard]] std::optional<std::vector<double>> number_or_list(std::string_view key,
                                                                  std::size_t count,
                                                                  const KeyDimension& of);
  /// The same with a dimension for each number. One number must have all of them.
  [[nodiscard]] std::optional<std::vector<double>> number_or_list(
      std::string_view key, const std::vector<Dimension>& each);
  /// One angle or `count` angles in brackets: the value of the key, or of key_deg in degrees.
  [[nodiscard]] std::optional<std::vector<double>> angle_or_list(const std::string& key,
                                                                 std::size_t count,
                                                                 const Dimension& of);
  [[nodiscard]] std::optional<Vector3<double>> vector(std::string_view key, const Dimension& of);
  [[nodiscard]] Vector3<double> required_vector(std::string_view key, const Dimension& of);

  /// A matrix: 3 numbers are its diagonal, or 3 rows of 3 numbers.
  [[nodiscard]] std::optional<Matrix3<double>> matrix(std::string_view key, const Dimension& of);

  /// A list of  [time, value].  A value is one number or `width` numbers in brackets. Returns rows
  /// of the time and the numbers. Times must increase.
  [[nodiscard]] std::optional<std::vector<std::vector<double>>> timed_rows(std::string_view key,
                                                                           std::size_t width,
                                                                           const KeyDimension& of);

  /// One number as a list.
  [[nodiscard]] std::optional<std::vector<double>> single(std::string_view key,
                                                          const KeyDimension& of);
  /// The number at an index of a list.
  [[nodiscard]] std::optional<double> number_at(std::string_view key, std::size_t index,
                                                const toml::node& node, const KeyDimension& of);

  /// The vector at an index of a list.
  [[nodiscard]] std::optional<Vector3<double>> vector_at(std::string_view key, std::size_t index,
                                                         const toml::node& node,
                                                         const Dimension& of);
  /// A list of pairs of numbers.
  [[nodiscard]] std::optional<std::vector<std::pair<double, double>>> pairs(
      std::string_view key, const Dimension& first, const Dimension& second);

  [[nodiscard]] std::optional<std::string> text(std::string_view key);
  /// A list of texts; empty if the key is missing.
  [[nodiscard]] std::vector<std::string> texts(std::string_view key);
  /// The text at a key, or an empty text; notes no mistake.
  [[nodiscard]] std::string peek(std::string_view key) const;
  [[nodiscard]] std::string required_text(std::string_view key);
  [[nodiscard]] bool flag(std::string_view key);

  /// One of the words; the first of them if the key is missing or wrong.
  [[nodiscard]] std::string choice(std::string_view key, const std::vector<std::string>& words);
  [[nodiscard]] std::string required_choice(std::string_view key,
                                            const std::vector<std::string>& words);

  [[nodiscard]] std::optional<Section> section(std::string_view key);
  [[nodiscard]] std::optional<Section> required_section(std::string_view key);
  /// A list of tables.
  [[nodiscard]] std::vector<Section> sections(std::string_view key);

  /// The keys of the section, in alphabetical order.
  [[nodiscard]] std::vector<std::string> keys() const;

  [[nodiscard]] const toml::node* find(std::string_view key);
  void refuse_missing(std::string_view key);

  /// Ignores all keys that are not read.
  void ignore_rest() { ignores_ = true; }

  /// Notes every key that was not requested.
  void finish();

  /// Sets the section's name in messages.
  void rename(std::string path) { path_ = std::move(path); }

 private:
  [[nodiscard]] std::string path_to(std::string_view key) const;
  [[nodiscard]] std::optional<double> number_in(const toml::node& node, const std::string& key,
                                                const KeyDimension& of, Range range = Range::any);
  /// Reads a list of numbers. Those after the last dimension have the last one, too.
  [[nodiscard]] std::optional<std::vector<double>> numbers_in(const toml::node& node,
                                                              const std::string& key,
                                                              const std::vector<KeyDimension>& of);
  [[nodiscard]] std::optional<std::vector<double>> counted(
      std::string_view key, std::size_t count, std::optional<std::vector<double>> values);
  [[nodiscard]] std::optional<std::vector<double>> timed_row_in(const toml::node& node,
                                                                const std::string& key,
                                                                std::size_t width,
                                                                const KeyDimension& of);
  /// The result of `read` for the key, or for key_deg, converted to radian.
  template <class Read>
  [[nodiscard]] std::optional<std::vector<double>> in_radian(const std::string& key,
                                                             const Dimension& of, const Read& read);

  const toml::table* table_;
  std::string path_;
  Mistakes* mistakes_;
  SignalLogs* logs_;
  std::vector<std::string> known_;
  bool ignores_ = false;
};

/// A quaternion [w, x, y, z] of norm 1, except for rounding to a few digits; normalised.
[[nodiscard]] std::optional<Eigen::Quaterniond> quaternion(Section& section, std::string_view key);

}  // namespace kreisel::detail
