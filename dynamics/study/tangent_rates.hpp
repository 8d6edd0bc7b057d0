#pragma once

#include <Eigen/Core>

#include <dynamics/study/tangent.hpp>
#include <motor/api.hpp>

namespace kreisel {

/// Rates of moves along the tangent of a state, exact for finite moves.
///
/// A rate on the tangent at y is that of y, with an angular velocity on the body's axes in place of
/// the rate of a quaternion.
///
/// Units : those of the state per second; rad/s for attitudes

/// The rate on the tangent at y, from the rate of y.
KREISEL_API [[nodiscard]] Eigen::VectorXd tangent_rate(const Tangent& tangent,
                                                       const Eigen::VectorXd& y,
                                                       const Eigen::VectorXd& dy);

/// The rate on the tangent at moved(y, eta), from that at y and the rate of eta:
///
///   w_after = R(eta)^T w + J(eta) eta',   J the right Jacobian of the rotation
KREISEL_API [[nodiscard]] Eigen::VectorXd rate_of_moved(const Tangent& tangent,
                                                        const Eigen::VectorXd& rate,
                                                        const Eigen::VectorXd& eta,
                                                        const Eigen::VectorXd& eta_rate);

/// The rate of eta, from the rates on the tangents at y and at moved(y, eta).
KREISEL_API [[nodiscard]] Eigen::VectorXd rate_of_move(const Tangent& tangent,
                                                       const Eigen::VectorXd& rate,
                                                       const Eigen::VectorXd& rate_after,
                                                       const Eigen::VectorXd& eta);

}  // namespace kreisel
