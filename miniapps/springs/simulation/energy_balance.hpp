#pragma once

#include "miniapps/springs/scene/scene.hpp"

namespace drogue::springs_app {

/// Sum of the follower pressures that have a potential, Pa: constant ones, on cloth that is closed or whose
/// rim is held in place.
[[nodiscard]] double pressure_with_potential(const SpringsScene& scene);

/// True if kinetic, elastic and potential energy change by contact and friction alone: no damping, pins that
/// stay, and loads with a potential.
[[nodiscard]] bool conserves_energy(const SpringsScene& scene);

}  // namespace drogue::springs_app
