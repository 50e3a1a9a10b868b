#pragma once

#include <vector>

#include "common/run/history_writer.hpp"
#include "miniapps/parachute/scene/scene.hpp"

namespace drogue::parachute_app {

/// Columns of history.csv after the time, of a flow or a cloth drop. Throws only std::bad_alloc.
[[nodiscard]] std::vector<run::Column> history_columns(const FlowScene& scene);

}  // namespace drogue::parachute_app
