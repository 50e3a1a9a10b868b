#pragma once

#include "common/scene/codec.hpp"
#include "common/scene/table.hpp"
#include "miniapps/springs/scene/scene.hpp"

namespace drogue::springs_app {

/// Declares every key of a springs scene, bound to `scene`, which must outlive `root`.
void declare_springs_scene(scene::Table& root, SpringsScene& scene);

/// Declares [contact].
void declare_contact(scene::Table& table, SpringsContact& contact);

/// Codec of three numbers.
scene::Codec vector_codec(fabric::Vector& value);

/// Codec of three numbers; an empty vector is an absent value.
scene::Codec optional_vector_codec(std::vector<double>& value);

/// Name of a quantity in a scene and in result.json.
std::string name_of(FinalQuantity quantity);

/// Declares [verify].
void declare_verify(scene::Table& table, Verify& verify);

}  // namespace drogue::springs_app
