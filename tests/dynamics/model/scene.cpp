// The concept of a scene, its optional hooks, and the messages about them.

#include <boost/test/unit_test.hpp>

#include <array>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <dynamics/model/scene.hpp>
#include <dynamics/rigid/euler_top.hpp>

using namespace kreisel;

namespace {

/// x' = -x
struct Decay {
  using Vector = Eigen::Matrix<double, 1, 1>;
  struct State {
    double x = 1;
  };
  static constexpr std::array<int, 1> blocks = {1};

  [[nodiscard]] Vector rates(double /*t*/, const Vector& y) const { return -y; }
  [[nodiscard]] static Vector to_vector(const State& s) { return Vector(s.x); }
  [[nodiscard]] static State from_vector(const Vector& y) { return {y[0]}; }
};

struct WithoutBlocks : Decay {
  static constexpr int blocks = 1;
};

struct Misspelt : Decay {
  [[nodiscard]] std::vector<std::pair<const char*, double>> conservd(double, const State&) const {
    return {};
  }
};

struct Unpaired : Decay {
  [[nodiscard]] std::vector<double> conserved(double, const State&) const { return {}; }
};

template <class S>
std::string hooks_of() {
  std::ostringstream text;
  text << check_scene<S>();
  return text.str();
}

}  // namespace

BOOST_AUTO_TEST_SUITE(scene)

BOOST_AUTO_TEST_CASE(needs_rates_states_and_blocks) {
  BOOST_TEST(Scene<Decay>);
  BOOST_TEST(Scene<EulerTop>);
  BOOST_TEST(!Scene<WithoutBlocks>);
  BOOST_TEST(!Scene<int>);
}

BOOST_AUTO_TEST_CASE(recognises_hooks_by_name_and_type) {
  BOOST_TEST(!HasConserved<Decay>);
  BOOST_TEST(!HasConserved<Misspelt>);
  BOOST_TEST(!HasConserved<Unpaired>);
  BOOST_TEST(HasConserved<EulerTop>);
  BOOST_TEST(HasDualRates<EulerTop>);
  BOOST_TEST(!HasDualRates<Decay>);
}

BOOST_AUTO_TEST_CASE(lists_the_hooks_of_a_scene) {
  for (const SceneHook& hook : check_scene<Decay>()) BOOST_TEST(!hook.recognised, hook.name);
  const std::string top = hooks_of<EulerTop>();
  BOOST_TEST(top.find("yes  conserved(t, state): RunReport::invariants\n") != std::string::npos);
  BOOST_TEST(top.find("no   tree(): ") != std::string::npos);
  const std::string decay = hooks_of<Decay>();
  BOOST_TEST(decay.find("no   series(): automatic integrates by verner98\n") != std::string::npos);
}

BOOST_AUTO_TEST_SUITE_END()
