#pragma once

#include "kernels/gas/parameters.hpp"
#include "kernels/reference/gas/euler.hpp"

namespace drogue::reference {

/// Velocity, total specific enthalpy and speed of sound at a face.
struct FaceState {
  double u = 0.0;
  double enthalpy = 0.0;
  double c = 0.0;
};

/// Full matrices: row s of `left` and column s of `right` belong to u-c, u, u+c; left * right = 1.
struct Eigensystem {
  std::array<std::array<double, 3>, 3> left{};
  std::array<std::array<double, 3>, 3> right{};
};

/// Mean of two neighbouring cells; c^2 = (gamma-1)(H - u^2/2) for each kind of mean.
[[nodiscard]] FaceState face_state(const Conserved& a, const Conserved& b, gas::FaceAverage average,
                                   double gamma);

/// Eigenvectors of the flux Jacobian, right ones scaled as (1, u-c, H-uc), (1, u, u^2/2), (1, u+c, H+uc).
[[nodiscard]] Eigensystem eigensystem(const FaceState& face, double gamma);

[[nodiscard]] std::array<double, 3> multiply(const std::array<std::array<double, 3>, 3>& matrix,
                                             const std::array<double, 3>& vector);

}  // namespace drogue::reference
