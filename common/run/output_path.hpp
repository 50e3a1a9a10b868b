#pragma once

#include <filesystem>

namespace drogue::run {

/// Whether what is written to `path` replaces a file there, or makes one. Else something else has the name, a
/// device, a pipe or an open descriptor of this process (/dev/stdout), and is written to as it is.
bool is_replaced(const std::filesystem::path& path);

/// The descriptor of this process that `path` stands for, say 1 for /dev/stdout; -1 for any other path.
int own_descriptor(std::filesystem::path path);

/// Whether both names are there and mean the same file, device or pipe. (std::filesystem::equivalent may know
/// regular files and directories alone.)
bool is_same_file(const std::filesystem::path& one, const std::filesystem::path& other);

}  // namespace drogue::run
