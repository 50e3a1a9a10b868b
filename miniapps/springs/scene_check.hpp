#pragma once

#include "common/scene/table.hpp"
#include "miniapps/springs/scene.hpp"

namespace drogue::springs_app {

/// Makes the mesh, fills the defaults that depend on other keys and refuses what only several keys together
/// make wrong, every expression at every vertex included. Throws Failure(invalid_scene) at the key to blame.
void complete_and_check(const scene::Table& root, SpringsScene& scene);

/// The same for [contact], where the run starts.
void check_contact(const scene::Table& root, const SpringsScene& scene);

/// The same for [verify] alone, after all else.
void check_verify(const scene::Table& root, const SpringsScene& scene);

}  // namespace drogue::springs_app
