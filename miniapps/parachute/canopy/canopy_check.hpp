#pragma once

#include "common/scene/table.hpp"
#include "miniapps/parachute/scene/scene.hpp"

namespace drogue::parachute_app {

/// Checks which canopies share payloads, and places them. Throws `Failure` (invalid_scene) at the key in
/// error.
void check_and_place_canopies(const scene::Table& root, std::vector<Canopy>& canopies);

/// Checks the canopies of a scene against its grid, its steps and each other. Throws `Failure`
/// (invalid_scene) at the key in error.
void check_canopies(const scene::Table& root, const FlowScene& scene);

}  // namespace drogue::parachute_app
