#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include <dynamics/tree/check.hpp>
#include <dynamics/tree/elements.hpp>
#include <dynamics/tree/evaluation.hpp>
#include <dynamics/tree/series_recurrences.hpp>

namespace kreisel::detail {

/// True if a load on this body has a series. Rotors carry loads that depend on their position.
[[nodiscard]] inline bool is_analytic(const BodyDescription& body, bool guide_rests) {
  const auto has_series = [guide_rests](const BodyLoad& load) {
    return load.analytic() != nullptr && load.analytic()->is_analytic(guide_rests);
  };
  return !body.rotor && std::all_of(body.loads.begin(), body.loads.end(), has_series);
}

bool knows_series(const BodyTree& tree, bool guide_rests) {
  const auto all = [](const auto& list, const auto& is_so) {
    return std::all_of(list.begin(), list.end(), is_so);
  };
  return tree.constraints().empty() &&
         all(tree.elements(),
             [](const Element& element) {
               return std::holds_alternative<CouplingElement>(element);
             }) &&
         all(tree.loaded(), [&](int body) { return is_analytic(tree.body(body), guide_rests); }) &&
         all(tree.drives(), [](const auto& drive) { return drive.acceleration.is_analytic(); }) &&
         all(tree.timed_forces(), [](const auto& force) { return force.signal.is_analytic(); }) &&
         all(tree.rotors(),
             [&](const RotorLink& rotor) {
               const TimeFunction& asked = tree.body(rotor.link.body).rotor->acceleration;
               return !asked || asked.is_analytic();
             }) &&
         all(tree.links(),
             [](const Link& link) { return link.kind != LinkKind::free || link.parent == 0; });
}

/// Axes whose z is the given axis.
[[nodiscard]] inline Matrix3<double> axes_about(const Vector3<double>& axis) {
  int least = 0;
  for (int i = 1; i < 3; ++i) {
    if (std::abs(axis[i]) < std::abs(axis[least])) least = i;
  }
  Vector3<double> x = Vector3<double>::Zero();
  x[least] = 1;
  x = normalized(Vector3<double>(x - dot(x, axis) * axis));
  Matrix3<double> axes;
  axes << x, cross(axis, x), axis;
  return axes;
}

[[nodiscard]] inline double along(const Vec4d& a, const Vec4d& b) {
  const Vec4d product = a * b;
  return product[0] + product[1] + product[2];
}

/// (-y, x, -w, z): two plane vectors rotated by a right angle.
[[nodiscard]] inline Vec4d turned_left(const Vec4d& a) { return {-a[1], a[0], -a[3], a[2]}; }

/// The k-th coefficients of w w^t: first the products with the newest coefficient, then the others.
inline void TreeSeries::Recurrences::Branch::begin_products(std::size_t k) {
  squares = w[0] * w[k];
  next = w[0] * w_cycled[k];
}
inline void TreeSeries::Recurrences::Branch::add_product(std::size_t i, std::size_t j) {
  squares += w[i] * w[j];
  next += w[i] * w_cycled[j];
}

/// Computes dw and gamma from w_next; per_time = (k + 1)/h.
inline void TreeSeries::Recurrences::Branch::accelerate(double per_time) {
  dw.as_is = per_time * w_next.as_is;
  dw.next = per_time * w_next.next;
  dw.after = per_time * w_next.after;
  gamma.main = Vec4d(0, 0, 0, 0) - (squares.next() + squares.after());
  gamma.upper = next - dw.after;
  gamma.lower = next.after() + dw.next;
}

inline void TreeSeries::Recurrences::Ball::put_attitude(std::size_t k, const Vec4d& coefficient) {
  q[k] = coefficient;
  q_cycled[k] = coefficient.next();
  Vec4d square(0, 0, 0, 0);
  Vec4d next = square;
  Vec4d by_w = square;
  for (std::size_t j = 0; j <= k; ++j) {
    square += q[j] * q[k - j];
    next += q[j] * q_cycled[k - j];
    by_w += q[k - j][3] * q[j];
  }
  turn_back[k] = Mat3dByDiagonals::rotation_back(square, next, by_w, scale);
  turn[k] = turn_back[k].transposed();
}

TreeSeries::Recurrences::Recurrences(const BodyTree& tree, bool guide_rests, Field field, Felt felt,
                                     Attitude attitude)
    : tree_(tree),
      guide_rests_(guide_rests),
      field_(std::move(field)),
      felt_(std::move(felt)),
      attitude_(std::move(attitude)),
      workspace_(tree),
      left_(Eigen::VectorXd::Zero(tree.rates())),
      given_(Eigen::VectorXd::Zero(tree.rates())),
      timed_(tree.timed_forces().size()),
      branches_(tree.links().size()),
      balls_(static_cast<std::size_t>(tree.balls())),
      spins_(tree.rotors().size()),
      fours_(tree.rates() <= most_inverted ? (static_cast<std::size_t>(tree.rates()) + 3) / 4 : 0),
      inverse_(fours_ * static_cast<std::size_t>(tree.rates())) {
  const Vec4d zero(0, 0, 0, 0);
  Branch& guide = branches_[0];
  guide.gamma = {zero, zero, zero};
  guide.w_next = CyclicVec4d(zero);
  guide.dw = guide.w_next;
  for (std::size_t i = 1; i < branches_.size(); ++i) {
    const Link& link = tree.links()[i];
    Branch& b = branches_[i];
    b.parent = static_cast<std::size_t>(link.parent);
    b.is_turned = b.parent != 0 || !guide_rests;
    b.hands_on = b.parent != 0;
    b.q = link.q;
    b.v = tree.coordinates() + link.v;
    b.rates = link.v;
    const Matrix3<double> above = branches_[b.parent].own_axes.transpose();
    if (link.moves() && link.turns_by_angle()) {
      b.way = Way::turning;
      const Matrix3<double> joint = axes_about(link.axis).transpose();
      b.own_axes = joint * (link.still + link.cosine);
      b.set_outwards(joint * above);
    } else if (link.moves() && link.kind == LinkKind::prismatic) {
      b.way = Way::sliding;
    } else if (link.moves()) {
      b.way = Way::ball;
      b.number = static_cast<std::size_t>(link.factor);
      b.floats = link.kind == LinkKind::free;
      b.set_outwards(link.still.transpose() * above);
      for (int j = 3; b.floats && j < 6; ++j) {
        const int rate = link.v + j;
        const JointForce& f = tree.forces()[static_cast<std::size_t>(rate)];
        b.is_braked = b.is_braked || f.damping != 0 || f.constant != 0 || f.in_time;
      }
    }
    if (link.moves() && link.pitch != 0) {
      b.slides = true;
      b.number = sliders_.size();
      const Vector3<double> axis = link.pitch * (above.transpose() * link.axis);
      sliders_.emplace_back().axis = CyclicVec4d(vec4d(components(axis)));
    }
    const Inertia<> T = Pose<>{b.own_axes, Vector3<double>::Zero()} * link.inertia;
    b.mass = T.mass;
    b.first_moment = CyclicVec4d(vec4d(components(T.first_moment)));
    b.tensor = Mat3dByDiagonals::of(T.tensor.matrix());
    b.gyroscopic = GyroscopicDifferences(T.tensor);
  }
  for (std::size_t k = 0; k < spins_.size(); ++k) {
    const RotorLink& rotor = tree.rotors()[k];
    Spin& spin = spins_[k];
    spin.carrier = static_cast<std::size_t>(rotor.link.parent);
    spin.q = rotor.link.q;
    spin.v = rotor.link.v;
    spin.regulated = rotor.regulated();
    const TimeFunction& asked = tree.body(rotor.link.body).rotor->acceleration;
    spin.is_steady = spin.regulated && !asked;
    if (asked) prescribed_.push_back({rotor.link.v, asked, {}});
    spin.about = rotor.about;
    const Matrix3<double>& axes = branches_[spin.carrier].own_axes;
    spin.axis = vec4d(components(Vector3<double>(axes * rotor.link.axis)));
  }
  for (const BodyTree::Drive& drive : tree.drives()) {
    prescribed_.push_back({drive.rate, drive.acceleration, {}});
  }
  for (const int body : tree.loaded()) {
    const std::size_t link = tree.link(body);
    for (const BodyLoad& load : tree.body(body).loads) {
      loads_.emplace_back(*load.analytic(), link, branches_[link].own_axes);
    }
  }
}

void TreeSeries::Recurrences::operator()(double t, double h, int order,
                                         Eigen::Ref<Eigen::MatrixXd>& c) {
  y_ = c.col(0);
  field_(t, y_, rate_, workspace_);
  c.col(1) = h * rate_;
  if (order == 1) return;
  const GuideSeries felt = felt_(t, h, order);
  begin_functions_of_time(t, h, order, felt);
  begin(c);
  prepare_response();
  const double* dv = rate_.data() + tree_.coordinates();
  for (int k = 0;; ++k) {
    const double weight = h / (k + 1);
    const auto at = static_cast<std::size_t>(k);
    prepare(k, h, felt, c);
    if (k > 0) {
      prescribe(at, given_.data());
      go_outwards(at, weight, given_.data());
      go_inwards(at);
      set_left(k, c);
      double* const found = response();
      prescribe(at, found);
      dv = found;
      for (int i = 0; i < tree_.rates(); ++i) c(tree_.coordinates() + i, k + 1) = weight * dv[i];
    }
    if (k + 1 == order) return;
    go_outwards(at, weight, dv);
    go_inwards(at);
  }
}

void TreeSeries::Recurrences::begin_functions_of_time(double t, double h, int order,
                                                      const GuideSeries& felt) {
  for (std::size_t j = 0; j < timed_.size(); ++j) {
    tree_.timed_forces()[j].signal.coefficients(t, h, timed_[j]);
  }
  for (Prescribed& p : prescribed_) {
    p.acceleration.coefficients(t, h, std::span(p.coefficients).first(std::size_t(order)));
  }
  for (LoadSeries& load : loads_) {
    const Matrix3<double>& own_axes = branches_[load.link()].own_axes;
    const Matrix3<double> guide_to_own = own_axes * workspace_.pose[load.link()].R.transpose();
    if (load.axes() == LoadAxes::inertial) {
      load.begin(t, h, order, guide_to_own * attitude_(t).transpose());
    } else {
      load.begin(t, h, order, guide_to_own);
    }
    if (load.drag() == nullptr) continue;
    const auto& [x, y, z] = felt.g[0];
    load.drag()->begin(guide_to_own * workspace_.place[load.link()].V.moment,
                       guide_to_own * Vector3<double>(x, y, z));
  }
}

void TreeSeries::Recurrences::begin(const Columns& c) {
  for (std::size_t i = 0; i < branches_.size(); ++i) {
    Branch& b = branches_[i];
    const Matrix3<double> to_own = b.own_axes * workspace_.pose[i].R.transpose();
    b.w_next = CyclicVec4d(vec4d(components(Vector3<double>(to_own * workspace_.motion[i].w))));
    if (i == 0) continue;
    const Branch& parent = branches_[b.parent];
    const Matrix3<double> above = parent.own_axes * workspace_.pose[b.parent].R.transpose();
    b.r = CyclicVec4d(vec4d(components(Vector3<double>(above * workspace_.pose[i].r))));
    if (b.way == Way::still || b.way == Way::sliding) b.set_outwards(to_own * above.transpose());
    const Vec4d w = b.outwards * parent.w_next;
    if (b.way == Way::turning) {
      b.cos[0] = std::cos(c(b.q, 0));
      b.sin[0] = std::sin(c(b.q, 0));
      b.first_turn = Vec4d(w[0], w[1], 0, 0);
    } else if (b.way == Way::ball) {
      Ball& ball = balls_[b.number];
      ball.first_w = w;
      ball.scale = 1 / c.col(0).segment<4>(b.q).squaredNorm();
      ball.put_attitude(0, Vec4d::from(&c(b.q, 0)));
    }
  }
}

void TreeSeries::Recurrences::prepare(int k, double h, const GuideSeries& felt, Columns& c) {
  const auto at = static_cast<std::size_t>(k);
  const double weight = h / (k + 1);
  c.col(k + 1).head(tree_.coordinates()).setZero();
  for (Branch& b : branches_) {
    b.w[at] = b.w_next.as_is;
    b.w_cycled[at] = b.w_next.next;
  }
  prepare_guide(at, 1 / weight, felt);
  for (std::size_t i = 1; i < branches_.size(); ++i) {
    Branch& b = branches_[i];
    b.begin_products(at);
    switch (b.way) {
      case Way::still:
        for (std::size_t j = 1; j <= at; ++j) b.add_product(j, at - j);
        break;
      case Way::turning: prepare_turning(b, k, weight, c); break;
      case Way::sliding:
        c(b.q, k + 1) = weight * c(b.v, k);
        for (std::size_t j = 1; j <= at; ++j) b.add_product(j, at - j);
        break;
      case Way::ball:
        prepare_ball(b, k, weight, c);
        if (b.floats) prepare_floating(b, k, weight, c);
        break;
    }
    if (b.slides) prepare_slider(b, k, c);
    b.gyroscopic_moment = b.gyroscopic.torque(b.next.next(), b.squares);
  }
  prepare_spins(k, weight, c);
  prepare_loads(at, weight, felt);
}

void TreeSeries::Recurrences::prepare_guide(std::size_t k, double per_time,
                                            const GuideSeries& felt) {
  Branch& guide = branches_[0];
  guide.a = -1.0 * vec4d(felt.g[k]);
  if (guide_rests_) return;
  guide.w_next = CyclicVec4d(vec4d(felt.u[k + 1]));
  guide.begin_products(k);
  for (std::size_t j = 1; j <= k; ++j) guide.add_product(j, k - j);
  guide.accelerate(per_time);
  guide_gamma_[k] = guide.gamma;
}

void TreeSeries::Recurrences::prepare_turning(Branch& b, int k, double weight, Columns& c) {
  c(b.q, k + 1) = weight * c(b.v, k);
  const auto last = static_cast<std::size_t>(k);
  double by_cos = c(b.v, k) * b.cos[0];
  double by_sin = c(b.v, k) * b.sin[0];
  Vec4d outer(0, 0, 0, 0);
  Vec4d outer_left = outer;
  Vec4d inner = outer;
  Vec4d inner_left = outer;
  for (std::size_t j = 1; j <= last; ++j) {
    const double cos = b.cos[j];
    const double sin = b.sin[j];
    const double rate = c(b.v, int(last - j));
    b.add_product(j, last - j);
    by_cos += rate * cos;
    by_sin += rate * sin;
    outer += cos * b.turned[last - j];
    outer_left += sin * b.turned[last - j];
    inner += cos * b.back[last - j];
    inner_left += sin * b.back[last - j];
  }
  b.cos[last + 1] = -weight * by_sin;
  b.sin[last + 1] = weight * by_cos;
  outer += b.cos[last + 1] * b.first_turn;
  outer_left += b.sin[last + 1] * b.first_turn;
  b.outer = outer - turned_left(outer_left);
  b.inner = inner + turned_left(inner_left);
}

void TreeSeries::Recurrences::prepare_slider(Branch& b, int k, const Columns& c) {
  const auto last = static_cast<std::size_t>(k);
  Slider& slider = sliders_[b.number];
  slider.w_axis[last] = 2.0 * cross(branches_[b.parent].w[last], slider.axis.as_is);
  b.carried = c(b.v, 0) * slider.w_axis[last];
  slider.lever = Vec4d(0, 0, 0, 0);
  for (std::size_t j = 1; j <= last; ++j) {
    const double q = c(b.q, int(j));
    b.carried += c(b.v, int(j)) * slider.w_axis[last - j] + q * slider.gamma_axis[last - j];
    slider.lever += q * slider.moment[last - j];
  }
}

void TreeSeries::Recurrences::prepare_ball(Branch& b, int k, double weight, Columns& c) {
  Ball& ball = balls_[b.number];
  const auto last = static_cast<std::size_t>(k);
  Vec4d x(0, 0, 0, 0);
  Vec4d y = x;
  Vec4d z = x;
  for (std::size_t j = 0; j <= last; ++j) {
    const double* v = &c(b.v, int(last - j));
    x += v[0] * ball.q[j];
    y += v[1] * ball.q[j];
    z += v[2] * ball.q[j];
  }
  // q (0, v)
  const Vec4d product = (Vec4d(x[3], x[2], -x[1], -x[0]) + Vec4d(-y[2], y[3], y[0], -y[1])) +
                        Vec4d(z[1], -z[0], z[3], -z[2]);
  const Vec4d dq = weight / 2 * product;
  dq.to(&c(b.q, k + 1));
  ball.put_attitude(last + 1, dq);

  TransposedProducts w, a, f, n;
  if (b.is_turned) w.add(ball.turn[last + 1], ball.first_w);
  for (std::size_t j = 1; j <= last; ++j) {
    b.add_product(j, last - j);
    a.add(ball.turn[j], ball.a[last - j]);
    if (b.is_turned) w.add(ball.turn[j], ball.w[last + 1 - j]);
    if (b.hands_on || b.is_braked) f.add(ball.turn_back[j], ball.f[last - j]);
    if (b.hands_on) n.add(ball.turn_back[j], ball.n[last - j]);
  }
  ball.w_sum = w.sum();
  ball.a_sum = a.sum();
  ball.f_sum = f.sum();
  ball.n_sum = n.sum();
}

void TreeSeries::Recurrences::prepare_floating(Branch& b, int k, double weight, Columns& c) {
  c.col(k + 1).segment<3>(b.q + 4) = weight * c.col(k).segment<3>(b.v + 3);
  b.carried = Vec4d(0, 0, 0, 0);
  if (guide_rests_) return;
  Ball& ball = balls_[b.number];
  const Branch& guide = branches_[0];
  const auto last = static_cast<std::size_t>(k);
  const auto three = [&](int row) {
    return CyclicVec4d(Vec4d(c(row, k), c(row + 1, k), c(row + 2, k), 0));
  };
  ball.place[last] = three(b.q + 4);
  ball.slide[last] = three(b.v + 3);
  for (std::size_t j = 0; j <= last; ++j) {
    const CyclicVec4d& slide = ball.slide[last - j];
    const Vec4d& w = guide.w_cycled[j];
    b.carried += 2.0 * (w * slide.after - w.next() * slide.next);
    if (j < last) b.carried += guide_gamma_[j] * ball.place[last - j];
  }
}

void TreeSeries::Recurrences::prepare_spins(int k, double weight, Columns& c) {
  const auto last = static_cast<std::size_t>(k);
  for (Spin& spin : spins_) {
    const Vec4d& w = branches_[spin.carrier].w[last];
    const double rate = c(tree_.coordinates() + spin.v, k);
    spin.momentum[last] = spin.about * (spin.regulated ? rate : rate + along(spin.axis, w));
    spin.aside[last] = cross(w, spin.axis);
    spin.gyroscopic_moment = Vec4d(0, 0, 0, 0);
    for (std::size_t j = 0; j <= last; ++j) {
      spin.gyroscopic_moment += spin.momentum[j] * spin.aside[last - j];
    }
    c(spin.q, k + 1) = weight * rate;
  }
}

void TreeSeries::Recurrences::prepare_loads(std::size_t k, double weight, const GuideSeries& felt) {
  using Turning = std::span<const Components<double>>;
  const Turning u = guide_rests_ ? Turning() : Turning(felt.u);
  for (LoadSeries& load : loads_) {
    const Branch& b = branches_[load.link()];
    if (load.drag() != nullptr && k > 0) {
      const auto order = static_cast<double>(k);
      load.drag()->advance(k - 1, weight * (order + 1) / order, b.w, b.a);
    }
    load.prepare(k, weight, b.w, load.axes() == LoadAxes::guide ? u : Turning());
  }
}

void TreeSeries::Recurrences::go_outwards(std::size_t k, double weight, const double* dv) {
  for (std::size_t i = 1; i < branches_.size(); ++i) {
    Branch& b = branches_[i];
    const Branch& above = branches_[b.parent];
    const double* own = dv + b.rates;
    Vec4d a = above.a + above.gamma * b.r;
    if (b.slides) {
      Slider& slider = sliders_[b.number];
      slider.gamma_axis[k] = above.gamma * slider.axis;
      a += b.carried + own[0] * slider.axis.as_is;
    } else if (b.floats) {
      a += b.carried + Vec4d(own[3], own[4], own[5], 0);
    }
    a = b.outwards * CyclicVec4d(a);
    Vec4d w = b.outwards * above.w_next;
    if (b.way == Way::turning) {
      const Vec4d before(w[0], w[1], a[0], a[1]);
      b.turned[k] = before;
      const Vec4d turned = b.outer + (b.cos[0] * before - b.sin[0] * turned_left(before));
      w = Vec4d(turned[0], turned[1], w[2] + weight * own[0], 0);
      a = Vec4d(turned[2], turned[3], a[2], 0);
    } else if (b.way == Way::ball) {
      Ball& ball = balls_[b.number];
      ball.w[k + 1] = w;
      ball.a[k] = a;
      a = ball.a_sum + ball.turn_back[0] * CyclicVec4d(a);
      const Vec4d turned = ball.w_sum + ball.turn_back[0] * CyclicVec4d(w);
      w = weight * Vec4d(own[0], own[1], own[2], 0);
      if (b.is_turned) w += turned;
    }
    b.w_next = CyclicVec4d(w);
    b.a = a;
    b.accelerate(1 / weight);
    b.force = b.mass * a + b.gamma * b.first_moment;
    b.moment = cross(b.first_moment.as_is, a) + (b.tensor * b.dw - b.gyroscopic_moment);
  }
  for (const Spin& spin : spins_) {
    Branch& carrier = branches_[spin.carrier];
    carrier.moment += spin.gyroscopic_moment;
    if (spin.is_steady) continue;
    double acceleration = dv[spin.v];
    if (!spin.regulated) acceleration += along(spin.axis, carrier.dw.as_is);
    carrier.moment += spin.about * acceleration * spin.axis;
  }
  for (const LoadSeries& load : loads_) {
    Branch& b = branches_[load.link()];
    b.force = b.force - load.force();
    b.moment = b.moment - load.moment();
  }
}

void TreeSeries::Recurrences::go_inwards(std::size_t k) {
  for (std::size_t i = branches_.size() - 1; i > 0; --i) {
    Branch& b = branches_[i];
    Vec4d f = b.force;
    Vec4d n = b.moment;
    if (b.way == Way::ball && (b.hands_on || b.is_braked)) {
      Ball& ball = balls_[b.number];
      ball.f[k] = f;
      ball.n[k] = n;
      f = ball.f_sum + ball.turn[0] * CyclicVec4d(f);
      n = ball.n_sum + ball.turn[0] * CyclicVec4d(n);
    }
    if (!b.hands_on) continue;
    if (b.way == Way::turning) {
      const Vec4d before(f[0], f[1], n[0], n[1]);
      b.back[k] = before;
      const Vec4d turned = b.inner + (b.cos[0] * before + b.sin[0] * turned_left(before));
      f = Vec4d(turned[0], turned[1], f[2], 0);
      n = Vec4d(turned[2], turned[3], n[2], 0);
    }
    f = b.inwards * CyclicVec4d(f);
    n = b.inwards * CyclicVec4d(n) + cross(b.r.as_is, f);
    if (b.slides) {
      Slider& slider = sliders_[b.number];
      slider.moment[k] = cross(slider.axis.as_is, f);
      n += slider.lever;
    }
    branches_[b.parent].force += f;
    branches_[b.parent].moment += n;
  }
}

void TreeSeries::Recurrences::set_left(int k, const Columns& c) {
  for (int i = 0; i < tree_.rates(); ++i) {
    const auto number = static_cast<std::size_t>(i);
    const JointForce& f = tree_.forces()[number];
    left_[i] = -f.stiffness * c(tree_.coordinate_of()[number], k) -
               f.damping * c(tree_.coordinates() + i, k);
  }
  if (tree_.is_acted_on()) add_further_forces(k, c);
  for (std::size_t i = 1; i < branches_.size(); ++i) {
    const Branch& b = branches_[i];
    double* left = left_.data() + b.rates;
    if (b.way == Way::turning) left[0] -= b.moment[2];
    if (b.slides) left[0] -= along(b.outwards * sliders_[b.number].axis, b.force);
    if (b.way == Way::ball) {
      for (int j = 0; j < 3; ++j) left[j] -= b.moment[j];
      if (!b.floats) continue;
      // For an unbraked link these forces vanish at every order.
      const Ball& ball = balls_[b.number];
      const Vec4d f = b.inwards * CyclicVec4d(ball.f_sum + ball.turn[0] * CyclicVec4d(b.force));
      for (int j = 0; j < 3; ++j) left[3 + j] -= f[j];
    }
  }
  for (const Spin& spin : spins_) {
    left_[spin.v] -= spin.about * along(spin.axis, branches_[spin.carrier].dw.as_is);
  }
}

void TreeSeries::Recurrences::add_further_forces(int k, const Columns& c) {
  for (std::size_t j = 0; j < timed_.size(); ++j) {
    left_[tree_.timed_forces()[j].rate] += timed_[j][static_cast<std::size_t>(k)];
  }
  const double* const now = c.col(k).data();
  add_couplings(tree_, now, now + tree_.coordinates(), left_);
}

void TreeSeries::Recurrences::prepare_response() {
  if (fours_ == 0) return;
  left_.setZero();
  for (int j = 0; j < tree_.rates(); ++j) {
    left_[j] = 1;
    respond(tree_, left_, workspace_);
    left_[j] = 0;
    dv_.fill(0);
    std::copy_n(workspace_.acceleration.data(), tree_.rates(), dv_.begin());
    for (std::size_t i = 0; i < fours_; ++i) {
      inverse_[std::size_t(j) * fours_ + i] = Vec4d::from(&dv_[4 * i]);
    }
  }
}

double* TreeSeries::Recurrences::response() {
  if (fours_ == 0) {
    respond(tree_, left_, workspace_);
    return workspace_.acceleration.data();
  }
  const auto rates = static_cast<std::size_t>(tree_.rates());
  for (std::size_t i = 0; i < fours_; ++i) {
    Vec4d sum = left_[0] * inverse_[i];
    for (std::size_t j = 1; j < rates; ++j)
      sum += left_[Eigen::Index(j)] * inverse_[j * fours_ + i];
    sum.to(&dv_[4 * i]);
  }
  return dv_.data();
}

TreeSeries::TreeSeries(const BodyTree& tree, bool guide_rests, Field field, Felt felt,
                       Attitude attitude)
    : recurrences_(std::make_unique<Recurrences>(tree, guide_rests, std::move(field),
                                                 std::move(felt), std::move(attitude))) {}
TreeSeries::TreeSeries(const TreeSeries& other)
    : recurrences_(std::make_unique<Recurrences>(*other.recurrences_)) {}
TreeSeries::TreeSeries(TreeSeries&&) noexcept = default;
TreeSeries& TreeSeries::operator=(const TreeSeries& other) { return *this = TreeSeries(other); }
TreeSeries& TreeSeries::operator=(TreeSeries&&) noexcept = default;
TreeSeries::~TreeSeries() = default;

void TreeSeries::operator()(double t, double h, int order, Eigen::Ref<Eigen::MatrixXd> c) {
  (*recurrences_)(t, h, order, c);
}

}  // namespace kreisel::detail
