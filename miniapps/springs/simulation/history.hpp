#pragma once

#include <vector>

#include "common/run/history_writer.hpp"
#include "miniapps/springs/scene/scene.hpp"

namespace drogue::springs_app {

/// Columns of history.csv after the time.
std::vector<run::Column> history_columns(const SpringsScene& scene);

}  // namespace drogue::springs_app
