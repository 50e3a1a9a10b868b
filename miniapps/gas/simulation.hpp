#pragma once

#include <filesystem>

#include "common/program/progress.hpp"
#include "common/run/result_document.hpp"
#include "common/run/run_directory.hpp"
#include "miniapps/gas/output.hpp"

namespace drogue::gas_app {

/// How a scene is run.
struct RunSettings {
  device::Backend backend = device::Backend::serial;
  bool seed_mode = false;
  bool quiet = false;
  std::filesystem::path restart;  ///< a restart file, or empty
};

/// Fills in what the machine and the backend are. Needs an initialised runtime.
void describe_device(run::ResultDocument& result, const gas::Parameters& parameters, device::Backend backend);

/// Runs a scene from its state to its end, writes its files and fills `result`.
///
/// Throws Failure: numerical_failure (after the last good state is on disk), io_error. Returns `interrupted`
/// after a signal, the restart file written; otherwise `ok`. Verification is left to the caller.
class Simulation {
 public:
  Simulation(const GasScene& scene, const RunSettings& settings);

  /// Steps to the end time. Without `directory` nothing is written.
  ExitCode run(const run::RunDirectory* directory, run::ResultDocument& result);

  /// Errors, checks and reference, as the scene's [verify] asks. Returns `interrupted` if a signal ended the
  /// reference run, otherwise `ok`, whatever the checks say. A reference run joins the fields in `directory`,
  /// if there is one.
  ExitCode verify(const run::RunDirectory* directory, run::ResultDocument& result);

  /// Writes restart.h5 of the state now.
  void write_restart(const run::RunDirectory& directory);

  /// Largest relative change of mass, momentum and energy that the boundary fluxes do not explain.
  [[nodiscard]] double conservation();

  [[nodiscard]] gas::Solver& solver() { return *_solver; }

 private:
  void describe(run::ResultDocument& result);
  [[nodiscard]] double next_stop(double time) const;
  [[nodiscard]] bool is_output_time(double time) const;

  const GasScene& _scene;
  RunSettings _settings;
  std::unique_ptr<gas::Solver> _solver;
  gas::HistoryRow _initial;
  double _setup_s = 0.0, _compute_s = 0.0, _h2d_s = 0.0, _d2h_s = 0.0, _io_s = 0.0;
};

}  // namespace drogue::gas_app
