#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <dynamics/file/scene_section.hpp>
#include <dynamics/signal/signal.hpp>

namespace kreisel::detail {

/// The signal of a table: { constant, rate, terms }, { steps }, { points } or { file }. Its values
/// have the dimension `of`. Notes mistakes in the table.
template <class Value>
[[nodiscard]] Signal<Value> read_signal_table(Section table, const KeyDimension& of);

/// The signal at a key: a constant number or vector, or a table. Returns nothing if the key is
/// missing or its value is wrong.
template <class Value>
[[nodiscard]] std::optional<Signal<Value>> read_signal(Section& section, std::string_view key,
                                                       const KeyDimension& of);

/// One signal for all dimensions of `each`, or a signal for each in brackets. Returns none if the key
/// is missing or its value is wrong.
[[nodiscard]] std::vector<Signal<double>> read_signals(Section& section, std::string_view key,
                                                       const std::vector<Dimension>& each);

/// The signal of an angle or its rate: at the key, or at key_deg in degrees.
[[nodiscard]] std::optional<Signal<double>> read_angle_signal(Section& section,
                                                              const std::string& key,
                                                              const Dimension& of);

}  // namespace kreisel::detail
