#pragma once

#include "common/scene/table.hpp"
#include "miniapps/parachute/scene/scene.hpp"

namespace drogue::parachute_app {

/// Declares every key of a parachute scene, bound to `scene`, which must outlive `root`.
void declare_flow_scene(scene::Table& root, FlowScene& scene);

/// Declares the table [verify], bound to that of `scene`, which must outlive `table`.
void declare_verify(scene::Table& table, FlowScene& scene);

}  // namespace drogue::parachute_app
