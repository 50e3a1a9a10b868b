#include "miniapps/framework/run_output.hpp"

#include <cmath>
#include <fstream>
#include <memory>
#include <utility>

#include "common/run/fields/fields_writer.hpp"
#include "common/run/files/io_error.hpp"
#include "common/scene/node.hpp"

namespace drogue::framework {
namespace {

/// Copies the history.csv beside the restart.h5 of another directory to `file`, so that a run that continues
/// elsewhere has the history of the whole. A history with other columns, or beside a restart file of another
/// name, may belong to another run and stays.
void copy_history(const std::filesystem::path& restart, const std::vector<run::Column>& columns,
                  const std::filesystem::path& file) {
  if (restart.filename() != "restart.h5" || std::filesystem::exists(file)) return;
  const std::filesystem::path before = restart.parent_path() / "history.csv";
  std::string line;
  if (!std::getline(std::ifstream(before), line) || line + "\n" != run::history_header(columns)) return;
  std::error_code error;
  std::filesystem::copy_file(before, file, error);
  if (error) throw run::io_failure("write", file, error.value());
}

/// Time, s, up to which a continued run keeps rows. Where a run of the whole has no row at the state of the
/// restart file, that of its former end is dropped.
double last_row_to_keep(Simulation& simulation) {
  const SimulationTime now = simulation.now();
  const bool is_end = !(now.time < simulation.end_time().time);
  const bool has_row = now.step % simulation.output().history_every == 0;
  return is_end || has_row ? now.time : std::nextafter(now.time, -1.0);
}

/// Throws if the run has passed output times of the scene without an output: they would silently be left out.
void require_output_times(Simulation& simulation, const RunFiles& files) {
  const std::filesystem::path& directory = files.directory->path();
  const std::filesystem::path former =
      files.restart.has_parent_path() ? files.restart.parent_path() : std::filesystem::path(".");
  const double now = simulation.now().time;
  const std::vector<double> missing =
      run::FieldsWriter::missing_times(directory, former, simulation.output().times, now);
  if (missing.empty()) return;
  std::string times;
  for (const double time : missing) times += (times.empty() ? "" : ", ") + scene::real_text(time);
  throw Failure(ExitCode::io_error,
                "cannot write the fields at output.times " + times + ": the run continues from t = " +
                    scene::rounded_text(now) + " s, and '" + (directory / "fields.h5").string() +
                    "' does not hold them; leave these times out, or begin anew with --overwrite");
}

}  // namespace

void write_restart_file(const std::filesystem::path& file, const std::string& fingerprint,
                        Simulation& simulation) {
  run::RestartWriter writer(file, fingerprint);
  simulation.write_restart(writer);
  writer.commit();
}

void require_continuable(Simulation& simulation, const RunFiles& files) {
  if (files.directory == nullptr) return;
  if (simulation.output().history_every > 0)
    run::require_same_columns(files.directory->file("history.csv"), simulation.history_columns());
  if (simulation.output().fields.empty()) return;
  run::FieldsWriter::require_same_fields(files.directory->path(), simulation.field_specs(),
                                         simulation.now().time);
  require_output_times(simulation, files);
}

RunOutput::RunOutput(Simulation& simulation, const RunFiles& files)
    : _simulation(simulation),
      _restart_file(files.directory->file("restart.h5")),
      _fingerprint(files.fingerprint),
      _writer(simulation.snapshot_buffers()) {
  std::optional<double> resume_time;
  if (!files.restart.empty()) resume_time = simulation.now().time;
  if (simulation.output().history_every > 0) {
    const std::filesystem::path file = files.directory->file("history.csv");
    const std::vector<run::Column> columns = simulation.history_columns();
    if (resume_time) copy_history(files.restart, columns, file);
    _history.emplace(file, columns, resume_time ? std::optional(last_row_to_keep(simulation)) : std::nullopt);
    if (_history->continues()) _last_row_time = *resume_time;
  }
  if (simulation.output().fields.empty()) return;
  _fields = std::make_unique<run::FieldsWriter>(files.directory->path(), files.title,
                                                simulation.field_specs(), resume_time);
  simulation.write_mesh(*_fields);
}

void RunOutput::write_row(const HistoryRow& row) {
  if (!lacks_row(row.time)) return;
  _last_row_time = row.time;
  _history->append(row.time, row.values);
}

void RunOutput::write_fields() {
  if (!_fields) return;
  const SimulationTime now = _simulation.now();
  _writer.wait_for_slot();
  const auto task = [this, now, write = _simulation.snapshot()] {
    _fields->begin_step(now.time, now.step);
    write(*_fields);
    _fields->end_step();
  };
  if (!_simulation.writes_on_calling_thread()) return _writer.submit(task);
  task();
}

void RunOutput::write_restart() {
  _writer.finish();
  if (_history) _history->flush();  // a restart must find every row before it
  write_restart_file(_restart_file, _fingerprint, _simulation);
}

void RunOutput::finish() {
  _writer.finish();
  if (_history) _history->finish();
}

}  // namespace drogue::framework
