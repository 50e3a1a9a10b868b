#pragma once

#include "common/scene/table.hpp"
#include "miniapps/parachute/scene/scene.hpp"

namespace drogue::parachute_app {

/// Lets flags span the domain along z, and checks them against the grid, the steps and each other. Throws
/// `Failure` (invalid_scene) at the key in error.
void complete_and_check_flags(const scene::Table& root, FlowScene& scene);

}  // namespace drogue::parachute_app
