#pragma once

#include "common/scene/table.hpp"
#include "miniapps/parachute/scene/scene.hpp"

namespace drogue::parachute_app {

/// Checks the bodies of a scene against its grid and steps. Throws `Failure` (invalid_scene) at the key in
/// error.
void check_bodies(const scene::Table& root, const FlowScene& scene);

}  // namespace drogue::parachute_app
