#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <utility>
#include <vector>

#include <dynamics/study/spectrum.hpp>

namespace kreisel {

/// The frequencies of a gyroscopic system over a parameter, usually the spin of its rotors.
///
/// Units  : rad/s
struct CampbellDiagram {
  std::vector<double> parameter;
  Eigen::MatrixXd frequency;  ///< one row for each mode, one column for each parameter
  Eigen::MatrixXd damping;    ///< root.real(); 0 for modes that are stable without damping
  std::vector<std::vector<GyroscopicMode>> modes;  ///< for each parameter, in the rows' order
};

/// A Campbell diagram: spectra of at(parameter). The modes at neighbouring parameters are connected
/// by their likeness |x.M y|, so that curves may cross.
///
/// At     : callable (double parameter) -> coefficients as conservative_spectrum() takes them
/// Error  : as conservative_spectrum(); where two curves repel each other within one step of the
///          parameter they may be taken for crossing
/// Throws : as conservative_spectrum(); InvalidInput if the number of modes changes, as it does
///          where an oscillation turns into two real roots
template <class At>
[[nodiscard]] CampbellDiagram campbell(const At& at, const std::vector<double>& parameters) {
  CampbellDiagram diagram;
  diagram.parameter = parameters;
  for (const double p : parameters) {
    const auto c = at(p);
    std::vector<GyroscopicMode> modes = conservative_spectrum(c);
    if (!diagram.modes.empty()) {
      const std::vector<GyroscopicMode>& before = diagram.modes.back();
      if (modes.size() != before.size()) {
        detail::refuse_spectrum("at the parameter ", p, " there are ", modes.size(),
                                " modes, before ", before.size());
      }
      for (std::size_t i = 0; i < modes.size(); ++i) {
        const auto likeness = [&](const GyroscopicMode& mode) {
          const Eigen::VectorXcd M_x = c.mass * mode.shape;
          const double size = std::sqrt(std::abs(mode.shape.dot(M_x)));
          return size > 0 ? std::abs(before[i].shape.dot(M_x)) / size : 0;
        };
        std::size_t best = i;
        for (std::size_t j = i + 1; j < modes.size(); ++j) {
          if (likeness(modes[j]) > likeness(modes[best])) best = j;
        }
        std::swap(modes[i], modes[best]);
      }
    }
    diagram.modes.push_back(std::move(modes));
  }
  const auto columns = static_cast<Eigen::Index>(parameters.size());
  const auto rows = columns > 0 ? static_cast<Eigen::Index>(diagram.modes[0].size()) : 0;
  diagram.frequency.resize(rows, columns);
  diagram.damping.resize(rows, columns);
  for (Eigen::Index j = 0; j < columns; ++j) {
    for (Eigen::Index i = 0; i < rows; ++i) {
      const Mode& mode = diagram.modes[static_cast<std::size_t>(j)][static_cast<std::size_t>(i)];
      diagram.frequency(i, j) = mode.root.imag();
      diagram.damping(i, j) = mode.root.real();
    }
  }
  return diagram;
}

}  // namespace kreisel
