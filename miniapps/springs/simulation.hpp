#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>

#include "common/program/progress.hpp"
#include "common/run/result_document.hpp"
#include "common/run/run_directory.hpp"
#include "kernels/fabric/solver.hpp"
#include "miniapps/springs/output.hpp"
#include "miniapps/springs/problem.hpp"
#include "miniapps/springs/restart.hpp"
#include "miniapps/springs/stress_fields.hpp"
#include "miniapps/springs/verify.hpp"

namespace drogue::springs_app {

/// How a scene is run.
struct RunSettings {
  device::Backend backend = device::Backend::serial;
  bool seed_mode = false;  ///< the state travels to the device and back at every step
  bool quiet = false;
  std::filesystem::path restart;  ///< a restart file, or empty
  bool can_be_continued = true;   ///< a run that ends before its time leaves restart.h5
  /// Told of every output time, whether or not fields are written, with the positions in the scene's
  /// numbering, m; may be empty.
  std::function<void(const Row& row, const std::vector<fabric::Vector>& x)> at_output;
};

/// Runs a scene from its state to its end, writes its files and fills `result`.
class Simulation {
 public:
  Simulation(const SpringsScene& scene, const RunSettings& settings);

  /// Steps to the end time. Throws Failure: numerical_failure (after the last good state is on disk),
  /// io_error. Returns `interrupted` after a signal, the restart file written; otherwise `ok`.
  ExitCode run(const run::RunDirectory& directory, run::ResultDocument& result);

  /// Energies now and work done so far, J, as columns of history.csv.
  [[nodiscard]] std::map<std::string, double> energies();

  /// For verification.
  [[nodiscard]] FinalState final_state();

 private:
  void resume();
  void plan();
  void replan_if_stiffer();
  [[nodiscard]] double longest_stable_step(double frequency);
  [[nodiscard]] double stable_dt();
  [[nodiscard]] std::string too_long_step();
  [[nodiscard]] double next_stop(double time) const;
  [[nodiscard]] bool is_output_time(double time) const;
  [[nodiscard]] std::int64_t steps_to_event() const;
  [[nodiscard]] bool advance(std::int64_t steps, ProgressLine& progress);
  void reach_event(RunOutput& output);
  void reach_output(RunOutput& output);
  void round_trip();
  void return_to_last_good(std::int64_t lost);
  [[nodiscard]] double time() const;
  [[nodiscard]] Row row();
  [[nodiscard]] Snapshot snapshot();
  [[nodiscard]] std::vector<fabric::Stress> stress_of(const StressKind& kind);
  [[nodiscard]] RestartState restart_state();
  [[nodiscard]] std::string failure_text(const fabric::Failure& failure) const;
  void describe(run::ResultDocument& result) const;

  const SpringsScene& _scene;
  RunSettings _settings;
  Problem _problem;
  std::unique_ptr<fabric::Solver> _solver;
  std::int64_t _stop_step = 0;
  double _stop_time = 0.0;
  double _dt_min = 0.0, _dt_max = 0.0;
  double _asked_at = 0.0;   ///< 1/s, the bound of frequencies when the largest was last looked for
  std::int64_t _piece = 1;  ///< steps asked for at once
  bool _warm = false;       ///< the first step allocates what all of them use
  double _setup_s = 0.0, _compute_s = 0.0, _h2d_s = 0.0, _d2h_s = 0.0, _io_s = 0.0;
};

}  // namespace drogue::springs_app
