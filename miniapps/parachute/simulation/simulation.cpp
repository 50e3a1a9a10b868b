#include "miniapps/parachute/simulation/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <future>
#include <numeric>
#include <sstream>
#include <string>

#include "common/program/stopwatch.hpp"
#include "common/run/fields/rectilinear_mesh.hpp"
#include "common/scene/node.hpp"
#include "miniapps/parachute/bodies/closed_channel.hpp"
#include "miniapps/parachute/scene/exchange.hpp"
#include "miniapps/parachute/scene/functions.hpp"

namespace drogue::parachute_app {
namespace {

using flow::CellField;

bool is_periodic(const flow::Parameters& p, std::size_t side) {
  return p.boundary[side].kind == flow::BoundaryKind::periodic;
}

CellField cell_field(const std::string& name) {
  if (name == "velocity") return CellField::velocity;
  if (name == "vorticity") return CellField::vorticity;
  return name == "pressure" ? CellField::pressure : CellField::q_criterion;
}

run::DatasetSpec field_spec(const std::string& name, const std::array<int, 3>& cells) {
  std::vector<std::uint64_t> shape(cells.begin(), cells.end());
  if (name == "pressure")
    return {.name = name, .shape = shape, .units = "Pa", .centering = "cell", .description = "pressure"};
  if (name == "q_criterion")
    return {.name = name,
            .shape = shape,
            .units = "1/s^2",
            .centering = "cell",
            .description = "half of squared rotation rate less squared strain rate"};
  shape.push_back(3);
  if (name == "velocity")
    return {.name = name, .shape = shape, .units = "m/s", .centering = "cell", .description = "velocity"};
  return {.name = name, .shape = shape, .units = "1/s", .centering = "cell", .description = "vorticity"};
}

/// Point that a grid follows: the payload of the first canopy, or on a stretched grid, whose core also has to
/// hold a canopy that leans, the middle between it and the crown and skirt of the canopies that carry it.
std::vector<coupling::WeightedVertex> followed_vertices(const FlowScene& scene, const Sheets& sheets) {
  const std::size_t payload = sheets.canopies.front().payload.value();
  if (!scene.has_stretched_axes()) return {{static_cast<int>(payload), 1.0}};
  std::vector<std::vector<int>> rings;
  for (std::size_t i = 0; i < sheets.canopies.size(); ++i) {
    const CanopyRows& rows = sheets.canopies[i];
    if (rows.payload != payload) continue;
    std::vector<int>& skirt = rings.emplace_back();
    for (const int line : rows.suspension)
      skirt.push_back(sheets.fabric.mesh.lines[static_cast<std::size_t>(line)][0]);
    std::vector<int>& crown = rings.emplace_back(static_cast<std::size_t>(ring_sizes(scene.canopies[i])[0]));
    std::iota(crown.begin(), crown.end(), static_cast<int>(rows.begin));
  }
  std::vector<coupling::WeightedVertex> vertices = {{static_cast<int>(payload), 0.5}};
  for (const std::vector<int>& ring : rings)
    for (const int vertex : ring)
      vertices.push_back({vertex, 0.5 / static_cast<double>(rings.size() * ring.size())});
  return vertices;
}

/// Flow with all sheets of a scene. Sheets whose motion is prescribed need no steps of their own.
coupling::Parameters coupled_parameters(const FlowScene& scene, const Sheets& sheets) {
  coupling::Parameters p;
  p.flow = scene.parameters;
  p.fabric = sheets.fabric;
  p.sheet = exchange_parameters(scene, sheets);
  p.sheet.closing = closing_sheets(scene);
  if (!scene.has_free_sheets()) p.substeps = 1;
  p.fabric.gravity = scene.gravity;
  p.fabric.contact.self = scene.contact;
  p.fabric.contact.thickness = scene.thickness;
  p.fabric.contact.block = scene.contact_block;
  p.cuts = sheets.cuts;
  p.line_strength = sheets.line_strength;
  p.line_drag = sheets.line_drag;
  p.vertex_drag = sheets.vertex_drag;
  if (scene.frame == Frame::follow) {
    p.follow.vertices = followed_vertices(scene, sheets);
    p.follow.axes = scene.open_axes();
    for (const auto& [vertex, weight] : p.follow.vertices)
      for (std::size_t axis = 0; axis < 3; ++axis)
        p.follow.place[axis] += weight * sheets.positions[static_cast<std::size_t>(vertex)][axis];
  }
  return p;
}

}  // namespace

Simulation::Simulation(const FlowScene& scene, const framework::SimulationSettings& settings)
    : _scene(scene),
      _communicator(settings.communicator),
      _parts(scene.parameters, _communicator.size() > 1 ? linear::RankGroup::world() : linear::RankGroup(),
             device::needs_device(settings.backend)),
      _sheets(make_all_sheets(scene.bodies, scene.canopies, scene.parameters.density,
                              scene.parameters.viscosity, scene.flags)),
      _airstream(scene),
      _images(scene, _sheets),
      _grids(grids_beside_canopies(scene, _sheets)),
      _statistics(scene.parameters.watches_extremes),
      _peaks(scene.canopies.size(), scene.has_sheets()) {
  const linear::RankGroup& group = _parts.group();
  if (group.size() > 1 && scene.has_sheets() && scene.coupling.method == coupling::CouplingMethod::sharp)
    throw Failure(ExitCode::usage, "coupling.method = \"sharp\" works on one rank");
  with_usage_error([&] {  // for ranks that cannot share the grid
    if (scene.has_sheets()) {
      _coupled = coupling::create_solver(settings.backend, coupled_parameters(scene, _sheets), group);
      _solver = &_coupled->flow();
    } else {
      _alone = flow::create_solver(settings.backend, scene.parameters, group);
      _solver = _alone.get();
    }
  });
  for (const Body& body : scene.bodies) _inside.emplace_back(body, scene.parameters);
  if (_coupled != nullptr) _peaks.watch(*_coupled, _sheets);
  if (group.size() > 1) return;
  for (Snapshot& snapshot : _snapshots)
    for (const run::DatasetSpec& spec : field_specs()) snapshot.emplace_back(run::entries(spec));
}

void Simulation::start() {
  const ScopedStopwatch stopwatch(_h2d_s);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string& velocity = _scene.initial_velocity()[axis];
    _solver->upload(flow::velocity_name(axis),
                    evaluate(SpaceTimeFunction(velocity), _parts.lattice(axis), 0.0));
  }
  if (_coupled != nullptr) {
    _coupled->fabric().upload(_sheets.positions, _sheets.velocities);
    _coupled->start();
  } else {
    _solver->start();
  }
  _statistics.begin(_solver->totals());
  sample_fields(_snapshots[0]);  // allocates what all outputs need
}

