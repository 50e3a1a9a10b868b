#pragma once

#include <vector>

#include "miniapps/springs/scene/scene.hpp"

namespace drogue::springs_app {

/// Sum of the follower pressures that have a potential, Pa: constant ones, on cloth that is closed or whose
/// rim is held in place.
[[nodiscard]] double pressure_with_potential(const SpringsScene& scene);

/// True if kinetic, elastic and potential energy change by contact and friction alone: no damping, pins that
/// stay, and loads with a potential.
[[nodiscard]] bool conserves_energy(const SpringsScene& scene);

/// Volume, m^3, between the triangles at the positions `x`, m, and the first vertex at rest, positive where
/// normals point away from it.
[[nodiscard]] double enclosed_volume(const fabric::Mesh& mesh, const std::vector<fabric::Vector>& x);

}  // namespace drogue::springs_app
