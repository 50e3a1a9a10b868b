#pragma once

#include <filesystem>
#include <string>

#include "common/program/mini_app_options.hpp"
#include "miniapps/framework/ensemble.hpp"
#include "miniapps/parachute/scene/scene.hpp"

namespace drogue::parachute_app {

/// Runs of `--study ensemble=N,cells=A:B`. Run s has `perturbation.seed` s + 1000 i in canopy i, and the
/// amplitude of the scene, or a fiftieth of the shortest edge_length of all grids. Without canopies, a scene
/// has another initial velocity instead: each component gets a sine along the next axis, of a thousandth of
/// the speed at the end and a phase by std::mt19937(s). With cells F times as many along each axis, cells,
/// edges of sheets and given steps are F times as short. Throws `Failure`: usage, and as `read_flow_scene`
/// for a grid that the scene cannot have.
[[nodiscard]] framework::Ensemble ensemble_of(const MiniAppOptions& options,
                                              const std::filesystem::path& file);

/// Lines of `--check` on the cost of an ensemble. Throws as `ensemble_of`.
[[nodiscard]] std::string ensemble_report(const MiniAppOptions& options, const std::filesystem::path& file);

}  // namespace drogue::parachute_app
