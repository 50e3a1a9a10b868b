#pragma once

#include <filesystem>
#include <string>

#include "common/program/mini_app_options.hpp"
#include "miniapps/framework/study.hpp"
#include "miniapps/gas/verify/exact.hpp"

namespace drogue::gas_app {

/// Names of a scheme in scenes. `label` lists the differences to WENO with lf-stencil, ssprk3, double.
struct SchemeNames {
  std::string label, weno, splitting, time, precision;
};

[[nodiscard]] SchemeNames scheme_names(const gas::Parameters& parameters);

/// Runs `scene` without its outputs until `repeats` is satisfied. `errors` are the error norms against
/// `exact`, `others` holds `conservation`. A failed run is recorded in `code` and `message`.
framework::RepeatedRun run_repeatedly(const GasScene& scene, device::Backend backend,
                                      const ExactSolution& exact, const study::Repeats& repeats);

/// Refuses what `run_study` does before its first run; returns what `--check` prints on the study. Throws
/// `Failure`: usage, invalid_scene.
std::string check_study(const MiniAppOptions& options, const std::filesystem::path& file);

/// Runs the scene over the product of the axes of `--study`, and writes study.csv, study.json and their
/// picture. Returns `ok` or `interrupted`. Throws `Failure`: usage for an invalid axis, otherwise like a run.
ExitCode run_study(const MiniAppOptions& options, const std::filesystem::path& file);

}  // namespace drogue::gas_app
