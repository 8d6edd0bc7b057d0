#pragma once

#include <concepts>
#include <tuple>
#include <type_traits>
#include <utility>

#include <dynamics/guide/motion.hpp>

namespace kreisel {

namespace detail {

/// True if each motion is relative to the frame of the motion before it.
template <class...>
inline constexpr bool join = true;

template <class Outer, class Inner, class... Rest>
inline constexpr bool join<Outer, Inner, Rest...> =
    std::is_same_v<typename Inner::Against, typename Outer::Of>&& join<Inner, Rest...>;

}  // namespace detail

/// A chain of frames, each of which moves against the one before; the last frame is the guide
/// (carrier frame).
///
///   const Chain guide(earth, ship, device);  // <Earth, Inertial>, <Ship, Earth>, <Guide, Ship>
///
/// A link that does not start in the frame where the link before ends does not compile.
template <class... Links>
class Chain {
  static_assert(detail::join<decltype(std::declval<const Links&>()(0))...>,
                "each link of a chain moves against the frame of the link before");

 public:
  explicit Chain(Links... links) : links_(std::move(links)...) {}

  template <class S>
  requires(std::invocable<const Links&, const S&>&&...) [[nodiscard]] auto operator()(
      const S& t) const {
    return std::apply(
        [&t](const auto& first, const auto&... rest) { return joined(first(t), rest(t)...); },
        links_);
  }

 private:
  template <class Motion>
  [[nodiscard]] static Motion joined(const Motion& motion) {
    return motion;
  }

  template <class Outer, class Inner, class... Rest>
  [[nodiscard]] static auto joined(const Outer& outer, const Inner& inner, const Rest&... rest) {
    return joined(outer * inner, rest...);
  }

  std::tuple<Links...> links_;
};

}  // namespace kreisel
