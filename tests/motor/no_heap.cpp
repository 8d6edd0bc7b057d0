#include <Eigen/Core>
#include <boost/test/unit_test.hpp>

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>
#include <sstream>
#include <string>
#include <vector>

#include <motor/print.hpp>

#include <support/everything.hpp>

/// No function of motor/ or of the laws asks for memory. Counted: every operator new, and every
/// malloc, calloc, realloc, aligned_alloc and posix_memalign called from this file, which is where
/// header-only code is; the linker passes them through here (--wrap).

namespace {

std::size_t requests = 0;

}  // namespace

extern "C" {

void* __real_malloc(std::size_t);
void* __real_calloc(std::size_t, std::size_t);
void* __real_realloc(void*, std::size_t);
void* __real_aligned_alloc(std::size_t, std::size_t);
int __real_posix_memalign(void**, std::size_t, std::size_t);

void* __wrap_malloc(std::size_t size) {
  ++requests;
  return __real_malloc(size);
}
void* __wrap_calloc(std::size_t count, std::size_t size) {
  ++requests;
  return __real_calloc(count, size);
}
void* __wrap_realloc(void* old, std::size_t size) {
  ++requests;
  return __real_realloc(old, size);
}
void* __wrap_aligned_alloc(std::size_t alignment, std::size_t size) {
  ++requests;
  return __real_aligned_alloc(alignment, size);
}
int __wrap_posix_memalign(void** result, std::size_t alignment, std::size_t size) {
  ++requests;
  return __real_posix_memalign(result, alignment, size);
}
}

// Not inline, or the compiler sees through delete to free and finds no malloc at the other end.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++requests;
  if (void* memory = __real_malloc(size)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new[](std::size_t size) { return operator new(size); }
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete[](void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }

using namespace kreisel;

namespace {

/// How often the action asks for memory.
template <class Action>
std::size_t requests_of(const Action& action) {
  const std::size_t before = requests;
  action();
  return requests - before;
}

/// Keeps the compiler from leaving out what nobody reads.
template <class T>
void use(const T& value) {
  asm volatile("" : : "r"(&value) : "memory");
}

void run_everything() {
  test::everything(test::Inputs<double>{}, [](const double& x) { use(x); });
}

}  // namespace

// First that the counter counts: a test that cannot fail shows nothing.
BOOST_AUTO_TEST_SUITE(the_counter)

BOOST_AUTO_TEST_CASE(sees_the_operators) {
  BOOST_TEST(requests_of([] { use(std::make_unique<int>(1)); }) == 1u);
  BOOST_TEST(requests_of([] { use(std::make_unique<int[]>(9)); }) == 1u);
  BOOST_TEST(requests_of([] { use(std::vector<double>(9)); }) == 1u);
  BOOST_TEST(requests_of([] { use(std::string(99, 'x')); }) == 1u);
}

BOOST_AUTO_TEST_CASE(sees_the_functions) {
  const auto release = [](void* memory) {
    use(memory);
    std::free(memory);
  };
  BOOST_TEST(requests_of([&] { release(std::malloc(9)); }) == 1u);
  BOOST_TEST(requests_of([&] { release(std::calloc(9, 9)); }) == 1u);
  BOOST_TEST(requests_of([&] { release(std::realloc(nullptr, 9)); }) == 1u);
  BOOST_TEST(requests_of([&] { release(std::aligned_alloc(64, 64)); }) == 1u);
}

// What would creep in by mistake: a matrix of unknown size, a product evaluated into one.
BOOST_AUTO_TEST_CASE(sees_the_matrices_of_eigen) {
  BOOST_TEST(requests_of([] { use(Eigen::VectorXd(3)); }) == 1u);
  const Vector3<double> a(1, 2, 3);
  BOOST_TEST(requests_of([&] { use(Eigen::MatrixXd(a * a.transpose())); }) >= 1u);
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(every_function)

BOOST_AUTO_TEST_CASE(does_without_memory) { BOOST_TEST(requests_of(run_everything) == 0u); }

BOOST_AUTO_TEST_SUITE_END()
