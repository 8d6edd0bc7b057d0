#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <dynamics/file/scene_section.hpp>
#include <dynamics/signal/signal.hpp>

namespace kreisel::detail {

/// The signal of a table: { constant, rate, terms }, { steps } or { points }. Notes mistakes in the
/// table.
template <class Value>
[[nodiscard]] Signal<Value> read_signal_table(Section table);

/// The signal at a key: a constant number or vector, or a table. Returns nothing if the key is
/// missing or its value is wrong.
template <class Value>
[[nodiscard]] std::optional<Signal<Value>> read_signal(Section& section, std::string_view key);

/// One signal, repeated `count` times, or `count` signals in brackets. Returns none if the key is
/// missing or its value is wrong.
[[nodiscard]] std::vector<Signal<double>> read_signals(Section& section, std::string_view key,
                                                       std::size_t count);

/// The signal of an angle or its rate: at the key, or at key_deg in degrees.
[[nodiscard]] std::optional<Signal<double>> read_angle_signal(Section& section,
                                                              const std::string& key);

}  // namespace kreisel::detail
