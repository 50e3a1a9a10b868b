#pragma once

#include "common/scene/table.hpp"
#include "miniapps/parachute/scene/scene.hpp"

/// Declarations of the keys of a parachute scene, bound to variables that must outlive the table.
namespace drogue::parachute_app {

/// Names of the axes in scenes.
inline const scene::Choices<int> axis_choices = {{"x", 0}, {"y", 1}, {"z", 2}};

/// Restriction of a key to scenes with a fluid, `with [fluid]`.
scene::Condition with_fluid(const FlowScene& scene);

/// Declares every key.
void declare_flow_scene(scene::Table& root, FlowScene& scene);

/// Declares the keys of a `[[body]]`.
void declare_body(scene::Table& table, Body& body);

/// Declares the keys of a `[[canopy]]`, some of which apply only with `fluid`. `drops`: true with [drop].
void declare_canopy(scene::Table& table, Canopy& canopy, const scene::Condition& fluid,
                    const std::function<bool()>& drops);

/// Declares the keys of a `[[flag]]`.
void declare_flag(scene::Table& table, Flag& flag);

/// Declares the keys of `porosity`.
void declare_porosity(scene::Table& table, Porosity& porosity);

/// Declares the table [verify].
void declare_verify(scene::Table& table, FlowScene& scene);

}  // namespace drogue::parachute_app
