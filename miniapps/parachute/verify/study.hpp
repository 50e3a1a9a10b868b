#pragma once

#include <filesystem>
#include <functional>

#include "common/program/mini_app_options.hpp"
#include "common/study/repeats.hpp"
#include "miniapps/framework/study.hpp"
#include "miniapps/parachute/simulation/simulation.hpp"

namespace drogue::parachute_app {

/// Refuses what `run_study` does before its first run; returns what `--check` prints on the study. Throws
/// `Failure`: usage, invalid_scene.
std::string check_study(const MiniAppOptions& options, const std::filesystem::path& file);

/// Runs the scene over the product of the axes of `--study`, and writes study.csv, study.json and their
/// picture, with observed orders against the row before; or runs an ensemble (`ensemble_of`). Returns `ok` or
/// `interrupted`. Throws `Failure`: usage for an invalid axis or a scene without exact solution, otherwise
/// like a run.
ExitCode run_study(const MiniAppOptions& options, const std::filesystem::path& file);

/// Runs a scene repeatedly. `errors_of` returns the errors of the first run from its simulation and result,
/// by name; the divergence, 1/s, and the steps of that run are kept too. Throws `Failure` as a run does.
framework::RepeatedRun repeat_scene(
    const FlowScene& scene, device::Backend backend, const study::Repeats& repeats,
    const std::function<std::map<std::string, double>(Simulation&, run::ResultDocument&)>& errors_of);

}  // namespace drogue::parachute_app
