#pragma once

#include "common/scene/table.hpp"
#include "miniapps/parachute/canopy/canopy.hpp"

namespace drogue::parachute_app {

/// Declares the keys of a `[[canopy]]`.
void declare_canopy(scene::Table& table, Canopy& canopy);

}  // namespace drogue::parachute_app
