#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace drogue::run {

/// Columns of history.csv by name, without units.
using History = std::map<std::string, std::vector<double>>;

/// Reads history.csv. Checks read the file, so that a run that was interrupted and continued is checked as a
/// whole. Throws `Failure` (io_error).
[[nodiscard]] History read_history(const std::filesystem::path& file);

}  // namespace drogue::run
