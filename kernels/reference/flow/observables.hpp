#pragma once

#include "kernels/reference/flow/domain.hpp"

namespace drogue::reference {

/// Sums over the cells of a domain; where the domain has one cell, it has its given length.
struct FlowSums {
  double kinetic_energy = 0.0;      ///< J
  double enstrophy = 0.0;           ///< half the integral of the squared vorticity, m^3/s^2
  double dissipation = 0.0;         ///< W
  Point momentum{};                 ///< kg m/s
  double max_speed = 0.0;           ///< m/s, at cell centres
  std::array<double, 6> outflow{};  ///< m^3/s, through each side
};

/// Gradient of the velocity at the centre of a cell, 1/s: entry [i][j] is the derivative of component i along
/// axis j, a mean over the edges of the cell that are normal to both axes where they differ.
[[nodiscard]] std::array<Point, 3> velocity_gradient(const FlowDomain& domain, const StaggeredField& u,
                                                     const GridIndex& cell, double time);

/// Sums of a velocity field. Energy: mean of the two faces of a cell; squares of shear and vorticity: mean
/// over the edges.
[[nodiscard]] FlowSums flow_sums(const FlowDomain& domain, const StaggeredField& u, double time);

}  // namespace drogue::reference
