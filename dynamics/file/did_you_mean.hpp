#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace kreisel::detail {

/// Suggests the most similar of the words, in the form " (did you mean 'x'?)"; empty if none is
/// similar.
[[nodiscard]] std::string did_you_mean(std::string_view word,
                                       const std::vector<std::string>& words);

}  // namespace kreisel::detail
