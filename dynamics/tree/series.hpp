#pragma once

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

#include <dynamics/guide/series.hpp>
#include <dynamics/rigid/packed_tensor.hpp>
#include <dynamics/tree/workspace.hpp>
#include <motor/api.hpp>
#include <motor/simd.hpp>

namespace kreisel::detail {

/// Whether all that acts in a tree has a series that is known: no loads, no rates that rotors are
/// asked for, and nothing that floats against another body.
KREISEL_API [[nodiscard]] bool knows_series(const BodyTree& tree);

/// The Taylor series of the motion of a tree, for TaylorSteps.
///
/// What the motion takes as forces is put together order by order, outwards and inwards along the
/// tree. Of order k it is linear in the accelerations of order k, with the mass matrix of where the
/// step begins: this is factored once for all orders, and no series is divided by another.
///
///   M dv_k = forces_k - (what the motion takes with dv_k = 0)
///
/// Each link stands on axes of its own, on which its inertia is constant and a joint's axis is z. Then
/// all products of series are, of a link, those that turn its parent's motion to its own axes and its
/// forces back, and the six of w w^t.
///
/// Source : recurrences for products: E. Hairer, S. P. Norsett, G. Wanner, Solving Ordinary
///          Differential Equations I, I.8
/// Cost   : linear in the number of bodies; an order takes half an evaluation of the field for one
///          link, up to 1.2 in a long chain (benchmarks/body_system.cpp)
/// Throws : as the field
class KREISEL_API TreeSeries {
 public:
  static constexpr int most_order = most_series_order;

  /// High orders take hardly longer than low ones, and a step takes an evaluation of the field besides.
  static constexpr double relative_order = 1.15;

  /// The field, which leaves the joints eliminated.
  using Field = std::function<void(double t, const Eigen::VectorXd& y, Eigen::VectorXd& rate,
                                   BodyWorkspace& w)>;
  /// u and g' at the guide's origin.
  using Felt = std::function<GuideSeries(double t, double h, int order)>;

  /// The tree has to outlive this.
  TreeSeries(const BodyTree& tree, bool guide_rests, Field field, Felt felt);

  /// Fills the columns 1 to `order` of c with the coefficients of the state in powers of
  /// (time - t)/h, for the motion that has column 0 at t.
  void operator()(double t, double h, int order, Eigen::Ref<Eigen::MatrixXd> c);

 private:
  template <class T>
  using Of = std::array<T, most_order + 1>;

  /// How a link moves against its parent, to what is asked here.
  enum class Way { still, turning, sliding, ball };

  /// A link. All vectors stand on its own axes where nothing else is said.
  struct Branch {
    Way way = Way::still;
    bool slides = false;  ///< alone, or while it turns: a screw
    bool floats = false;
    bool is_turned = true;   ///< by its parent: what it hangs on is no guide at rest
    bool hands_on = true;    ///< forces to a parent that is not the guide
    bool is_braked = false;  ///< floats, with joint forces on its place
    std::size_t parent = 0;
    std::size_t number = 0;  ///< among the sliders or among the balls
    int q = 0;               ///< rows of its coordinates and of its rates
    int v = 0;
    int rates = 0;                                           ///< where its rates begin among all
    Matrix3<double> own_axes = Matrix3<double>::Identity();  ///< from the body's axes to these
    Mat3dByDiagonals outwards;  ///< from the parent's own axes to those that the joint turns from
    Mat3dByDiagonals inwards;   ///< and back
    double mass = 0;
    CyclicVec4d first_moment;
    Mat3dByDiagonals tensor;
    GyroscopicDifferences gyroscopic = GyroscopicDifferences({});

    // Of where the step begins.
    CyclicVec4d r;     ///< from the parent's origin, on the parent's axes
    Vec4d first_turn;  ///< (w_x, w_y, 0, 0) of the parent, on the joint's axes

    // Of order k: what does not need the accelerations of this order.
    Vec4d squares, next;  ///< of w: (xx, yy, zz), (xy, yz, zx)
    Vec4d gyroscopic_moment;
    Vec4d outer, inner;  ///< sums for `turned` and `back`
    Vec4d carried;       ///< where it slides or floats: acceleration, on the parent's axes

    // And what does.
    CyclicVec4d w_next;  ///< of order k + 1
    CyclicVec4d dw;
    Vec4d a;                 ///< inertial acceleration of the origin, gravity taken off
    Mat3dByDiagonals gamma;  ///< skew(dw) + w w^t - w^2:  a + gamma r  is the acceleration at r
    Vec4d force, moment;

