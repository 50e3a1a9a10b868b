#pragma once

#include "kernels/reference/flow/domain.hpp"

namespace drogue::reference {

/// Eddy viscosity at the cells for a velocity at a time (s), m^2/s: Smagorinsky 1963, or Vreman 2004, eq. (5)
/// to (8), with filters as wide as the cells. Zero without a model.
[[nodiscard]] std::vector<double> eddy_viscosity(const FlowDomain& domain, const StaggeredField& u,
                                                 double time);

/// Acceleration by the eddy viscosity, div(2 nu_t S), at the faces, m/s^2; zero on all sides. Outside of a
/// side the eddy viscosity is that of the cell inside, and on an edge the mean of those of the four cells.
[[nodiscard]] StaggeredField eddy_acceleration(const FlowDomain& domain, const StaggeredField& u,
                                               double time);

}  // namespace drogue::reference
