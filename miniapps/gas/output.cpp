#include "miniapps/gas/output.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <limits>

#include "miniapps/gas/fields.hpp"

namespace drogue::gas_app {

namespace {

run::DatasetSpec field_spec(const std::string& name, std::int64_t cells) {
  const std::vector<std::uint64_t> shape = {static_cast<std::uint64_t>(cells)};
  if (name == "rho") return {name, shape, "kg/m^3", "cell", "density"};
  if (name == "u") return {name, shape, "m/s", "cell", "velocity"};
  return {name, shape, "Pa", "cell", "pressure"};
}

run::DatasetSpec line_spec(std::int64_t cells) {
  return {"x", {static_cast<std::uint64_t>(cells)}, "m", "cell", "cell centres"};
}

std::vector<run::DatasetSpec> field_specs(const GasScene& scene) {
  std::vector<run::DatasetSpec> specs;
  for (const std::string& name : scene.output.fields)
    specs.push_back(field_spec(name, scene.parameters.cells));
  return specs;
}

const std::vector<run::Column> history_columns = {{"step", ""},
                                                  {"dt", "s"},
                                                  {"mass", "kg/m^2"},
                                                  {"momentum", "kg/(m s)"},
                                                  {"energy", "J/m^2"},
                                                  {"mass_outflow", "kg/m^2"},
                                                  {"momentum_outflow", "kg/(m s)"},
                                                  {"energy_outflow", "J/m^2"},
                                                  {"max_speed", "m/s"},
                                                  {"limiter_touches", ""},
                                                  {"redone_steps", ""}};

double value_of(const Primitive& state, const std::string& field) {
  return field == "rho" ? state.rho : field == "u" ? state.u : state.p;
}

}  // namespace

RunOutput::RunOutput(const GasScene& scene, gas::Solver& solver, const run::RunDirectory& directory,
                     std::optional<double> resume_time)
    : _scene(scene),
      _solver(solver),
      _restart_file(directory.file("restart.h5")),
      _last_row_time(resume_time.value_or(-1.0)) {
  if (scene.output.history_every > 0)
    _history.emplace(directory.file("history.csv"), history_columns, resume_time);
  if (scene.output.fields.empty()) return;
  _fields.emplace(directory.path(), scene.name, field_specs(scene), resume_time);
  _fields->add_mesh(line_spec(scene.parameters.cells), [&](std::uint64_t first, std::span<double> x) {
    for (std::size_t i = 0; i < x.size(); ++i)
      x[i] = cell_centre(scene.parameters, static_cast<std::int64_t>(first + i));
  });
}

void RunOutput::write_row(const gas::HistoryRow& row) {
  if (!_history || row.time == _last_row_time) return;
  _last_row_time = row.time;
  const std::array<double, 11> values = {static_cast<double>(row.step),
                                         row.dt,
                                         row.mass,
                                         row.momentum,
                                         row.energy,
                                         row.boundary[0],
                                         row.boundary[1],
                                         row.boundary[2],
                                         row.max_speed,
                                         static_cast<double>(row.limited_faces),
                                         static_cast<double>(row.redone)};
  _history->append(row.time, values);
}

void RunOutput::write_fields(double time, std::int64_t step) {
  if (!_fields) return;
  const auto begin = std::chrono::steady_clock::now();
  _writer.finish();  // the snapshot buffer must be free
  _waited += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  _solver.begin_snapshot();
  _writer.submit([this, time, step] {
    const gas::ConstConservedFields u = _solver.finish_snapshot();
    _fields->begin_step(time, step);
    std::vector<double> values;
    for (const std::string& name : _scene.output.fields)
      for_chunks(_scene.parameters.cells, [&](std::int64_t first, std::size_t count) {
        values.resize(count);
        for (std::size_t i = 0; i < count; ++i)
          values[i] =
              value_of(primitive(u, static_cast<std::size_t>(first) + i, _scene.parameters.gamma), name);
        _fields->write(name, static_cast<std::uint64_t>(first), values);
      });
    _fields->end_step();
  });
}

void RunOutput::write_restart(const RestartState& state) {
  const auto begin = std::chrono::steady_clock::now();
  _writer.finish();
  if (_history) _history->flush();  // a restart must find every row before it
  _solver.begin_snapshot();
  // The limiter's marks are read from the device itself, so this write is not behind the steps.
  gas_app::write_restart(_restart_file, _scene, _solver, _solver.finish_snapshot(), state);
  _waited += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

void RunOutput::finish() {
  const auto begin = std::chrono::steady_clock::now();
  _writer.finish();
  if (_history) _history->finish();
  _waited += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

void write_reference(const GasScene& scene, const run::RunDirectory& directory, const Reference& reference) {
  const auto cells = static_cast<std::int64_t>(reference.x.size());
  run::ReferenceSolution solution;
  solution.scheme = weno_name(scene.verify.reference->weno);
  solution.datasets = {{line_spec(cells), reference.x}};
  for (const std::string& name : scene.output.fields)
    solution.datasets.emplace_back(field_spec(name, cells), name == "rho" ? reference.rho
                                                            : name == "u" ? reference.u
                                                                          : reference.p);
  constexpr double every_step = std::numeric_limits<double>::infinity();
  run::FieldsWriter(directory.path(), scene.name, field_specs(scene), every_step).add_reference(solution);
}

}  // namespace drogue::gas_app
