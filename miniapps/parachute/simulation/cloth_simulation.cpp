#include "miniapps/parachute/simulation/cloth_simulation.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "common/program/stopwatch.hpp"
#include "common/scene/node.hpp"
#include "miniapps/parachute/verify/canopy_checks.hpp"

namespace drogue::parachute_app {
namespace {

using fabric::Vector;

constexpr auto integrator = fabric::Integrator::verlet;

/// Automatic steps as a share of the stability limit.
constexpr double share_of_stable_dt = 0.5;

/// Steps between computations of the stability limit, which falls with strain.
constexpr std::int64_t steps_per_block = 256;

constexpr double most_steps_of_drop = 1e15;

fabric::Parameters fabric_parameters(const FlowScene& scene, const Sheets& sheets) {
  fabric::Parameters p = sheets.fabric;
  p.gravity = scene.gravity;
  p.contact.self = scene.contact;
  p.contact.thickness = scene.thickness;
  p.integrator = integrator;
  p.dt = 1.0;  // until the first block is planned
  return p;
}

}  // namespace

Sheets cloth_sheets(const FlowScene& scene) {
  return make_all_sheets({}, scene.canopies, scene.parameters.density, scene.parameters.viscosity);
}

ClothSimulation::ClothSimulation(const FlowScene& scene, const framework::SimulationSettings& settings)
    : _scene(scene),
      _sheets(cloth_sheets(scene)),
      _airstream(scene),
      _cuts(_sheets.cuts, _sheets.fabric),
      // It takes a kernel of each step.
      _peaks(scene.canopies.size(), !scene.verify.peak_forces.empty()) {
  if (settings.communicator.size() > 1)
    throw Failure(ExitCode::usage, "scenes without [fluid] run on one rank");
  _solver = fabric::create_solver(settings.backend, fabric_parameters(scene, _sheets));
}

void ClothSimulation::start() {
  const ScopedStopwatch stopwatch(_h2d_s);
  _solver->upload(_sheets.positions, _sheets.velocities);
  _peaks.watch(*_solver, _sheets);
  allocate_buffers();
}

/// Allocates what rows of the history, outputs and blocks need.
void ClothSimulation::allocate_buffers() {
  static_cast<void>(sheet_state());
  static_cast<void>(_solver->totals());
  static_cast<void>(_solver->fastest_frequency());
  static_cast<void>(snapshot());
}

/// Plans a block of steps from now towards a time, s, and cuts the lines that are due. Returns false if
/// run.dt is too long.
bool ClothSimulation::plan(double target) {
  const auto [step, time] = now();
  if (_cuts.cut_until(time)) _solver->set_line_stiffness(_cuts.stiffness());
  _stable_dt = fabric::stable_dt(integrator, _solver->fastest_frequency(), _solver->fastest_decay());
  const double stop = std::min(target, _cuts.next()), fixed = _scene.parameters.fixed_dt;
  if (fixed > _stable_dt) return false;
  const double longest = fixed > 0.0 ? fixed : share_of_stable_dt * _stable_dt;
  // Round-off of an integer quotient must not add a step.
  const double steps = std::max(1.0, std::ceil((stop - time) / longest * (1.0 - 1e-12)));
  if (!(steps <= most_steps_of_drop))
    throw Failure(
        ExitCode::numerical_failure,
        "the stiffness of the cloth requires more than 1e15 steps to t = " + scene::real_text(stop) + " s");
  const double dt = (stop - time) / steps;
  const bool is_last = steps <= static_cast<double>(steps_per_block);
  const std::int64_t count = is_last ? static_cast<std::int64_t>(steps) : steps_per_block;
  _solver->set_time_state({step, dt, step, time});
  _plan.stop_step = step + count;
  _plan.stop_time = is_last ? stop : _solver->time_state().start + static_cast<double>(count) * dt;
  _plan.count(dt);
  return true;
}

std::int64_t ClothSimulation::steps_to_event(const framework::AdvanceLimits& limits) const {
  const std::int64_t step = _solver->time_state().step;
  std::int64_t next = std::min(_plan.stop_step, _scene.parameters.max_steps);
  if (limits.row_every > 0) next = std::min(next, (step / limits.row_every + 1) * limits.row_every);
  if (limits.pause_step > step) next = std::min(next, limits.pause_step);
  return std::min(next - step, _batch.steps());
}

/// Takes steps and adapts the length of the next batch. Returns false if the state was lost.
bool ClothSimulation::take_steps(std::int64_t steps) {
  const Stopwatch stopwatch;
  _solver->enqueue_steps(steps);
  _failure = _solver->failure();
  _batch.adapt(steps, stopwatch.seconds());
  return !_failure;
}

framework::StopReason ClothSimulation::advance(const framework::AdvanceLimits& limits,
                                               const framework::RowSink& rows, const framework::Poll& poll) {
  const ScopedStopwatch stopwatch(_compute_s);
  // The last good state of a failed run ends its history.
  const auto fail_with_row = [&](std::int64_t step) {
    if (limits.row_every > 0 && step % limits.row_every != 0) rows(row());
    return framework::StopReason::failed;
  };
  while (true) {
    const auto [step, time] = now();
    if (time >= limits.target_time) return framework::StopReason::target;
    if (!poll({step, time})) return framework::StopReason::interrupted;
    if (step >= _scene.parameters.max_steps) return fail_with_row(step);
    // A run that continues may have other outputs.
    if ((step >= _plan.stop_step || _plan.stop_time > limits.target_time) && !plan(limits.target_time))
      return fail_with_row(step);
    if (!take_steps(steps_to_event(limits))) {
      return_to_checkpoint();
      return framework::StopReason::failed;
    }
    const std::int64_t after = _solver->time_state().step;
    if (limits.row_every > 0 && after % limits.row_every == 0) rows(row());
    if (after == limits.pause_step) return framework::StopReason::pause;
  }
}

/// After a failure, the solver has the state of its last checkpoint, which may belong to an earlier block.
void ClothSimulation::return_to_checkpoint() {
  std::vector<Vector> positions(_sheets.positions.size()), velocities(positions.size());
  _solver->download(positions, velocities);
  _solver->upload(positions, velocities);  // forgets the failure
  const fabric::TimeState now = _solver->time_state();
  _plan.stop_step = now.step;
  _plan.stop_time = now.time();
  if (_cuts.restart_at(now.time())) _solver->set_line_stiffness(_cuts.stiffness());
}

SheetState ClothSimulation::sheet_state() {
  const std::size_t vertices = _sheets.positions.size();
  SheetState state;
  for (auto* values : {&state.positions, &state.velocities, &state.on_air, &state.elastic})
    values->resize(vertices);
  _solver->download(state.positions, state.velocities);
  _solver->forces(state.elastic);
  return state;
}

framework::HistoryRow ClothSimulation::row() {
  const auto [step, time] = now();
  framework::HistoryRow row = {time, {static_cast<double>(step), _solver->time_state().dt}};
  if (step == 0) row.values.back() = 0.0;
  const SheetState state = sheet_state();
  append_measures(_scene, _airstream, _sheets, state, {}, {}, row);
  const fabric::Totals totals = _solver->totals();
  row.values.insert(row.values.end(), {totals.kinetic, totals.elastic, totals.gravity, totals.energy()});
  if (_scene.verify.intersections)
    row.values.push_back(count_intersections(_scene, _sheets, state.positions, time));
  return row;
}

std::vector<run::DatasetSpec> ClothSimulation::field_specs() const {
  std::vector<run::DatasetSpec> specs;
  for (const std::string& name : _scene.output.fields) specs.push_back(canopy_field_spec(_sheets, name));
  return specs;
}

void ClothSimulation::write_mesh(run::FieldSink& fields) const { write_canopy_mesh(_sheets, fields); }

framework::FieldsTask ClothSimulation::snapshot() {
  std::vector<std::vector<double>> values;
  for (const run::DatasetSpec& spec : field_specs()) {
    std::vector<double>& field = values.emplace_back(run::entries(spec));
    if (spec.name == "position") {
      copy_canopy_positions(_sheets, sheet_state().positions, field);
      continue;
    }
    std::vector<fabric::Stress> stress(_sheets.fabric.mesh.triangles.size());
    _solver->stress(fabric::StressMeasure::cauchy, stress);
    copy_canopy_stress(_sheets, stress, field);
  }
  return [&names = _scene.output.fields, values = std::move(values)](run::FieldSink& fields) {
    for (std::size_t k = 0; k < names.size(); ++k) fields.write("canopy/" + names[k], 0, values[k]);
  };
}

std::string ClothSimulation::failure_text(bool) {
  const auto [step, time] = now();
  if (!_failure && step >= _scene.parameters.max_steps) return step_limit_text(_scene, time);
  std::ostringstream text;
  text.precision(9);
  if (!_failure) {
    text << "run.dt = " << _scene.parameters.fixed_dt << " s exceeds the largest stable time step, "
         << _stable_dt << " s, at step " << step << ", t = " << time << " s; \"auto\" takes a stable one";
    return text.str();
  }
  text << cloth_failure_text(_failure->reason) << " at "
       << canopy_vertex_text(_sheets, static_cast<std::size_t>(_failure->index)) << " in step "
       << _failure->step << ", t = " << _failure->time << " s; a smaller run.dt may save the run";
  return text.str();
}

void ClothSimulation::describe(run::ResultDocument& result) {
  result.driver = _solver->driver();
  result.dt_min = _plan.dt_min;
  result.dt_max = _plan.dt_max;
  result.metrics.set("canopies", "vertices", static_cast<std::int64_t>(_sheets.positions.size()));
}

run::ResultDocument::WallTimes ClothSimulation::phases() const {
  return {.compute_s = _compute_s, .h2d_s = _h2d_s};
}

framework::StepWork ClothSimulation::step_work() const {
  return {"vertex_steps_per_s", static_cast<double>(_sheets.positions.size())};
}

ExitCode ClothSimulation::verify(const run::RunDirectory* directory, run::ResultDocument& result) {
  _peaks.update(*_solver);
  const run::History rows = rows_of(_scene, directory);
  check_canopies(_scene.verify, _peaks, rows, result);
  check_energy_drift(_scene, rows, result);
  return ExitCode::ok;
}

void ClothSimulation::write_restart(run::RestartWriter& writer) {
  _peaks.write_watch(writer);
  framework::write_restart(writer, *_solver, _plan);
}

void ClothSimulation::restore(const run::RestartReader& reader) {
  const ScopedStopwatch stopwatch(_h2d_s);
  _peaks.require_watch(reader);
  _peaks.watch(*_solver, _sheets);
  framework::read_restart(reader, *_solver, _plan);
  if (_cuts.restart_at(now().time)) _solver->set_line_stiffness(_cuts.stiffness());
  allocate_buffers();
}

}  // namespace drogue::parachute_app
