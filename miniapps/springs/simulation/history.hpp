#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "common/run/history_writer.hpp"
#include "miniapps/springs/scene/scene.hpp"

namespace drogue::springs_app {

/// Columns of history.csv after the time.
std::vector<run::Column> history_columns(const SpringsScene& scene);

/// Columns of history.csv by name, without units. Checks read the file, so that a run that was interrupted
/// and continued is checked as a whole. Throws `Failure` (io_error).
using History = std::map<std::string, std::vector<double>>;
History read_history(const std::filesystem::path& file);

}  // namespace drogue::springs_app
