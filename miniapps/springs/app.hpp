#pragma once

#include "miniapps/framework/mini_app.hpp"

namespace drogue::springs_app {

/// The program drogue-springs.
framework::MiniApp mini_app();

}  // namespace drogue::springs_app
