#include <Eigen/Core>
#include <boost/test/unit_test.hpp>

#include <cstddef>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include <motor/print.hpp>

#include <support/everything.hpp>
#include <support/heap.hpp>

/// No function of motor/ or of the laws allocates memory.

using namespace kreisel;
using test::heap::requests_of;

namespace {

/// Prevents the compiler from removing unused results.
template <class T>
void use(const T& value) {
  asm volatile("" : : "r"(&value) : "memory");
}

void run_everything() {
  test::everything(test::Inputs<double>{}, [](const double& x) { use(x); });
}

}  // namespace

// First a test of the counter itself: a test that cannot fail shows nothing.
BOOST_AUTO_TEST_SUITE(the_allocation_counter)

BOOST_AUTO_TEST_CASE(counts_operator_new) {
  BOOST_TEST(requests_of([] { use(std::make_unique<int>(1)); }) == 1u);
  BOOST_TEST(requests_of([] { use(std::make_unique<int[]>(9)); }) == 1u);
  BOOST_TEST(requests_of([] { use(std::vector<double>(9)); }) == 1u);
  BOOST_TEST(requests_of([] { use(std::string(99, 'x')); }) == 1u);
}

BOOST_AUTO_TEST_CASE(counts_malloc) {
  const auto release = [](void* memory) {
    use(memory);
    std::free(memory);
  };
  BOOST_TEST(requests_of([&] { release(std::malloc(9)); }) == 1u);
  BOOST_TEST(requests_of([&] { release(std::calloc(9, 9)); }) == 1u);
  BOOST_TEST(requests_of([&] { release(std::realloc(nullptr, 9)); }) == 1u);
  BOOST_TEST(requests_of([&] { release(std::aligned_alloc(64, 64)); }) == 1u);
}

// Allocations by mistake: a matrix of dynamic size, and a product evaluated into one.
BOOST_AUTO_TEST_CASE(counts_matrices_of_eigen) {
  BOOST_TEST(requests_of([] { use(Eigen::VectorXd(3)); }) == 1u);
  const Vector3<double> a(1, 2, 3);
  BOOST_TEST(requests_of([&] { use(Eigen::MatrixXd(a * a.transpose())); }) >= 1u);
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(every_function)

BOOST_AUTO_TEST_CASE(allocates_no_memory) { BOOST_TEST(requests_of(run_everything) == 0u); }

BOOST_AUTO_TEST_SUITE_END()
