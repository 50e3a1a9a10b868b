#pragma once

#include "common/scene/read.hpp"
#include "miniapps/gas/scene/scene.hpp"

namespace drogue::gas_app {

/// Fills in the defaults that depend on other keys and checks combinations of keys and the initial state at
/// every cell. Throws `Failure` (invalid_scene) at the key in error.
void complete_and_check(const scene::Place& root, GasScene& scene, framework::InitialCheck check);

}  // namespace drogue::gas_app
