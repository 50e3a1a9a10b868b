#pragma once

#include "common/scene/table.hpp"
#include "miniapps/parachute/scene/scene.hpp"

namespace drogue::parachute_app {

/// Checks that no sheet of a complete scene meets an image beyond periodic sides at the start, and that no
/// body in prescribed motion meets the image of another one at several times of the run. Throws `Failure`
/// (invalid_scene) at the key that places the later of both.
void check_images(const scene::Table& root, const FlowScene& scene);

}  // namespace drogue::parachute_app
