#include "miniapps/framework/run_output.hpp"

#include <cmath>
#include <fstream>
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
  const std::filesystem::path former =
      files.restart.has_parent_path() ? files.restart.parent_path() : std::filesystem::path(".");
  const double now = simulation.now().time;
  const std::vector<double> missing =
      run::FieldsWriter::missing_times(files.directory, former, simulation.output().times, now);
  if (missing.empty()) return;
  std::string times;
  for (const double time : missing) times += (times.empty() ? "" : ", ") + scene::real_text(time);
  throw Failure(ExitCode::io_error,
                "cannot write the fields at output.times " + times + ": the run continues from t = " +
                    scene::rounded_text(now) + " s, and '" + (files.directory / "fields.h5").string() +
                    "' does not hold them; leave these times out, or begin anew with --overwrite");
}

/// Fields that rank 0 writes. All ranks call the same functions, throw what rank 0 throws, and receive the
/// places at which they write their parts.
class SharedFields final : public run::FieldSink {
 public:
  /// `writer` is null on ranks other than 0.
  SharedFields(Communicator& communicator, std::unique_ptr<run::FieldSink> writer)
      : _communicator(communicator), _writer(std::move(writer)) {}

  void add_mesh(const run::DatasetSpec& spec, const run::Source& source) override {
    _communicator.run_on_root([&] { _writer->add_mesh(spec, source); });
  }
  void add_mesh(const run::DatasetSpec& spec, const run::IntegerSource& source) override {
    _communicator.run_on_root([&] { _writer->add_mesh(spec, source); });
  }
  void begin_step(double time, std::int64_t step) override {
    _communicator.run_on_root([&] { _writer->begin_step(time, step); });
  }
  void write(std::string_view field, std::uint64_t first, std::span<const double> values) override {
    _communicator.run_on_root([&] { _writer->write(field, first, values); });
  }
  [[nodiscard]] run::FieldPlace place(std::string_view field) const override {
    run::FieldPlace place;
    _communicator.run_on_root([&] {
      place = _writer->place(field);
      place.file = std::filesystem::absolute(place.file);
    });
    return {_communicator.broadcast(place.file.string()), _communicator.broadcast(place.offset)};
  }
  void end_step() override {
    _communicator.run_on_root([&] { _writer->end_step(); });
  }

 private:
  Communicator& _communicator;
  std::unique_ptr<run::FieldSink> _writer;
};

}  // namespace

void write_restart_file(Simulation& simulation, const RunFiles& files) {
  run::RestartWriter writer(files.directory / "restart.h5", files.fingerprint, files.communicator);
  simulation.write_restart(writer);
  writer.commit();
}

void require_continuable(Simulation& simulation, const RunFiles& files) {
  if (files.directory.empty()) return;
  if (simulation.output().history_every > 0)
    run::require_same_columns(files.directory / "history.csv", simulation.history_columns());
  if (simulation.output().fields.empty()) return;
  run::FieldsWriter::require_same_fields(files.directory, simulation.field_specs(), simulation.now().time);
  require_output_times(simulation, files);
}

RunOutput::RunOutput(Simulation& simulation, const RunFiles& files)
    : _simulation(simulation),
      _files(files),
      _communicator(files.communicator),
      _has_history(simulation.output().history_every > 0),
      _writer(simulation.snapshot_buffers()) {
  const bool has_fields = !simulation.output().fields.empty();
  _communicator.run_on_root([&] {
    std::optional<double> resume_time;
    if (!files.restart.empty()) resume_time = simulation.now().time;
    if (_has_history) open_history(resume_time);
    if (has_fields) open_fields(resume_time);
    std::error_code absent;
    _continues_restart_file =
        std::filesystem::equivalent(files.restart, files.directory / "restart.h5", absent);
  });
  if (has_fields) _fields = std::make_unique<SharedFields>(_communicator, std::move(_fields));
  _last_row_time = _communicator.broadcast(_last_row_time);
  _continues_restart_file = _communicator.broadcast(_continues_restart_file);
}

void RunOutput::open_history(std::optional<double> resume_time) {
  const std::filesystem::path file = _files.directory / "history.csv";
  const std::vector<run::Column> columns = _simulation.history_columns();
  if (resume_time) copy_history(_files.restart, columns, file);
  _history.emplace(file, columns, resume_time ? std::optional(last_row_to_keep(_simulation)) : std::nullopt);
  if (_history->continues()) _last_row_time = *resume_time;
}

void RunOutput::open_fields(std::optional<double> resume_time) {
  _fields = std::make_unique<run::FieldsWriter>(_files.directory, _files.title, _simulation.field_specs(),
                                                resume_time);
  _simulation.write_mesh(*_fields);
}

void RunOutput::write_row(const HistoryRow& row) {
  if (!lacks_row(row.time)) return;
  _last_row_time = row.time;
  _communicator.run_on_root([&] { _history->append(row.time, row.values); });
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
  // A restart must find every row before it.
  _communicator.run_on_root([&] {
    if (_history) _history->flush();
  });
  write_restart_file(_simulation, _files);
}

void RunOutput::finish() {
  _writer.finish();
  _communicator.run_on_root([&] {
    if (_history) _history->finish();
  });
}

}  // namespace drogue::framework
