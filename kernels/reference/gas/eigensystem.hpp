#pragma once

#include "kernels/gas/parameters.hpp"
#include "kernels/reference/gas/euler.hpp"

namespace drogue::reference {

/// Velocity, m/s, total specific enthalpy, J/kg, and speed of sound, m/s, at a face.
struct FaceState {
  double u = 0.0;
  double enthalpy = 0.0;
  double c = 0.0;
};

/// Full eigenvector matrices. Row s of `left` and column s of `right` belong to u-c, u, u+c; left * right =
/// 1.
struct Eigensystem {
  std::array<std::array<double, 3>, 3> left{};
  std::array<std::array<double, 3>, 3> right{};
};

/// Average of two neighbouring cells. Every kind of average uses c^2 = (gamma-1)(H - u^2/2). Does not throw.
[[nodiscard]] FaceState face_state(const Conserved& a, const Conserved& b, gas::FaceAverage average,
                                   double gamma);

/// Eigenvectors of the flux Jacobian. Right ones: (1, u-c, H-uc), (1, u, u^2/2), (1, u+c, H+uc). Does not
/// throw.
[[nodiscard]] Eigensystem eigensystem(const FaceState& face, double gamma);

[[nodiscard]] std::array<double, 3> multiply(const std::array<std::array<double, 3>, 3>& matrix,
                                             const std::array<double, 3>& vector);

}  // namespace drogue::reference
