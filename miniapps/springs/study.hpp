#pragma once

#include <filesystem>

#include "common/program/failure.hpp"
#include "common/program/mini_app_options.hpp"

namespace drogue::springs_app {

/// Runs the scene over the product of the axes of `--study` and writes study.csv, study.json and their
/// picture. Throws Failure: usage for a wrong axis, and what a run of the scene throws.
ExitCode run_study(const MiniAppOptions& options, const std::filesystem::path& file);

}  // namespace drogue::springs_app
