#pragma once

#include "common/scene/table.hpp"
#include "miniapps/parachute/flags/flag.hpp"

namespace drogue::parachute_app {

/// Declares the keys of a `[[flag]]`.
void declare_flag(scene::Table& table, Flag& flag);

}  // namespace drogue::parachute_app
