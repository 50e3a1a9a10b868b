#pragma once

#include "common/scene/table.hpp"
#include "miniapps/gas/scene.hpp"

namespace drogue::gas_app {

/// Fills the defaults that depend on other keys and refuses what only several keys together make wrong, the
/// initial state at every cell included. Throws Failure(invalid_scene) at the key to blame.
void complete_and_check(const scene::Table& root, GasScene& scene);

}  // namespace drogue::gas_app