framework::SimulationTime Simulation::now() {
  const flow::Progress progress = _solver->progress();
  return {progress.step, progress.time};
}

framework::StopReason Simulation::advance(const framework::AdvanceLimits& limits,
                                          const framework::RowSink& rows, const framework::Poll& poll) {
  const ScopedStopwatch stopwatch(_compute_s);
  // Another thread evaluates a row while the device takes the next steps.
  std::future<framework::HistoryRow> row;
  const auto deliver = [&] {
    if (row.valid()) rows(row.get());
  };
  const auto begin_row = [&] {
    deliver();
    row = std::async(std::launch::async, [this, state = row_state()] { return row_of(state); });
  };
  const framework::StopReason reason = take_steps(limits, begin_row, poll);
  deliver();
  return reason;
}

/// `advance`, with `begin_row` where a row is due.
framework::StopReason Simulation::take_steps(const framework::AdvanceLimits& limits,
                                             const std::function<void()>& begin_row,
                                             const framework::Poll& poll) {
  const auto forward = [&](const flow::Status& status) { return poll({status.step, status.time}); };
  const auto at_pause = [&](std::int64_t step) {
    return limits.pause_step >= 0 && step >= limits.pause_step;
  };
  const auto fails_by_image = [&] {
    if (!meets_image()) return false;
    if (limits.row_every > 0) begin_row();
    return true;
  };
  while (true) {
    const std::int64_t before = _solver->progress().step;
    std::int64_t pause = limits.pause_step;
    if (before >= _images.next() && fails_by_image()) return framework::StopReason::failed;
    if (_images.applies() && (pause < 0 || _images.next() < pause)) pause = _images.next();
    if (limits.row_every > 0) {
      const std::int64_t next_row = (before / limits.row_every + 1) * limits.row_every;
      if (pause < 0 || next_row < pause) pause = next_row;
    }
    _stop = _coupled != nullptr ? _coupled->advance(limits.target_time, pause, forward)
                                : _solver->advance(limits.target_time, pause, forward);
    const std::int64_t step = _solver->progress().step;
    const bool failed = _stop == flow::Stop::failed || _stop == flow::Stop::max_steps;
    // The last good state of a failed run ends its history.
    if (limits.row_every > 0 && (failed || (step > before && step % limits.row_every == 0))) begin_row();
    if (failed) return framework::StopReason::failed;
    if (_stop == flow::Stop::target)
      return _images.applies() && fails_by_image() ? framework::StopReason::failed
                                                   : framework::StopReason::target;
    if (_stop == flow::Stop::interrupted) return framework::StopReason::interrupted;
    if (at_pause(step)) return framework::StopReason::pause;
  }
}

