#pragma once

#include <filesystem>

#include "common/program/mini_app_options.hpp"
#include "miniapps/framework/study.hpp"

namespace drogue::parachute_app {

/// Runs the scene over the product of the axes of `--study`, and writes study.csv, study.json and their
/// picture, with observed orders against the row before. Returns `ok` or `interrupted`. Throws `Failure`:
/// usage for an invalid axis or a scene without exact solution, otherwise like a run.
ExitCode run_study(const MiniAppOptions& options, const std::filesystem::path& file);

}  // namespace drogue::parachute_app
