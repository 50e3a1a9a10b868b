#pragma once

#include "common/scene/table.hpp"
#include "miniapps/parachute/scene/scene.hpp"

namespace drogue::parachute_app {

/// Fills in the parameters of the solver and the defaults that depend on other keys; checks combinations of
/// keys, the velocities of the sides at time 0 and the initial velocity at every face. Throws `Failure`
/// (invalid_scene) at the key in error.
void complete_and_check(const scene::Table& root, FlowScene& scene);

/// Checks [verify] against the rest of the scene. Throws as `complete_and_check` does.
void check_verify(const scene::Table& root, const FlowScene& scene);

}  // namespace drogue::parachute_app
