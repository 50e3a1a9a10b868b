#pragma once

#include "kernels/reference/flow/domain.hpp"

namespace drogue::reference {

/// Value at the face between q[2] and q[3] from five cells q[0] .. q[4], with the upwind side at the low end,
/// in the unit of q. Jiang and Shu 1996, eq. (2.16) ff.; weights Z of Borges, Carmona, Costa and Don 2008,
/// eq. (28). Throws std::invalid_argument for central fluxes.
[[nodiscard]] double upwind_value(const std::array<double, 5>& q, flow::Advection scheme);

/// Flux of momentum component c through the low face along d of its control volume at `face`, per density,
/// m^2/s^2: advection minus viscous stress. Fluid that enters through an outflow has the velocity outside.
[[nodiscard]] double momentum_flux(const FlowDomain& domain, const StaggeredField& u, std::size_t c,
                                   std::size_t d, const GridIndex& face, double time);

/// Rate of change of the velocity without the pressure gradient, m/s^2, in conservative form, with the stress
/// of an eddy viscosity if there is a model. On outflows: advection by the outward velocity, first order,
/// and, where fluid enters, the balance of the half cell with the pressure outside. Zero on sides with a
/// prescribed normal velocity.
[[nodiscard]] StaggeredField momentum_rate(const FlowDomain& domain, const StaggeredField& u, double time);

/// Viscous part of `momentum_rate`, m/s^2: kinematic viscosity times the Laplacian; zero on all sides.
[[nodiscard]] StaggeredField viscous_rate(const FlowDomain& domain, const StaggeredField& u, double time);

}  // namespace drogue::reference
