#pragma once

#include <filesystem>

namespace drogue::run {

/// True if output to `path` replaces or creates a regular file. False for a device, a pipe or an open
/// descriptor of this process (/dev/stdout), which are written directly.
bool is_replaced(const std::filesystem::path& path);

/// Descriptor of this process that `path` names, say 1 for /dev/stdout; -1 for any other path.
int own_descriptor(std::filesystem::path path);

/// True if both paths exist and name the same file, device or pipe. (std::filesystem::equivalent may support
/// regular files and directories only.)
bool is_same_file(const std::filesystem::path& one, const std::filesystem::path& other);

}  // namespace drogue::run
