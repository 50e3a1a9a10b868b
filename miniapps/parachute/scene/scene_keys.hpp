#pragma once

#include "common/scene/table.hpp"
#include "miniapps/parachute/scene/scene.hpp"

/// Declarations of the keys of a parachute scene, bound to variables that must outlive the table.
namespace drogue::parachute_app {

/// Names of the axes in scenes.
inline const scene::Choices<int> axis_choices = {{"x", 0}, {"y", 1}, {"z", 2}};

/// Restriction of a key to scenes with a fluid, `with [fluid]`.
scene::Condition with_fluid(const FlowScene& scene);

/// Declares every key, by the functions below.
void declare_flow_scene(scene::Table& root, FlowScene& scene);

void declare_body(scene::Table& table, Body& body);
/// Some keys apply only with `fluid`. `drops`: true with [drop].
void declare_canopy(scene::Table& table, Canopy& canopy, const scene::Condition& fluid,
                    const std::function<bool()>& drops);
void declare_flag(scene::Table& table, Flag& flag);
void declare_porosity(scene::Table& table, Porosity& porosity);
void declare_verify(scene::Table& table, FlowScene& scene);

}  // namespace drogue::parachute_app
