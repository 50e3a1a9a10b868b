#pragma once

#include <functional>

#include "common/scene/table.hpp"
#include "miniapps/parachute/canopy/canopy.hpp"

namespace drogue::parachute_app {

/// Declares the keys of a `[[canopy]]`, some of which apply only if `with_fluid` returns true.
void declare_canopy(scene::Table& table, Canopy& canopy, const std::function<bool()>& with_fluid);

}  // namespace drogue::parachute_app