framework::HistoryRow Simulation::row() { return row_of(row_state()); }

Simulation::RowState Simulation::row_state() {
  RowState state = {.flow = _solver->totals(), .progress = {}, .sheets = {}, .fabric = {}};
  if (_coupled == nullptr) {
    state.progress.flow = _solver->progress();
    return state;
  }
  state.progress = _coupled->progress();
  state.sheets = sheet_state();
  if (_scene.canopies.empty()) return state;
  state.fabric = _coupled->fabric().totals();
  state.on_air = _coupled->total_force_on_air();
  return state;
}

framework::HistoryRow Simulation::row_of(const RowState& state) {
  const flow::Totals& now = state.flow;
  framework::HistoryRow row = {now.time,
                               {static_cast<double>(now.step), now.dt, now.kinetic_energy, now.enstrophy,
                                now.dissipation, now.momentum[0], now.momentum[1], now.momentum[2],
                                now.max_speed, now.divergence_rms, now.divergence_max}};
  for (std::size_t side = 0; side < 6; ++side)
    if (!is_periodic(_scene.parameters, side)) row.values.push_back(now.outflow[side]);
  append_body_values(state, row);
  if (!_scene.canopies.empty()) append_canopy_values(state, row);
  append_flag_values(state.sheets, row);
  return row;
}

std::vector<run::DatasetSpec> Simulation::field_specs() const {
  std::vector<run::DatasetSpec> specs;
  for (const std::string& name : _scene.output.fields)
    specs.push_back(is_canopy_field(name) ? canopy_field_spec(_sheets, name)
                                          : field_spec(name, _scene.parameters.cells));
  if (specs.empty()) return specs;
  for (const SheetGrid& grid : _grids)
    if (grid.moves) specs.push_back(position_spec(grid));
  return specs;
}

void Simulation::write_mesh(run::FieldSink& fields) const {
  const flow::Parameters& p = _scene.parameters;
  const auto faces = [&](std::size_t axis) {
    std::vector<double> coordinates(static_cast<std::size_t>(p.cells[axis]) + 1, p.high[axis]);
    for (int i = 0; i < p.cells[axis]; ++i)
      coordinates[static_cast<std::size_t>(i)] = flow::face_coordinate(p, axis, i);
    return coordinates;
  };
  run::add_rectilinear_mesh(fields, {faces(0), faces(1), faces(2)}, run::AxisOrder::xyz);
  if (std::ranges::any_of(_scene.output.fields, is_canopy_field)) write_canopy_mesh(_sheets, fields);
  for (const SheetGrid& grid : _grids) write_sheet_mesh(_sheets, grid, fields);
}

