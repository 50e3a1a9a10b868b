#pragma once

#include "common/scene/read.hpp"
#include "miniapps/springs/scene/scene.hpp"

namespace drogue::springs_app {

/// Makes the mesh, fills in the defaults that depend on other keys, and checks combinations of keys and every
/// expression at every vertex. Throws `Failure` (invalid_scene) at the key in error.
void complete_and_check(const scene::Place& root, SpringsScene& scene);

/// Converts reinforced edges to lines. Requires complete materials.
void add_reinforcements(const scene::Place& root, SpringsScene& scene);

/// Vertices at which an expression is not 0. Throws `Failure` for an expression that is not finite somewhere,
/// or 0 everywhere; `what` ends the sentence then.
std::vector<int> require_some(const scene::Place& root, const SpringsScene& scene, const std::string& path,
                              const std::string& where, const std::string& what);

/// Checks that an expression fits its device program. Throws `Failure`.
void check_program(const scene::Place& root, const std::string& path, const std::string& expression);

/// Position of a vertex as the end of a sentence.
std::string place_text(const SpringsScene& scene, std::size_t vertex);

/// Checks [contact] at the initial state.
void check_contact(const scene::Place& root, const SpringsScene& scene);

/// Checks [verify], after all other tables.
void check_verify(const scene::Place& root, const SpringsScene& scene);

}  // namespace drogue::springs_app
