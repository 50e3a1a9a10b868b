#pragma once

#include <filesystem>
#include <string>

#include "common/program/failure.hpp"

namespace drogue::run {

/// Returns a `Failure` (io_error) `cannot <action> 'path': <text of the errno>`.
Failure io_failure(const std::string& action, const std::filesystem::path& path, int error);

}  // namespace drogue::run
