#pragma once

#include <memory>
#include <optional>

#include "common/run/background_writer.hpp"
#include "common/run/fields_writer.hpp"
#include "common/run/history_writer.hpp"
#include "common/run/run_directory.hpp"
#include "miniapps/gas/exact.hpp"
#include "miniapps/gas/restart.hpp"

namespace drogue::gas_app {

/// The files of a run that grow while it steps: history.csv, fields.h5, restart.h5. Only what the scene asks
/// for exists. Fields and restarts are written by one thread behind the steps, in the order they were asked
/// for.
class RunOutput {
 public:
  /// With `resume_time` existing files are continued after that time.
  RunOutput(const GasScene& scene, gas::Solver& solver, const run::RunDirectory& directory,
            std::optional<double> resume_time);

  void write_row(const gas::HistoryRow& row);
  void write_fields(double time, std::int64_t step);
  void write_restart(const RestartState& state);

  /// Waits until everything is on disk.
  void finish();

  /// Seconds that the steps have waited for files.
  [[nodiscard]] double waited() const { return _waited; }

 private:
  const GasScene& _scene;
  gas::Solver& _solver;
  std::filesystem::path _restart_file;
  std::optional<run::HistoryWriter> _history;
  std::optional<run::FieldsWriter> _fields;
  double _last_row_time = -1.0;
  double _waited = 0.0;
  run::BackgroundWriter _writer{1};  // last: its thread uses the others until it is gone
};

/// Keeps the finer run that a scene was compared with beside its fields, for pictures.
void write_reference(const GasScene& scene, const run::RunDirectory& directory, const Reference& reference);

}  // namespace drogue::gas_app
