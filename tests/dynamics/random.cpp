#include <boost/test/unit_test.hpp>

#include <cmath>
#include <cstdint>
#include <set>

#include <dynamics/random.hpp>

using namespace kreisel;

BOOST_AUTO_TEST_SUITE(the_random_numbers_of_a_member)

// kat_vectors of Random123, the authors' own program.
BOOST_AUTO_TEST_CASE(agree_with_philox) {
  using Block = MemberRandom::Block;
  constexpr std::uint32_t ones = 0xFFFFFFFF;
  BOOST_TEST((MemberRandom::philox({0, 0, 0, 0}, {0, 0}) ==
              Block{0x6627E8D5, 0xE169C58D, 0xBC57AC4C, 0x9B00DBD8}));
  BOOST_TEST((MemberRandom::philox({ones, ones, ones, ones}, {ones, ones}) ==
              Block{0x408F276D, 0x41C83B0E, 0xA20BC7C6, 0x6D5451FD}));
  BOOST_TEST((MemberRandom::philox({0x243F6A88, 0x85A308D3, 0x13198A2E, 0x03707344},
                                   {0xA4093822, 0x299F31D0}) ==
              Block{0xD16CFE09, 0x94FDCCEB, 0x5001E420, 0x24126EA1}));
}

BOOST_AUTO_TEST_CASE(take_all_four_words_of_each_block) {
  MemberRandom random(0, 0);
  BOOST_TEST(random.bits() == 0xE169C58D6627E8D5U);
  BOOST_TEST(random.bits() == 0x9B00DBD8BC57AC4CU);
  const auto next = MemberRandom::philox({1, 0, 0, 0}, {0, 0});
  BOOST_TEST(random.bits() == (std::uint64_t{next[1]} << 32 | next[0]));
}

BOOST_AUTO_TEST_CASE(differ_by_seed_index_and_count) {
  std::set<std::uint64_t> seen;
  for (const std::uint64_t seed : {0ULL, 1ULL, 1ULL << 32}) {
    for (const std::uint64_t index : {0ULL, 1ULL, 2ULL, 1ULL << 32}) {
      MemberRandom random(seed, index);
      for (int i = 0; i < 100; ++i) seen.insert(random.bits());
    }
  }
  BOOST_TEST(seen.size() == 3U * 4U * 100U);
}

// Means of n numbers: within five of their standard deviations, for this fixed seed.
BOOST_AUTO_TEST_CASE(have_their_distributions) {
  constexpr int n = 200000;
  MemberRandom random(7, 3);
  double uniform = 0, uniform_squares = 0, normal = 0, squares = 0, fourth = 0;
  for (int i = 0; i < n; ++i) {
    const double x = random.uniform();
    BOOST_REQUIRE((x >= 0 && x < 1));
    uniform += x / n;
    uniform_squares += x * x / n;
    const double z = random.normal();
    normal += z / n;
    squares += z * z / n;
    fourth += z * z * z * z / n;
  }
  const double root = std::sqrt(n);
  BOOST_TEST(std::abs(uniform - 0.5) < 5 * std::sqrt(1.0 / 12) / root);
  BOOST_TEST(std::abs(uniform_squares - 1.0 / 3) < 5 * std::sqrt(4.0 / 45) / root);
  BOOST_TEST(std::abs(normal) < 5 / root);
  BOOST_TEST(std::abs(squares - 1) < 5 * std::sqrt(2.0) / root);
  BOOST_TEST(std::abs(fourth - 3) < 5 * std::sqrt(96.0) / root);
}

BOOST_AUTO_TEST_SUITE_END()
