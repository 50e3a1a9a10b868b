#pragma once

#include <functional>

#include "common/scene/table.hpp"
#include "miniapps/parachute/bodies/body.hpp"

namespace drogue::parachute_app {

/// Declares the keys of `porosity`.
void declare_porosity(scene::Table& table, Porosity& porosity);

/// Declares the keys of a `[[body]]`.
void declare_body(scene::Table& table, Body& body);

/// Declares the keys of `[coupling]`.
void declare_coupling(scene::Table& table, coupling::SheetParameters& coupling,
                      const std::function<bool()>& with_fluid);

}  // namespace drogue::parachute_app
