#pragma once

namespace kreisel::detail {

/// One function object of several, for std::visit: each alternative has its own.
template <class... Cases>
struct Overloaded : Cases... {
  using Cases::operator()...;
};
template <class... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;

}  // namespace kreisel::detail
