#pragma once

#include "common/scene/codec.hpp"
#include "common/scene/table.hpp"
#include "miniapps/springs/scene.hpp"

namespace drogue::springs_app {

/// Declares every key of a springs scene, bound to `scene`, which has to outlive `root`.
void declare_springs_scene(scene::Table& root, SpringsScene& scene);

/// The table of what cloth may meet.
void declare_contact(scene::Table& table, SpringsContact& contact);

/// Three numbers.
scene::Codec vector_codec(fabric::Vector& value);

/// The tables that say how the result is checked.
void declare_verify(scene::Table& table, Verify& verify);

}  // namespace drogue::springs_app
