#pragma once

#include <ostream>

#include <motor/frame.hpp>
#include <motor/motor.hpp>

namespace kreisel {

/// (x, y, z; x, y, z), resultant first, in the stream's own format.
template <class S>
std::ostream& operator<<(std::ostream& out, const Motor<S>& a) {
  const auto& [r, m] = a;
  return out << '(' << r.x() << ", " << r.y() << ", " << r.z() << "; " << m.x() << ", " << m.y()
             << ", " << m.z() << ')';
}

/// A tagged motor prints as its motor.
template <Tagged Q>
std::ostream& operator<<(std::ostream& out, const Q& q) {
  return out << q.value;
}

}  // namespace kreisel
