#pragma once

#include <filesystem>
#include <string>

namespace drogue::options_app {

/// File for the argument BATCH: a file of that path, else the shipped batch of that name. Throws `Failure`
/// (usage), with the nearest shipped name, if neither exists.
std::filesystem::path find_batch(const std::string& argument);

/// One line per shipped batch: its name and its number of rows. Throws `Failure` (io_error).
std::string batch_list();

}  // namespace drogue::options_app
