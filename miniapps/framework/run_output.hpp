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
  const run::RunDirectory* directory = nullptr;  ///< null: nothing is written
  std::string title;                             ///< scene name, names the grid in ParaView
  std::string fingerprint;                       ///< of the scene, for restart.h5
  std::filesystem::path restart;                 ///< restart file that the run continues from, or empty
  run::DescribeDifference describe_difference;   ///< from the scene of `restart`
};

/// Writes the state of `simulation` to `file`, atomically. Throws `Failure` (io_error).
void write_restart_file(const std::filesystem::path& file, const std::string& fingerprint,
                        Simulation& simulation);

/// Throws `Failure` (io_error) if history.csv or fields.h5 of the run directory cannot be continued by
/// `simulation`, which has the state of a restart file, or if output times of the scene have passed without
/// an output in fields.h5 or in the one beside the restart file. Changes nothing.
void require_continuable(Simulation& simulation, const RunFiles& files);

/// The files of a run that grow while it steps: history.csv, fields.h5, restart.h5, each only if the scene
/// requests it. One background thread writes fields in the order of their requests. All functions throw
/// `Failure` (io_error).
class RunOutput {
 public:
  /// Continues existing files after the current time if the run continues from a restart file. The history
  /// beside a `restart.h5` of another directory is copied first. `files.directory` must not be null.
  RunOutput(Simulation& simulation, const RunFiles& files);

  /// True if history.csv exists without a row at `time`, s. Does not throw.
  [[nodiscard]] bool lacks_row(double time) const { return _history && time != _last_row_time; }

  /// Appends `row`, unless a row of its time exists.
  void write_row(const HistoryRow& row);

  /// Copies the fields and queues their output. Blocks while all snapshot buffers are in use.
  void write_fields();

  /// Writes restart.h5 after everything that was queued before. Blocks.
  void write_restart();

  /// Blocks until everything is on disk.
  void finish();

 private:
  Simulation& _simulation;
  std::filesystem::path _restart_file;
  std::string _fingerprint;
  std::optional<run::HistoryWriter> _history;
  std::unique_ptr<run::FieldSink> _fields;
  double _last_row_time = -1.0;
  run::BackgroundWriter _writer;  // last: its thread uses the others until it ends
};

}  // namespace drogue::framework
