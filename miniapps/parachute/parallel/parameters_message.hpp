#pragma once

#include "common/program/message.hpp"
#include "kernels/coupling/sheet/parameters.hpp"

namespace drogue::parachute_app {

/// Appends solver parameters to a message.
void put_parameters(MessageWriter& message, const coupling::Parameters& parameters);

/// Reads what `put_parameters` wrote. Throws std::out_of_range for a message that is too short.
[[nodiscard]] coupling::Parameters get_parameters(MessageReader& message);

}  // namespace drogue::parachute_app
