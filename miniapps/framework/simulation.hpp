#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "common/program/communicator.hpp"
#include "common/program/failure.hpp"
#include "common/run/fields/dataset_spec.hpp"
#include "common/run/fields/field_sink.hpp"
#include "common/run/history_writer.hpp"
#include "common/run/restart/restart_file.hpp"
#include "common/run/result_document.hpp"
#include "common/run/run_directory.hpp"
#include "kernels/device/backend.hpp"
#include "miniapps/framework/history_checks.hpp"
#include "miniapps/framework/scene_identity.hpp"
#include "miniapps/framework/scene_keys.hpp"

/// Everything that scene-driven mini-apps share. A mini-app supplies a `Scene` and a `Simulation`;
/// `run_mini_app` does the rest.
namespace drogue::framework {

/// Progress of a simulation.
struct SimulationTime {
  std::int64_t step = 0;  ///< steps taken since the start of the first run
  double time = 0.0;      ///< simulated, s
};

/// One row of history.csv: the simulated time, s, and one value per column of `history_columns`.
struct HistoryRow {
  double time = 0.0;
  std::vector<double> values;
};

/// Reason for which `Simulation::advance` returned.
enum class StopReason {
  target,       ///< the target time is reached
  pause,        ///< the pause step is reached
  interrupted,  ///< the poll requested the end
  failed        ///< the state is lost or the step limit is reached; `failure_text` explains
};

/// Limits of one call of `Simulation::advance`.
struct AdvanceLimits {
  double target_time = 0.0;      ///< s; the last step ends exactly there
  std::int64_t pause_step = -1;  ///< step number at which to return early; -1: none
  int row_every = 0;             ///< steps between history rows; 0: none
};

/// What a step computes, for the figure of merit of a run.
struct StepWork {
  const char* key = "";  ///< of result.json: "cell_steps_per_s" or "vertex_steps_per_s"
  double items = 0.0;    ///< cells or vertices; 0: not stated
};

using RowSink = std::function<void(const HistoryRow&)>;

/// Reports progress. Returns false once the run shall end after the current step.
using Poll = std::function<bool(const SimulationTime&)>;

/// Writes the fields of one output between `begin_step` and `end_step` of the writer. It runs on the writer's
/// thread while the simulation takes further steps, unless `Simulation::writes_on_calling_thread`.
using FieldsTask = std::function<void(run::FieldSink&)>;

/// One run of a scene, from its start or a restart file to its end. Every function blocks until its result is
/// on the host. Every function may throw `Failure`. On several ranks all call the same functions, of which
/// all but `now`, `phases`, `step_work`, `write_mesh` and those that describe outputs are collective.
class Simulation {
 public:
  Simulation() = default;
  virtual ~Simulation() = default;
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  /// Output requests of the scene.
  [[nodiscard]] virtual const OutputRequest& output() const = 0;

  /// End of the run.
  [[nodiscard]] virtual EndTime end_time() const = 0;

  /// Sets the initial state.
  virtual void start() = 0;

  /// Sets the state of a restart file, so that the run continues bit for bit.
  virtual void restore(const run::RestartReader& reader) = 0;

  /// Writes the state for `restore`.
  virtual void write_restart(run::RestartWriter& writer) = 0;

  [[nodiscard]] virtual SimulationTime now() = 0;

  /// Takes steps until a limit is reached, and passes a row to `rows` every `limits.row_every` steps. Calls
  /// `poll` at least ten times per second.
  virtual StopReason advance(const AdvanceLimits& limits, const RowSink& rows, const Poll& poll) = 0;

  /// Called at a target time, once its outputs are written: plans the steps to the next target. Returns false
  /// if the run cannot continue; `failure_text` then explains.
  virtual bool plan_next_interval() { return true; }

  /// Columns of history.csv after the time.
  [[nodiscard]] virtual std::vector<run::Column> history_columns() const { return {}; }

  /// Row of the current state.
  [[nodiscard]] virtual HistoryRow row() { return {now().time, {}}; }

  /// Datasets of `/steps/N`.
  [[nodiscard]] virtual std::vector<run::DatasetSpec> field_specs() const { return {}; }

  /// Adds the datasets of `/mesh`.
  virtual void write_mesh(run::FieldSink&) const {}

  /// Number of snapshots that may exist at once.
  [[nodiscard]] virtual std::size_t snapshot_buffers() const { return 2; }

  /// True if the tasks of `snapshot` must run on the thread that calls it, before further steps.
  [[nodiscard]] virtual bool writes_on_calling_thread() const { return false; }

  /// Copies the fields of the current state, and returns the task that writes the copy.
  [[nodiscard]] virtual FieldsTask snapshot() {
    return [](run::FieldSink&) {};
  }

  /// One sentence on the failure. `restart_written`: restart.h5 holds the last good state.
  [[nodiscard]] virtual std::string failure_text(bool /*restart_written*/) { return "the run failed"; }

  /// Fills in time step sizes and metrics; `steps` and `time` are set.
  virtual void describe(run::ResultDocument&) {}

  /// Wall times of steps, copies and bounds so far, which do not overlap; the other times are 0.
  [[nodiscard]] virtual run::ResultDocument::WallTimes phases() const { return {}; }

  /// Work of one step. Does not throw.
  [[nodiscard]] virtual StepWork step_work() const { return {}; }

  /// Computes errors and adds the checks of the scene's [verify]. `directory` holds the files of the run;
  /// null if the run writes none and on ranks other than 0, whose checks do not count. Returns `interrupted`
  /// after a signal, otherwise `ok`, also if checks fail.
  virtual ExitCode verify(const run::RunDirectory*, run::ResultDocument&) { return ExitCode::ok; }
};

/// Settings of a simulation that stand on the command line.
struct SimulationSettings {
  device::Backend backend = device::Backend::serial;
  bool baseline = false;                              ///< algorithm of [Shi], with its host-device copies
  bool quiet = false;                                 ///< no progress line
  Communicator& communicator = Communicator::self();  ///< of the ranks that share the grid
};

/// A scene that was read and checked, with every default filled in.
class Scene {
 public:
  Scene() = default;
  virtual ~Scene() = default;
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  /// The resolved scene as TOML; it resolves to itself.
  [[nodiscard]] virtual std::string print() const = 0;

  /// Everything that must agree between a run and its continuation.
  [[nodiscard]] virtual SceneIdentity identity() const = 0;

  /// Sentences on what a user may not have meant, which a run and `--check` print unless they are quiet.
  [[nodiscard]] virtual std::vector<std::string> notices() const { return {}; }

  /// Checks of history.csv.
  [[nodiscard]] virtual std::vector<HistoryCheck> history_checks() const { return {}; }

  /// Text that `--check` prints; may be empty.
  [[nodiscard]] virtual std::string check_report() const { return {}; }

  /// Precision for result.json, `double` or `split`.
  [[nodiscard]] virtual std::string precision() const { return "double"; }

  /// Number of host threads that pay for a step of this scene on one of `ranks` ranks, at least 1
  /// (`choose_backend`); by default without limit.
  [[nodiscard]] virtual int useful_threads(int /*ranks*/) const { return std::numeric_limits<int>::max(); }

  /// Creates the simulation, which keeps a reference to this scene. Requires a running Kokkos.
  [[nodiscard]] virtual std::unique_ptr<Simulation> create(const SimulationSettings& settings) const = 0;
};

}  // namespace drogue::framework
