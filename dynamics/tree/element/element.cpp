#include <algorithm>
#include <cmath>
#include <limits>

#include <dynamics/tree/element/element.hpp>
#include <motor/error.hpp>

namespace kreisel {

bool MountElement::has_potential() const {
  // Rotating a tensor to other axes leaves it symmetric up to 12u of its norm, which is at most
  // three times the greatest entry.
  constexpr double rounding = 18 * std::numeric_limits<double>::epsilon();
  const auto fits = [](const Matrix3<double>& a, const Matrix3<double>& b) {
    const double greatest = std::max(a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff());
    return (a - b.transpose()).cwiseAbs().maxCoeff() <= rounding * greatest;
  };
  const MotorTensor<>& K = stiffness;
  return fits(K.rm, K.rm) && fits(K.mr, K.mr) && fits(K.rr, K.mm);
}

double MountElement::potential(const ElementMotion<>& m) const {
  const Matrix3<double> to_mount = to_body().transpose();
  const Motor<> z{to_mount * turn(m), to_mount * m.reach};
  return reciprocal(stiffness * z, z) / 2 - reciprocal(preload, z);
}

bool MountElement::feels_rotation() const {
  return !(stiffness.rr.isZero(0) && stiffness.mr.isZero(0) && stiffness.mm.isZero(0) &&
           preload.moment.isZero(0));
}

Matrix3<double> MountElement::to_body() const {
  return detail::Rotation<double>::from(axes).matrix();
}

double SpringElement::potential(const ElementMotion<>& m) const {
  const double distance = m.reach.norm();
  if (table.empty()) return stiffness * (distance - length) * (distance - length) / 2;
  double sum = 0;
  double from = table.front().length;
  for (std::size_t i = 1; i + 1 < table.size() && table[i].length < distance; ++i) {
    sum += (table[i].length - from) * (pull(from) + table[i].pull) / 2;
    from = table[i].length;
  }
  return sum + (distance - from) * (pull(from) + pull(distance)) / 2;
}

double RopeElement::potential(const ElementMotion<>& m) const {
  const double stretch = std::max(0.0, m.reach.norm() - length(m.t));
  return stiffness * stretch * stretch / 2;
}

const std::string& name(const Element& element) {
  return std::visit([](const auto& kind) -> const std::string& { return kind.name; }, element);
}

bool has_potential(const Element& element) {
  const auto* const mount = std::get_if<MountElement>(&element);
  const auto* const rope = std::get_if<RopeElement>(&element);
  return (mount == nullptr || mount->has_potential()) &&
         (rope == nullptr || rope->length.is_constant());
}

bool keeps_energy(const Element& element) {
  return std::visit([](const auto& kind) { return kind.keeps_energy(); }, element);
}

namespace detail {

namespace {

bool is_finite(const MotorTensor<>& T) {
  return T.rr.allFinite() && T.rm.allFinite() && T.mr.allFinite() && T.mm.allFinite();
}

bool is_zero(const MotorTensor<>& T) {
  return T.rr.isZero(0) && T.rm.isZero(0) && T.mr.isZero(0) && T.mm.isZero(0);
}

const std::string& body_of(const Element& element, std::size_t end) {
  return std::visit(
      [end](const auto& kind) -> const std::string& {
        if constexpr (joins_joints<std::decay_t<decltype(kind)>>) {
          return kind.joints[end];
        } else {
          return kind.ends[end].body;
        }
      },
      element);
}

void check_numbers(const std::string& name, double stiffness, double damping, bool has_table) {
  if (!std::isfinite(stiffness)) refuse_element(name, "its stiffness is not finite");
  if (!(std::isfinite(damping) && damping >= 0)) {
    refuse_element(name, "its damping must be finite and not below 0");
  }
  if (stiffness == 0 && damping == 0 && !has_table) {
    refuse_element(name, "it has no stiffness and no damping, and so no force");
  }
}

void check_table(const SpringElement& spring) {
  const auto& table = spring.table;
  if (table.empty()) return;
  if (spring.stiffness != 0 || spring.length != 0) {
    refuse_element(spring.name, "its table replaces stiffness and length; leave them out");
  }
  if (table.size() < 2) refuse_element(spring.name, "its table needs two points at least");
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (!(std::isfinite(table[i].length) && std::isfinite(table[i].pull))) {
      refuse_element(spring.name, "its table has a number that is not finite");
    }
    if (table[i].length < 0) refuse_element(spring.name, "its table has a length below 0");
    if (i > 0 && !(table[i].length > table[i - 1].length)) {
      refuse_element(spring.name, "the lengths of its table must increase");
    }
  }
}

void check_kind(const SpringElement& spring) {
  check_numbers(spring.name, spring.stiffness, spring.damping, !spring.table.empty());
  if (!(std::isfinite(spring.length) && spring.length >= 0)) {
    refuse_element(spring.name, "its length must be finite and not below 0");
  }
  check_table(spring);
}

void check_kind(const RopeElement& rope) {
  check_numbers(rope.name, rope.stiffness, rope.damping, false);
  if (!(rope.stiffness > 0)) refuse_element(rope.name, "its stiffness must be above 0");
  if (rope.length.is_constant() && !(rope.length(0.0) >= 0)) {
    refuse_element(rope.name, "its length must not be below 0");
  }
}

void check_kind(const MountElement& mount) {
  const auto& [name, ends, axes, stiffness, damping, preload] = mount;
  if (!is_finite(stiffness)) refuse_element(name, "its stiffness is not finite");
  if (!is_finite(damping)) refuse_element(name, "its damping is not finite");
  if (!(preload.resultant.allFinite() && preload.moment.allFinite())) {
    refuse_element(name, "its preload is not finite");
  }
  const double norm2 = axes.squaredNorm();
  if (!(norm2 > 0 && std::isfinite(norm2))) {
    refuse_element(name, "its axes are no quaternion of finite norm");
  }
  if ((damping.rm.diagonal().array() < 0).any() || (damping.mr.diagonal().array() < 0).any()) {
    refuse_element(name, "its damping along an axis must not be below 0");
  }
  const bool is_loaded = !(preload.resultant.isZero(0) && preload.moment.isZero(0));
  if (is_zero(stiffness) && is_zero(damping) && !is_loaded) {
    refuse_element(name, "it has no stiffness, damping and preload, and so no force");
  }
}

void check_kind(const CouplingElement& coupling) {
  check_numbers(coupling.name, coupling.stiffness, coupling.damping, false);
  if (!(std::isfinite(coupling.ratio) && coupling.ratio != 0)) {
    refuse_element(coupling.name, "its ratio must be finite and not 0");
  }
  if (coupling.joints[0] == coupling.joints[1]) {
    refuse_element(coupling.name, "it couples the joint of '" + coupling.joints[0] + "' to itself");
  }
}

}  // namespace

void refuse_element(const std::string& name, const std::string& why) {
  throw InvalidInput("element '" + name + "': " + why);
}

void check_element(const Element& element) {
  if (name(element).empty()) refuse_element("", "it needs a name");
  std::visit(
      [](const auto& kind) {
        if constexpr (!joins_joints<std::decay_t<decltype(kind)>>) {
          for (const ElementEnd& end : kind.ends) {
            if (!end.at.allFinite()) refuse_element(kind.name, "one of its points is not finite");
          }
          if (kind.ends[0].body == kind.ends[1].body) {
            refuse_element(kind.name, "both of its ends are on '" + kind.ends[0].body +
                                          "', between whose points nothing moves");
          }
        }
        check_kind(kind);
      },
      element);
}

}  // namespace detail

bool MountElement::keeps_energy() const { return has_potential() && detail::is_zero(damping); }

const std::string& first_of(const Element& element) { return detail::body_of(element, 0); }

const std::string& second_of(const Element& element) { return detail::body_of(element, 1); }

}  // namespace kreisel
