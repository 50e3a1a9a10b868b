#pragma once

#include <vector>

#include "miniapps/parachute/scene/scene.hpp"

namespace drogue::parachute_app {

/// Flat bodies in prescribed motion, normal to an axis, each of which closes a channel along it. Of several
/// impermeable ones along an axis, the first alone. Throws only std::bad_alloc.
[[nodiscard]] std::vector<coupling::ClosingSheet> closing_sheets(const FlowScene& scene);

}  // namespace drogue::parachute_app
