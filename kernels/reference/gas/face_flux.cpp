#include "kernels/reference/gas/face_flux.hpp"

#include <algorithm>

#include "kernels/reference/gas/eigensystem.hpp"
#include "kernels/reference/gas/weno.hpp"

namespace drogue::reference {

SpeedBounds speed_bounds(std::span<const Conserved> cells, double gamma) {
  SpeedBounds bounds;
  for (const Conserved& U : cells) {
    const std::array<double, 3> speeds = wave_speeds(U, gamma);
    for (std::size_t s = 0; s < 3; ++s) bounds.field[s] = std::max(bounds.field[s], speeds[s]);
  }
  bounds.largest = std::max(bounds.field[0], bounds.field[2]);
  return bounds;
}

std::array<double, 3> splitting_alpha(gas::Splitting splitting, const SpeedBounds& mesh,
                                      std::span<const Conserved, 6> stencil, double gamma) {
  switch (splitting) {
    case gas::Splitting::lf_single:
      return {mesh.largest, mesh.largest, mesh.largest};
    case gas::Splitting::lf_global:
      return mesh.field;
    case gas::Splitting::lf_stencil:
      break;
  }
  return speed_bounds(stencil, gamma).field;
}

Conserved face_flux(std::span<const Conserved, 6> stencil, const std::array<double, 3>& alpha,
                    const gas::Parameters& parameters) {
  const double gamma = parameters.gamma;
  const Eigensystem basis =
      eigensystem(face_state(stencil[2], stencil[3], parameters.face_average, gamma), gamma);
  std::array<std::array<double, 3>, 6> states{};
  std::array<std::array<double, 3>, 6> fluxes{};
  for (std::size_t k = 0; k < 6; ++k) {
    states[k] = multiply(basis.left, stencil[k]);
    fluxes[k] = multiply(basis.left, physical_flux(stencil[k], gamma));
  }
  std::array<double, 3> characteristic{};
  for (std::size_t s = 0; s < 3; ++s) {
    std::array<double, 5> rightgoing{};
    std::array<double, 5> leftgoing{};
    for (std::size_t k = 0; k < 5; ++k) {
      rightgoing[k] = 0.5 * (fluxes[k][s] + alpha[s] * states[k][s]);
      leftgoing[k] = 0.5 * (fluxes[5 - k][s] - alpha[s] * states[5 - k][s]);
    }
    characteristic[s] = weno_face_value(rightgoing, parameters.weno, parameters.weno_power) +
                        weno_face_value(leftgoing, parameters.weno, parameters.weno_power);
  }
  return multiply(basis.right, characteristic);
}

Conserved lax_friedrichs_flux(const Conserved& a, const Conserved& b, double alpha, double gamma) {
  const Conserved fa = physical_flux(a, gamma);
  const Conserved fb = physical_flux(b, gamma);
  Conserved flux{};
  for (std::size_t s = 0; s < 3; ++s) flux[s] = 0.5 * (fa[s] + fb[s] - alpha * (b[s] - a[s]));
  return flux;
}

}  // namespace drogue::reference
