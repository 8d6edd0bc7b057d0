#pragma once

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <vector>

#include <dynamics/rigid/packed_tensor.hpp>
#include <dynamics/tree/load_series.hpp>
#include <dynamics/tree/series.hpp>
#include <motor/simd.hpp>

namespace kreisel::detail {

/// The recurrences of a tree's Taylor series.
///
/// Outward and inward passes compute the inertia forces order by order. At order k they are linear
/// in the accelerations of order k, with the mass matrix at the beginning of the step. It is
/// factored once for all orders, and no series is divided by another:
///
///   M dv_k = forces_k - (inertia forces with dv_k = 0)
///
/// Each link has axes on which its inertia is constant and its joint's axis is z. Products of
/// series are then needed only to rotate motions outwards and forces inwards, and for the six of w
/// w^t.
class TreeSeries::Recurrences {
 public:
  Recurrences(const BodyTree& tree, bool guide_rests, Field field, Felt felt, Attitude attitude);

  /// As TreeSeries.
  void operator()(double t, double h, int order, Eigen::Ref<Eigen::MatrixXd>& c);

 private:
  template <class T>
  using Of = std::array<T, most_order + 1>;

  /// The motion of a link relative to its parent.
  enum class Way { still, turning, sliding, ball };

  /// A link. All vectors are on its own axes unless stated otherwise.
  struct Branch {
    Way way = Way::still;
    bool slides = false;  ///< alone, or while it rotates: a screw
    bool floats = false;
    bool is_turned = true;   ///< by its parent: false on a guide at rest
    bool hands_on = true;    ///< its parent is not the guide and needs its forces
    bool is_braked = false;  ///< floats, with joint forces on its position
    std::size_t parent = 0;
    std::size_t number = 0;  ///< among the sliders or among the balls
    int q = 0;               ///< rows of its coordinates and of its rates
    int v = 0;
    int rates = 0;                                           ///< where its rates begin among all
    Matrix3<double> own_axes = Matrix3<double>::Identity();  ///< from the body's axes to these
    Mat3dByDiagonals outwards;  ///< from the parent's own axes to the joint's at angle 0
    Mat3dByDiagonals inwards;   ///< the inverse
    double mass = 0;
    CyclicVec4d first_moment;
    Mat3dByDiagonals tensor;
    GyroscopicDifferences gyroscopic = GyroscopicDifferences({});

    // Values at the beginning of the step.
    CyclicVec4d r;     ///< from the parent's origin, on the parent's axes
    Vec4d first_turn;  ///< (w_x, w_y, 0, 0) of the parent, on the joint's axes

    // Order k: quantities that do not depend on the accelerations of this order.
    Vec4d squares, next;  ///< of w: (xx, yy, zz), (xy, yz, zx)
    Vec4d gyroscopic_moment;
    Vec4d outer, inner;  ///< sums for `turned` and `back`
    Vec4d carried;       ///< where it slides or floats: acceleration, on the parent's axes

    // Order k: quantities that do.
    CyclicVec4d w_next;  ///< of order k + 1
    CyclicVec4d dw;
    Vec4d a;                 ///< inertial acceleration of the origin, gravity taken off
    Mat3dByDiagonals gamma;  ///< skew(dw) + w w^t - w^2:  a + gamma r  is the acceleration at r
    Vec4d force, moment;

    // Series.
    Of<Vec4d> w, w_cycled;  ///< (x, y, z), (y, z, x)
    Of<double> cos, sin;    ///< of the joint's angle
    Of<Vec4d> turned;  ///< (w_x, w_y) of order k + 1 and (a_x, a_y), before the joint's rotation
    Of<Vec4d> back;    ///< (f_x, f_y, n_x, n_y), before the rotation back

    void set_outwards(const Matrix3<double>& turn) {
      outwards = Mat3dByDiagonals::of(turn);
      inwards = Mat3dByDiagonals::of(turn.transpose());
    }
    inline void begin_products(std::size_t k);
    inline void add_product(std::size_t i, std::size_t j);
    inline void accelerate(double per_time);
  };

  /// Further quantities of a link that slides, on the parent's axes.
  struct Slider {
    CyclicVec4d axis;              ///< length: displacement per unit of the coordinate
    Vec4d lever;                   ///< moment of the transmitted force, without its newest order
    Of<Vec4d> gamma_axis, w_axis;  ///< with the parent's gamma and w: gamma e, 2 w x e
    Of<Vec4d> moment;              ///< e x f
  };

