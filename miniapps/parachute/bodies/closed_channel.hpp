#pragma once

#include <vector>

#include "common/scene/table.hpp"
#include "miniapps/parachute/scene/scene.hpp"

namespace drogue::parachute_app {

/// Flat bodies in prescribed motion, normal to an axis, each of which closes a channel along it. Of several
/// impermeable ones along an axis, the first alone. Throws only std::bad_alloc.
[[nodiscard]] std::vector<coupling::ClosingSheet> closing_sheets(const FlowScene& scene);

/// Refuses bodies that close a channel where no flow is possible, or whose flow the coupling would follow
/// only after many steps, without a given bound of dt. Throws `Failure` (invalid_scene).
void check_closed_channels(const scene::Table& root, const FlowScene& scene);

/// Notes sheets of a complete scene that leave so little of a channel open that nearly all of the fluid has
/// to stop before them, which the coupling follows within many steps, without a given bound of dt. Throws
/// only std::bad_alloc.
void note_narrow_channels(const scene::Table& root, FlowScene& scene);

}  // namespace drogue::parachute_app
