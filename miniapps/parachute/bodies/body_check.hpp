#pragma once

#include <string>

#include "common/scene/table.hpp"
#include "miniapps/parachute/scene/scene.hpp"

namespace drogue::parachute_app {

/// Fills in defaults of bodies that depend on their kind, and checks bodies against the grid and the steps.
/// Throws `Failure` (invalid_scene) at the key in error.
void complete_and_check_bodies(const scene::Table& root, FlowScene& scene);

/// Checks the coefficients that follow from `porosity`, of the table `name`. Throws `Failure`
/// (invalid_scene).
void check_porosity(const scene::Table& root, const FlowScene& scene, const std::string& name,
                    const Porosity& porosity);

}  // namespace drogue::parachute_app
