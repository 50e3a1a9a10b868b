#pragma once

#include <array>
#include <map>
#include <optional>

#include "common/run/background_writer.hpp"
#include "common/run/fields_writer.hpp"
#include "common/run/history_writer.hpp"
#include "common/run/run_directory.hpp"
#include "miniapps/springs/restart.hpp"

namespace drogue::springs_app {

/// A row of history.csv.
struct Row {
  double time = 0.0;
  std::int64_t step = 0;
  double kinetic = 0.0, elastic = 0.0, potential = 0.0;  ///< J
  fabric::Vector momentum{}, angular_momentum{};
  std::vector<fabric::Vector> probes;  ///< positions, m
  double contact_work = 0.0;           ///< J, friction apart
  double friction_work = 0.0;          ///< J
  int intersections = 0;
};

/// What is written to fields.h5, in the scene's numbering; empty where the scene does not ask for it.
struct Snapshot {
  double time = 0.0;
  std::int64_t step = 0;
  std::vector<fabric::Vector> position, velocity;
  std::map<std::string, std::vector<double>> stress;  ///< by the names of its fields
};

/// The files of a run that grow while it steps: history.csv, fields.h5, restart.h5. Only what the scene asks
/// for exists. Fields are written by one thread behind the steps, in the order they were asked for.
class RunOutput {
 public:
  /// With `resume_time` existing files are continued after that time, and rows of the run that the file
  /// `restart` is of are taken along.
  RunOutput(const SpringsScene& scene, const run::RunDirectory& directory, std::optional<double> resume_time,
            const std::filesystem::path& restart);

  /// Whether rows of before are there to be continued.
  [[nodiscard]] bool continues_rows() const { return _history && _history->continues(); }

  void write_row(const Row& row);
  void write_fields(Snapshot snapshot);
  void write_restart(const RestartState& state);

  /// Waits until everything is on disk.
  void finish();

  /// Seconds that the steps have waited for files.
  [[nodiscard]] double waited() const { return _waited; }

 private:
  void add_mesh();

  const SpringsScene& _scene;
  std::filesystem::path _restart_file;
  std::string _fingerprint;
  std::optional<run::HistoryWriter> _history;
  std::optional<run::FieldsWriter> _fields;
  double _last_row_time = -1.0;
  double _waited = 0.0;
  run::BackgroundWriter _writer;  // last: its thread uses the others until it is gone
};

}  // namespace drogue::springs_app
