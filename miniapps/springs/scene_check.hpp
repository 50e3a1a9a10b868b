#pragma once

#include "common/scene/table.hpp"
#include "miniapps/springs/scene.hpp"

namespace drogue::springs_app {

/// Makes the mesh, fills the defaults that depend on other keys and refuses what only several keys together
/// make wrong, every expression at every vertex included. Throws Failure(invalid_scene) at the key to blame.
void complete_and_check(const scene::Table& root, SpringsScene& scene);

/// Makes lines of the edges that are reinforced, after the materials are complete.
void add_reinforcements(const scene::Table& root, SpringsScene& scene);

/// The vertices at which an expression is not 0. Refuses one that is not finite somewhere, or 0 everywhere:
/// then the sentence ends in `what`.
std::vector<int> require_some(const scene::Table& root, const SpringsScene& scene, const std::string& path,
                              const std::string& where, const std::string& what);

/// Where a vertex lies, for the end of a sentence.
std::string place_text(const SpringsScene& scene, std::size_t vertex);

/// The same for [contact], where the run starts.
void check_contact(const scene::Table& root, const SpringsScene& scene);

/// The same for [verify] alone, after all else.
void check_verify(const scene::Table& root, const SpringsScene& scene);

}  // namespace drogue::springs_app