    // Series.
    Of<Vec4d> w, w_cycled;  ///< (x, y, z), (y, z, x)
    Of<double> cos, sin;    ///< of the angle that it turns by
    Of<Vec4d> turned;  ///< (w_x, w_y) of order k + 1 and (a_x, a_y), before the joint turns them
    Of<Vec4d> back;    ///< (f_x, f_y, n_x, n_y), before they are turned back

    void set_outwards(const Matrix3<double>& turn) {
      outwards = Mat3dByDiagonals::of(turn);
      inwards = Mat3dByDiagonals::of(turn.transpose());
    }
    inline void begin_products(std::size_t k);
    inline void add_product(std::size_t i, std::size_t j);
    inline void accelerate(double per_time);
  };

  /// What a link that slides has besides, on the parent's axes.
  struct Slider {
    CyclicVec4d axis;                  ///< as long as the way by one of the coordinate
    Vec4d lever;                   ///< moment of what it hands on, but for the newest
    Of<Vec4d> gamma_axis, w_axis;  ///< of the parent: gamma e, 2 w x e
    Of<Vec4d> moment;              ///< e x f
  };

  /// The sum of products m^t v, with the matrices by their diagonals.
  struct TransposedProducts {
    Vec4d main = {0, 0, 0, 0};
    Vec4d upper = {0, 0, 0, 0};
    Vec4d lower = {0, 0, 0, 0};

    void add(const Mat3dByDiagonals& m, const Vec4d& v) {
      main += m.main * v;
      upper += m.upper * v;
      lower += m.lower * v;
    }
    [[nodiscard]] Vec4d sum() const { return main + lower.next() + upper.after(); }
  };

  /// What a link that turns as a ball has besides.
  struct Ball {
    double scale = 0;       ///< 1/|q|^2
    Vec4d first_w;          ///< of the parent, on the joint's axes
    Vec4d w_sum, a_sum;     ///< of order k: of the parent, turned, without what is newest
    Vec4d f_sum, n_sum;     ///< of its own, turned back
    Of<Vec4d> q, q_cycled;  ///< (x, y, z, w), (y, z, x, w)
    Of<Mat3dByDiagonals> turn, turn_back;  ///< R, R^t
    Of<Vec4d> w, a;                        ///< of the parent, before the joint turns them
    Of<Vec4d> f, n;                        ///< of its own, before they are turned back
    Of<CyclicVec4d> place, slide;          ///< of what floats, on guide axes

    inline void put_attitude(std::size_t k, const Vec4d& coefficient);
  };

  struct Spin {
    std::size_t carrier = 0;
    int q = 0;
    int v = 0;
    bool regulated = false;
    double about = 0;
    Vec4d axis;
    Vec4d gyroscopic_moment;  ///< of order k
    Of<double> momentum;      ///< l
    Of<Vec4d> aside;          ///< w x e
  };

  using Columns = Eigen::Ref<Eigen::MatrixXd>;

  void begin(const Columns& c);

  /// Sums of what is known of order k, and the coordinates' coefficients of the next.
  void prepare(int k, double h, const GuideSeries& felt, Columns& c);
  void prepare_guide(std::size_t k, double per_time, const GuideSeries& felt);
  void prepare_turning(Branch& b, int k, double weight, Columns& c);
  void prepare_slider(Branch& b, int k, const Columns& c);
  void prepare_ball(Branch& b, int k, double weight, Columns& c);
  void prepare_floating(Branch& b, int k, double weight, Columns& c);
  void prepare_spins(int k, double weight, Columns& c);

  /// The motion of order k with the accelerations dv, and what it takes as forces.
  void go_outwards(std::size_t k, double weight, const double* dv);
  void go_inwards(std::size_t k);

  /// The joint forces of order k less what the motion takes of them.
  void set_left(int k, const Columns& c);

  /// The accelerations that bring it about.
  void prepare_response();
  const double* response();

  const BodyTree& tree_;
  bool guide_rests_;
  Field field_;
  Felt felt_;
  BodyWorkspace workspace_;
  Eigen::VectorXd y_, rate_, left_, still_;
  std::vector<Of<double>> timed_;  ///< joint forces that change with time
  std::vector<Branch> branches_;
  std::vector<Slider> sliders_;
  std::vector<Ball> balls_;
  std::vector<Spin> spins_;
  Of<Mat3dByDiagonals> guide_gamma_;

  /// Beyond which the mass matrix is not inverted: then linear time pays.
  static constexpr int most_inverted = 12;
  std::size_t fours_;  ///< of a column of the inverse, by four; 0 where it is not inverted
  std::vector<Vec4d> inverse_;
  std::array<double, most_inverted> dv_;
};

}  // namespace kreisel::detail
