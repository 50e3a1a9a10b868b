#pragma once

#include "common/scene/table.hpp"
#include "miniapps/parachute/scene/scene.hpp"

namespace drogue::parachute_app {

/// Checks the canopies of a scene against its grid, its steps and each other. Throws `Failure`
/// (invalid_scene) at the key in error.
void check_canopies(const scene::Table& root, const FlowScene& scene);

}  // namespace drogue::parachute_app
