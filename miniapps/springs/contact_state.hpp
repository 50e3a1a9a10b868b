#pragma once

#include <string>
#include <vector>

#include "miniapps/springs/scene.hpp"

namespace drogue::springs_app {

/// What touches what it may not, decided exactly by `reference::intersections` and `reference::enters`.
struct ContactState {
  int intersections = 0;     ///< segments and triangles that meet, with contact.self; parts within bodies
  double penetration = 0.0;  ///< the most that a vertex lacks of the thickness, over it; of bodies
  std::string meeting;       ///< a sentence's part that names a first case; empty where there is none
};

/// Of positions in the scene's numbering, m.
[[nodiscard]] ContactState contact_state(const SpringsScene& scene, const std::vector<fabric::Vector>& x);

}  // namespace drogue::springs_app
