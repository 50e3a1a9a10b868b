#pragma once

#include "miniapps/framework/mini_app.hpp"

namespace drogue::gas_app {

/// The program drogue-gas.
framework::MiniApp mini_app();

}  // namespace drogue::gas_app
