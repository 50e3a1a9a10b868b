#pragma once

#include "common/scene/table.hpp"
#include "miniapps/gas/scene/scene.hpp"

namespace drogue::gas_app {

/// Declares every key of a gas scene, bound to `scene`, which must outlive `root`.
void declare_gas_scene(scene::Table& root, GasScene& scene);

}  // namespace drogue::gas_app