  /// The sum of products m^t v, with the matrices stored by diagonals.
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

  /// Further quantities of a spherical or free link.
  struct Ball {
    double scale = 0;       ///< 1/|q|^2
    Vec4d first_w;          ///< of the parent, on the joint's axes
    Vec4d w_sum, a_sum;     ///< order k: the parent's, rotated, without the newest terms
    Vec4d f_sum, n_sum;     ///< its own, rotated back
    Of<Vec4d> q, q_cycled;  ///< (x, y, z, w), (y, z, x, w)
    Of<Mat3dByDiagonals> turn, turn_back;  ///< R, R^t
    Of<Vec4d> w, a;                        ///< of the parent, before the joint's rotation
    Of<Vec4d> f, n;                        ///< its own, before the rotation back
    Of<CyclicVec4d> place, slide;          ///< of a floating link, on guide axes

    inline void put_attitude(std::size_t k, const Vec4d& coefficient);
  };

  struct Spin {
    std::size_t carrier = 0;
    int q = 0;
    int v = 0;
    bool regulated = false;
    bool is_steady = false;  ///< regulated at a constant speed
    double about = 0;
    Vec4d axis;
    Vec4d gyroscopic_moment;  ///< of order k
    Of<double> momentum;      ///< l
    Of<Vec4d> aside;          ///< w x e
  };

  /// A rate whose derivative is prescribed.
  struct Prescribed {
    int rate;
    const TimeFunction& acceleration;
    Of<double> coefficients;
  };

  using Columns = Eigen::Ref<Eigen::MatrixXd>;

  void begin_functions_of_time(double t, double h, int order, const GuideSeries& felt);

  void begin(const Columns& c);

  /// Computes the sums known at order k, and the coordinates' coefficients of order k + 1.
  void prepare(int k, double h, const GuideSeries& felt, Columns& c);
  void prepare_guide(std::size_t k, double per_time, const GuideSeries& felt);
  void prepare_turning(Branch& b, int k, double weight, Columns& c);
  void prepare_slider(Branch& b, int k, const Columns& c);
  void prepare_ball(Branch& b, int k, double weight, Columns& c);
  void prepare_floating(Branch& b, int k, double weight, Columns& c);
  void prepare_spins(int k, double weight, Columns& c);
  void prepare_loads(std::size_t k, double weight, const GuideSeries& felt);

  /// Sets the prescribed ones of the accelerations dv to their coefficients of order k.
  void prescribe(std::size_t k, double* dv) const {
    for (const Prescribed& p : prescribed_) dv[p.rate] = p.coefficients[k];
  }

  /// Compute the motion of order k with the accelerations dv, and its inertia forces.
  void go_outwards(std::size_t k, double weight, const double* dv);
  void go_inwards(std::size_t k);

  /// Sets left_ to the joint forces of order k less the inertia forces.
  void set_left(int k, const Columns& c);
  /// Adds the joint forces that change with time, and the couplings.
  void add_further_forces(int k, const Columns& c);

  /// Solve  M dv = left_; prepare_response() inverts M for small trees.
  void prepare_response();
  double* response();

  const BodyTree& tree_;
  bool guide_rests_;
  Field field_;
  Felt felt_;
  Attitude attitude_;
  BodyWorkspace workspace_;
  Eigen::VectorXd y_, rate_, left_;
  Eigen::VectorXd given_;          ///< accelerations: the prescribed ones, else 0
  std::vector<Of<double>> timed_;  ///< joint forces that change with time
  std::vector<Branch> branches_;
  std::vector<Slider> sliders_;
  std::vector<Ball> balls_;
  std::vector<Spin> spins_;
  std::vector<Prescribed> prescribed_;
  std::vector<LoadSeries> loads_;
  Of<Mat3dByDiagonals> guide_gamma_;

  /// The most rates for which the mass matrix is inverted; for more, linear time is faster.
  static constexpr int most_inverted = 12;
  std::size_t fours_;  ///< packs of four in a column of the inverse; 0 if not inverted
  std::vector<Vec4d> inverse_;
  std::array<double, most_inverted> dv_;
};

}  // namespace kreisel::detail
