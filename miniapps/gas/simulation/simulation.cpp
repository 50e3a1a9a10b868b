#include "miniapps/gas/simulation/simulation.hpp"

#include "common/program/stopwatch.hpp"
#include "miniapps/gas/simulation/failure_text.hpp"
#include "miniapps/gas/simulation/fields.hpp"

namespace drogue::gas_app {
namespace {

framework::HistoryRow history_row(const gas::HistoryRow& row) {
  return {row.time,
          {static_cast<double>(row.step), row.dt, row.mass, row.momentum, row.energy, row.boundary[0],
           row.boundary[1], row.boundary[2], row.max_speed, static_cast<double>(row.limited_faces),
           static_cast<double>(row.redone)}};
}

double value_of(const Primitive& state, const std::string& field) {
  return field == "rho" ? state.rho : field == "u" ? state.u : state.p;
}

framework::StopReason framework_stop(gas::Stop stop) {
  switch (stop) {
    case gas::Stop::target:
      return framework::StopReason::target;
    case gas::Stop::pause:
      return framework::StopReason::pause;
    case gas::Stop::interrupted:
      return framework::StopReason::interrupted;
    default:
      return framework::StopReason::failed;
  }
}

}  // namespace

void set_limiter_metrics(const LimiterCounts& counts, run::Metrics& metrics) {
  metrics.set("limiter", "touches", counts.limited_faces);
  metrics.set("limiter", "cells", counts.limited_cells);
  metrics.set("limiter", "redone_steps", counts.redone_steps);
}

std::string precision_name(const gas::Parameters& parameters) {
  return parameters.precision == gas::Precision::split ? "split" : "double";
}

run::DatasetSpec field_spec(const std::string& name, std::int64_t cells) {
  const std::vector<std::uint64_t> shape = {static_cast<std::uint64_t>(cells)};
  if (name == "rho")
    return {.name = name, .shape = shape, .units = "kg/m^3", .centering = "cell", .description = "density"};
  if (name == "u")
    return {.name = name, .shape = shape, .units = "m/s", .centering = "cell", .description = "velocity"};
  return {.name = name, .shape = shape, .units = "Pa", .centering = "cell", .description = "pressure"};
}

run::DatasetSpec cell_centre_spec(std::int64_t cells) {
  return {.name = "x",
          .shape = {static_cast<std::uint64_t>(cells)},
          .units = "m",
          .centering = "cell",
          .description = "cell centres"};
}

Simulation::Simulation(const GasScene& scene, const framework::SimulationSettings& settings)
    : _scene(scene), _settings(settings) {
  _solver = settings.baseline ? gas::create_baseline_solver(settings.backend, scene.parameters)
                              : gas::create_solver(settings.backend, scene.parameters);
}

void Simulation::start() {
  {
    const ScopedStopwatch stopwatch(_h2d_s);
    upload_initial_state(*_solver, _scene);
    _solver->start();
    _initial = _solver->totals();
  }
  allocate_snapshot();
}

/// The first snapshot allocates the memory that all of them use.
void Simulation::allocate_snapshot() {
  if (_scene.output.fields.empty() && _scene.output.restart_every == std::optional(0)) return;
  _solver->begin_snapshot();
  _solver->finish_snapshot();
}

framework::SimulationTime Simulation::now() {
  const gas::RestartState now = _solver->restart_state();
  return {now.step, now.time};
}

framework::StopReason Simulation::advance(const framework::AdvanceLimits& limits,
                                          const framework::RowSink& rows, const framework::Poll& poll) {
  const ScopedStopwatch stopwatch(_compute_s);
  _stop = _solver->advance(
      limits.target_time, limits.pause_step, limits.row_every,
      [&](const gas::HistoryRow& row) { rows(history_row(row)); },
      [&](const gas::Status& status) {
        return poll({status.step, status.time});
      });
  const framework::StopReason stop = framework_stop(_stop);
  // The last good state of a failed run ends its history.
  if (stop == framework::StopReason::failed && limits.row_every > 0) rows(history_row(_solver->totals()));
  return stop;
}

std::vector<run::Column> history_columns() {
  return {{"step", ""},
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
}

framework::HistoryRow Simulation::row() {
  const bool at_start = _solver->restart_state().step == _initial.step;
  return history_row(at_start ? _initial : _solver->totals());
}

std::vector<run::DatasetSpec> Simulation::field_specs() const {
  std::vector<run::DatasetSpec> specs;
  for (const std::string& name : _scene.output.fields)
    specs.push_back(field_spec(name, _scene.parameters.cells));
  return specs;
}

void Simulation::write_mesh(run::FieldSink& fields) const {
  fields.add_mesh(cell_centre_spec(_scene.parameters.cells), [&](std::uint64_t first, std::span<double> x) {
    for (std::size_t i = 0; i < x.size(); ++i)
      x[i] = cell_centre(_scene.parameters, static_cast<std::int64_t>(first + i));
  });
}

framework::FieldsTask Simulation::snapshot() {
  _solver->begin_snapshot();
  return [this](run::FieldSink& fields) {
    const gas::ConstConservedFields u = _solver->finish_snapshot();
    std::vector<double> values;
    for (const std::string& name : _scene.output.fields)
      for_chunks(_scene.parameters.cells, [&](std::int64_t first, std::size_t count) {
        values.resize(count);
        for (std::size_t i = 0; i < count; ++i)
          values[i] =
              value_of(primitive(u, static_cast<std::size_t>(first) + i, _scene.parameters.gamma), name);
        fields.write(name, static_cast<std::uint64_t>(first), values);
      });
  };
}

std::string Simulation::failure_text(bool) {
  return gas_app::failure_text(*_solver, _scene.parameters, _scene.end_time, _stop);
}

void Simulation::describe(run::ResultDocument& result) {
  const gas::RestartState now = _solver->restart_state();
  result.driver = _solver->driver();
  result.dt_min = now.dt_min;
  result.dt_max = now.dt_max;
  set_limiter_metrics({now.limited_faces, _solver->limited_cells(), now.redone}, result.metrics);
  // Orders for smooth flow; SSP Runge-Kutta has the third with three stages as with four.
  result.metrics.set("order", "space", std::int64_t{5});
  result.metrics.set("order", "time", std::int64_t{3});
}

run::ResultDocument::WallTimes Simulation::phases() const {
  if (!_settings.baseline) return {.compute_s = _compute_s, .h2d_s = _h2d_s};
  const gas::PhaseTimes phases = _solver->phase_times();
  return {.compute_s = phases.compute, .h2d_s = phases.h2d, .d2h_s = phases.d2h};
}

framework::StepWork Simulation::step_work() const {
  return {"cell_steps_per_s", static_cast<double>(_scene.parameters.cells)};
}

}  // namespace drogue::gas_app
