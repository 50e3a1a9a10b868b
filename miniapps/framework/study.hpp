#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "common/program/mini_app_options.hpp"
#include "common/run/run_directory.hpp"
#include "common/study/repeats.hpp"
#include "common/study/study.hpp"
#include "miniapps/framework/device_session.hpp"

namespace drogue::framework {

/// Timed runs of one scene. A failure leaves everything but `code` and `message` empty.
struct RepeatedRun {
  std::vector<double> samples;  ///< compute time of each run, s
  std::int64_t steps = 0;
  std::map<std::string, double> errors;  ///< of the first run
  std::map<std::string, double> others;  ///< further quantities of the first run, say conservation
  std::vector<std::string> checks;       ///< names of the checks, in the order of [verify]
  /// Quantities over time, of the first run at its output times.
  std::map<std::string, std::vector<double>> series;
  ExitCode code = ExitCode::ok;
  std::string message;
};

/// Runs a scene once: adds a sample, and in the first run everything else. Returns `ok` or `interrupted`.
using RunOnce = std::function<ExitCode(RepeatedRun& runs)>;

/// Calls `run_once` until `repeats` is satisfied. `code` is `interrupted` after a signal, and the exit code
/// of a `Failure` that `run_once` throws.
[[nodiscard]] RepeatedRun repeat_run(const study::Repeats& repeats, const RunOnce& run_once);

/// The directory, device and facts of a `--study`. The constructor begins the run directory and starts
/// Kokkos. Throws `Failure`: usage, no_backend, io_error.
class StudySession {
 public:
  /// `printed_scene` is the resolved scene before the study varies it; `useful_threads` is that of its
  /// largest point, for `choose_backend`.
  StudySession(const MiniAppOptions& options, const std::string& program, const std::string& scene_name,
               const std::string& printed_scene, int useful_threads);

  [[nodiscard]] device::Backend backend() const { return _backend; }
  [[nodiscard]] run::RunDirectory& directory() { return _directory; }

  /// Runs `count` points. Shape of `columns` and return value as of `study::run_points`.
  ExitCode run(const study::Columns& columns, std::size_t count, const study::RunPoint& run_point);

 private:
  bool _quiet;
  device::Backend _backend;
  run::RunDirectory _directory;
  DeviceSession _session;
  run::ResultDocument _facts;
};

/// Row of study.csv from the timed runs of a point.
[[nodiscard]] study::StudyRow study_row(RepeatedRun runs);

}  // namespace drogue::framework
