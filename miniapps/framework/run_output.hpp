#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "common/run/background_writer.hpp"
#include "miniapps/framework/simulation.hpp"

namespace drogue::framework {

/// Files of a run.
struct RunFiles {
  Communicator& communicator = Communicator::self();  ///< rank 0 writes
  std::filesystem::path directory;                    ///< of the run; empty: nothing is written
  std::string title;                                  ///< scene name, names the grid in ParaView
  std::string fingerprint;                            ///< of the scene, for restart.h5
  std::filesystem::path restart;                      ///< restart file that the run continues from, or empty
  run::DescribeDifference describe_difference;        ///< from the scene of `restart`
};

/// Writes the state of `simulation` to restart.h5, atomically. Collective. Throws `Failure` (io_error).
void write_restart_file(Simulation& simulation, const RunFiles& files);

/// Throws `Failure` (io_error) if history.csv or fields.h5 of the run directory cannot be continued by
/// `simulation`, which has the state of a restart file, or if output times of the scene have passed without
/// an output in fields.h5 or in the one beside the restart file. Changes nothing.
void require_continuable(Simulation& simulation, const RunFiles& files);

/// The files of a run that grow while it steps: history.csv, fields.h5, restart.h5, each only if the scene
/// requests it. One background thread writes fields in the order of their requests. Collective: rank 0
/// writes, and each rank its part of fields on a grid that ranks share. All functions throw `Failure`
/// (io_error), on all ranks.
class RunOutput {
 public:
  /// Continues existing files after the current time if the run continues from a restart file. The history
  /// beside a `restart.h5` of another directory is copied first. `files.directory` must not be empty.
  RunOutput(Simulation& simulation, const RunFiles& files);

  /// True if the run continues from the restart.h5 of its directory. Does not throw.
  [[nodiscard]] bool continues_restart_file() const { return _continues_restart_file; }

  /// True if history.csv exists without a row at `time`, s. Does not throw.
  [[nodiscard]] bool lacks_row(double time) const { return _has_history && time != _last_row_time; }

  /// Appends `row`, unless a row of its time exists.
  void write_row(const HistoryRow& row);

  /// Copies the fields and queues their output. Blocks while all snapshot buffers are in use.
  void write_fields();

  /// Writes restart.h5 after everything that was queued before. Blocks.
  void write_restart();

  /// Blocks until everything is on disk.
  void finish();

 private:
  void open_history(std::optional<double> resume_time);
  void open_fields(std::optional<double> resume_time);

  Simulation& _simulation;
  RunFiles _files;
  Communicator& _communicator;
  const bool _has_history;
  std::optional<run::HistoryWriter> _history;  ///< on rank 0
  std::unique_ptr<run::FieldSink> _fields;
  double _last_row_time = -1.0;
  bool _continues_restart_file = false;
  run::BackgroundWriter _writer;  // last: its thread uses the others until it ends
};

}  // namespace drogue::framework
