#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "common/run/history_writer.hpp"
#include "miniapps/springs/scene.hpp"

namespace drogue::springs_app {

/// The columns of history.csv after the time.
std::vector<run::Column> history_columns(const SpringsScene& scene);

/// history.csv by column, units left away. What is checked of a run comes from its file, so that a run that
/// was interrupted and continued is checked as a whole. Throws Failure(io_error).
using History = std::map<std::string, std::vector<double>>;
History read_history(const std::filesystem::path& file);

/// Copies the history.csv that lies beside the restart.h5 of a run to `file`, unless there is one already or
/// its columns are others: so that a run that is continued elsewhere is checked as a whole too. What lies
/// beside a restart file of another name may be of another run, and stays. Throws Failure(io_error).
void take_history(const std::filesystem::path& restart, const std::vector<run::Column>& columns,
                  const std::filesystem::path& file);

}  // namespace drogue::springs_app
