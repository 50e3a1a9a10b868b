#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "common/program/mini_app_options.hpp"
#include "common/study/ensemble.hpp"
#include "miniapps/framework/scene_identity.hpp"

namespace drogue::framework {

/// A perturbed run of a scene: its place in the study, and its `--set` assignments with those of the
/// command line.
struct EnsembleRun {
  study::Member member;
  std::vector<std::string> sets;
};

/// The resolved scene of a run.
struct ResolvedScene {
  std::string printed;     ///< as in scene.toml
  SceneIdentity identity;  ///< which has the contents of mesh files too
};

/// An ensemble of runs of a scene that a mini-app has checked.
struct Ensemble {
  std::string program, scene;  ///< names
  std::string printed;         ///< the resolved scene before the study varies it
  double end_time = 0.0;       ///< s
  int useful_threads = 1;      ///< of its largest run, as of `choose_backend`
  study::EnsembleAxes axes;
  std::vector<std::string> notices;  ///< of the scene on its finest grid, as of `Scene::notices`
  std::vector<EnsembleRun> runs;     ///< those that take longest first
  std::function<std::string(const std::string& quantity)> title;  ///< of a quantity, for the terminal
  std::function<ResolvedScene(const EnsembleRun& run)> resolve;   ///< the scene of a run
};

/// Number of runs at once unless `jobs` gives it: one for each core on a host, one on a device.
[[nodiscard]] int jobs_of(const MiniAppOptions& options, const Ensemble& ensemble);

/// Runs an ensemble: each run is a process of this program with a run directory of its own below that of the
/// study, so that one that fails costs no other. Takes over the runs that an earlier study has finished in
/// the directory. Writes runs.csv after each run, result.json, and prints error bars. Throws `Failure` after
/// that: interrupted by a signal, or with the code of the first run that failed; else usage, also if a
/// finished run in the directory is of another scene or program, no_backend, io_error.
void run_ensemble(const MiniAppOptions& options, const std::filesystem::path& file, Ensemble ensemble);

}  // namespace drogue::framework
