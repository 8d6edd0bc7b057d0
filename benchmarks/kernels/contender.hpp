#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

/// Operations of the motor calculus by several libraries, on the same numbers.
namespace kernels {

constexpr std::size_t inputs = 64;  // fit the first-level cache; enough that nothing is a constant

/// The inputs. Motors are (resultant; moment), a pose is its rotation by columns and its
/// translation. An inertia is mass, first moment and tensor (xx yy zz xy xz yz) about the origin.
struct Numbers {
  std::array<double, 6> a, b;
  std::array<double, 12> pose, other;
  double mass;
  std::array<double, 3> centre;
  std::array<double, 6> tensor_about_centre;
  std::array<double, 10> inertia;
};

/// A contender that does one operation on the i-th of the numbers. It repeats the operation itself,
/// so that nothing else is between two operations.
struct Contender {
  std::string operation;
  std::string name;
  std::function<void(long calls)> run;
  std::function<std::vector<double>(std::size_t input)> answer;
};

/// Out of line, so that all contenders pay equally for call and result.
template <class Operation, class Input>
[[gnu::noinline]] auto call(const Operation& operation, const Input& input) {
  return operation(input);
}

/// Aligned, because otherwise some inputs of some libraries would lie across lines of the cache.
template <class Input>
struct alignas(64) OnLinesOfItsOwn {
  Input input;
};

/// `operate` works on one of `all`, the Numbers in a library's own forms. `flat` makes a list of
/// numbers of the result, in order.
template <class Input, class Operation, class Flat>
Contender contender(std::string operation, std::string name, const std::array<Input, inputs>& all,
                    Operation operate, Flat flat) {
  std::array<OnLinesOfItsOwn<Input>, inputs> apart;
  for (std::size_t i = 0; i < inputs; ++i) apart[i].input = all[i];
  return {std::move(operation), std::move(name),
          [apart, operate](long calls) {
            for (long n = 0; n < calls; ++n) {
              alignas(64) const auto result =
                  call(operate, apart[static_cast<std::size_t>(n) % inputs].input);
              asm volatile("" : : "r"(&result) : "memory");  // the result counts as used
            }
          },
          [all, operate, flat](std::size_t i) {
            const auto numbers = flat(operate(all[i]));
            return std::vector<double>(std::begin(numbers), std::end(numbers));
          }};
}

using All = std::array<Numbers, inputs>;

/// The numbers in a library's own forms, made by `make`.
template <class Make>
auto each(const All& numbers, Make make) {
  std::array<decltype(make(numbers[0])), inputs> result;
  for (std::size_t i = 0; i < inputs; ++i) result[i] = make(numbers[i]);
  return result;
}

[[nodiscard]] std::vector<Contender> by_hand(const All& numbers);
[[nodiscard]] std::vector<Contender> eigen(const All& numbers);
[[nodiscard]] std::vector<Contender> kreisel(const All& numbers);
[[nodiscard, gnu::visibility("default")]] std::vector<Contender> kdl(const All& numbers);
[[nodiscard, gnu::visibility("default")]] std::vector<Contender> simbody(const All& numbers);

/// All installed contenders on the same random numbers; kreisel first.
[[nodiscard]] std::vector<Contender> contenders();

}  // namespace kernels
