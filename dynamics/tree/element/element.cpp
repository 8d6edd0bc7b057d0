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
