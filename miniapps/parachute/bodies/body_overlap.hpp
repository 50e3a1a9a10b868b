#pragma once

#include "common/scene/table.hpp"
#include "miniapps/parachute/scene/scene.hpp"

namespace drogue::parachute_app {

/// Refuses bodies that move against each other and cross, at one of several times of the run, and notes
/// others that overlap. They may touch. Throws `Failure` (invalid_scene).
void check_body_overlaps(const scene::Table& root, FlowScene& scene);

/// Refuses canopies that cross a body at the start, with their cloth or their lines. Throws `Failure`
/// (invalid_scene).
void check_canopies_beside_bodies(const scene::Table& root, const FlowScene& scene);

}  // namespace drogue::parachute_app
