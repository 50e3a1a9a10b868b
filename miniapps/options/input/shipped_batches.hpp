#pragma once

#include <filesystem>
#include <string>

namespace drogue::options_app {

/// The file that the BATCH argument means: a file of that name, else the shipped batch of that name. Throws
/// Failure(usage) with the nearest shipped name where there is neither.
std::filesystem::path find_batch(const std::string& argument);

/// One line a shipped batch: its name and how many rows it has.
std::string batch_list();

}  // namespace drogue::options_app
