#pragma once

#include "miniapps/framework/mini_app.hpp"

namespace drogue::parachute_app {

/// The program drogue-parachute. Does not throw.
framework::MiniApp mini_app();

}  // namespace drogue::parachute_app
