#pragma once

#include <string>
#include <vector>

#include "miniapps/springs/scene/scene.hpp"

namespace drogue::springs_app {

/// Violations of contact, decided exactly by `reference::intersections` and `reference::enters`.
struct ContactState {
  int intersections = 0;     ///< of segments and triangles with contact.self; parts inside bodies
  double penetration = 0.0;  ///< the most that a vertex lacks of the thickness, over it; of bodies
  std::string meeting;       ///< clause on the first case; empty if there is none
};

/// Contact violations of positions, m, in the numbering of the scene.
[[nodiscard]] ContactState contact_state(const SpringsScene& scene, const std::vector<fabric::Vector>& x);

}  // namespace drogue::springs_app
