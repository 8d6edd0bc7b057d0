// A scene whose hook is misspelt: its invariants would not be monitored.
// refused: HasConserved<Top>
#include <array>
#include <utility>

#include <dynamics/model/scene.hpp>

struct Top {
  using Vector = Eigen::Matrix<double, 1, 1>;
  struct State {
    double angle = 0;
  };
  static constexpr std::array<int, 1> blocks = {1};
  using Conserved = std::array<std::pair<const char*, double>, 1>;

  Vector rates(double, const Vector& y) const { return y; }
  static Vector to_vector(const State& s) { return Vector(s.angle); }
  static State from_vector(const Vector& y) { return {y[0]}; }
#ifdef MISUSE
  Conserved conservd(double, const State&) const { return {}; }
#else
  Conserved conserved(double, const State&) const { return {}; }
#endif
};

static_assert(kreisel::Scene<Top>);
static_assert(kreisel::HasConserved<Top>);