void Simulation::sample_fields(Snapshot& snapshot) {
  if (snapshot.empty()) return;
  auto values = snapshot.begin();
  for (const std::string& name : _scene.output.fields)
    if (is_canopy_field(name))
      sample_canopy_field(name, *values++);
    else
      sample_flow_field(cell_field(name), *values++);
  for (const SheetGrid& grid : _grids)
    if (grid.moves) sample_positions(grid, *values++);
}

/// As `flow::Solver::sample`. Throws `Failure` (numerical_failure) for a pressure that did not converge.
void Simulation::sample_flow_field(CellField field, std::span<double> values) {
  _solver->sample(field, values);
  require_converged_pressure(field);
}

framework::FieldsTask Simulation::snapshot() {
  if (_parts.group().size() > 1)
    return [this](run::FieldSink& fields) {
      for (const std::string& name : _scene.output.fields)
        if (is_canopy_field(name)) {
          std::vector<double> values(run::entries(canopy_field_spec(_sheets, name)));
          sample_canopy_field(name, values);
          fields.write("canopy/" + name, 0, values);
        } else {
          const run::ArrayPart part = _parts.cells(field_spec(name, _scene.parameters.cells).shape);
          std::vector<double> values(part.entries());
          sample_flow_field(cell_field(name), values);
          const run::FieldPlace place = fields.place(name);
          run::write_parts(place.file, place.offset, part, values);
        }
      for (const SheetGrid& grid : _grids) {
        if (!grid.moves) continue;
        std::vector<double> values(run::entries(position_spec(grid)));
        sample_positions(grid, values);
        fields.write(grid.name + "/position", 0, values);
      }
    };
  const Snapshot& filled = _snapshots[_next_snapshot];
  sample_fields(_snapshots[_next_snapshot]);
  _next_snapshot = (_next_snapshot + 1) % _snapshots.size();
  return [&filled, &names = _scene.output.fields, &grids = _grids](run::FieldSink& fields) {
    auto values = filled.begin();
    for (const std::string& name : names)
      fields.write((is_canopy_field(name) ? "canopy/" : "") + name, 0, *values++);
    for (const SheetGrid& grid : grids)
      if (grid.moves) fields.write(grid.name + "/position", 0, *values++);
  };
}

void Simulation::describe(run::ResultDocument& result) {
  const flow::Progress progress = _solver->progress();
  result.driver = _solver->driver();
  result.dt_min = progress.dt_min;
  result.dt_max = progress.dt_max;
  if (_parts.group().size() > 1)
    result.metrics.set("messages", "transport", std::string(linear::name(_solver->transport())));
  result.metrics.set("pressure", "solver", std::string(_solver->pressure_solver()));
  result.metrics.set("pressure", "divergence_rms", _solver->totals().divergence_rms);
  if (const auto solve = _solver->last_pressure_solve()) {
    result.metrics.set("pressure", "iterations", static_cast<std::int64_t>(solve->iterations));
    result.metrics.set("pressure", "residual", solve->residual);
    result.metrics.set("pressure", "tolerance", _scene.parameters.pressure_tolerance);
  }
  if (_scene.has_sheets() && _scene.coupling.method != coupling::CouplingMethod::sharp) {
    result.metrics.set("coupling", "edge_inset", edge_inset(_scene));
    result.metrics.set("coupling", "leak_filter", leak_filter(_scene));
    result.metrics.set("coupling", "filter", filter_text(_scene));
  }
  if (!_scene.bodies.empty())
    result.metrics.set("bodies", "vertices", static_cast<std::int64_t>(vertices_of(_scene.bodies)));
  if (!_scene.canopies.empty()) {
    result.metrics.set("canopies", "vertices",
                       static_cast<std::int64_t>(_sheets.positions.size() - vertices_of(_scene.bodies)));
    result.metrics.set("canopies", "substeps", _coupled->progress().block.substeps);
    if (_scene.is_explicit())
      result.metrics.set("canopies", "added_mass_ratio", _scene.largest_added_mass_ratio());
  }
}

run::ResultDocument::WallTimes Simulation::phases() const {
  return {.compute_s = _compute_s, .h2d_s = _h2d_s};
}

framework::StepWork Simulation::step_work() const { return {"cell_steps_per_s", _scene.cells()}; }

}  // namespace drogue::parachute_app
