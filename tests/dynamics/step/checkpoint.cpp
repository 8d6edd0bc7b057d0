#include <Eigen/Core>
#include <boost/test/unit_test.hpp>

#include <cmath>
#include <cstddef>
#include <vector>

#include <dynamics/step/checkpoint.hpp>

using kreisel::InvalidInput;
using kreisel::detail::Checkpoint;

namespace {

struct Numbers {
  Eigen::Vector2d fixed = {1, 2};
  Eigen::VectorXd any = Eigen::Vector3d(3, 4, 5);
  int whole = 6;

  void pass(Checkpoint& checkpoint) { checkpoint(fixed, any, whole); }
};

void set(const std::vector<double>& numbers) {
  Numbers to{{0, 0}, {}, 0};
  Checkpoint checkpoint(numbers);
  to.pass(checkpoint);
  checkpoint.finish();
  BOOST_TEST(to.fixed == Numbers().fixed);
  BOOST_TEST(to.any == Numbers().any);
  BOOST_TEST(to.whole == 6);
}

}  // namespace

BOOST_AUTO_TEST_SUITE(a_checkpoint)

// First the number of values, then the values; other numbers of values belong to another run.
BOOST_AUTO_TEST_CASE(restores_its_numbers_and_refuses_others) {
  Checkpoint taken;
  Numbers from;
  from.pass(taken);
  const std::vector<double> numbers = taken.numbers();
  BOOST_TEST(numbers == (std::vector<double>{2, 1, 1, 2, 3, 1, 3, 4, 5, 6}));
  set(numbers);
  const auto refuses = [&](std::size_t place, double number) {
    std::vector<double> changed = numbers;
    changed[place] = number;
    BOOST_CHECK_THROW(set(changed), InvalidInput);
  };
  for (const double other : {-1.0, 0.0, 3.0, 100.0, 1e17, double(NAN)}) refuses(0, other);
  for (const double other : {0.0, 2.0, 100.0}) refuses(1, other);
  for (const double other : {-1.0, 2.0, 4.0, 100.0, double(HUGE_VAL)}) refuses(4, other);
  for (const double other : {0.0, 2.0, 100.0}) refuses(5, other);
  for (const double other : {-1.0, 1e16, double(NAN)}) refuses(9, other);
  std::vector<double> longer = numbers;
  longer.push_back(0);
  BOOST_CHECK_THROW(set(longer), InvalidInput);
}

BOOST_AUTO_TEST_SUITE_END()
