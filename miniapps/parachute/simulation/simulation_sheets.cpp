#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>
#include <string>

#include "miniapps/parachute/scene/functions.hpp"
#include "miniapps/parachute/simulation/simulation.hpp"

// Bodies and canopies in history.csv and fields.h5.

namespace drogue::parachute_app {
namespace {

using fabric::Vector;

/// Kinetic energy in the frame of the scene of masses, kg, whose totals belong to a frame that moves, J.
double kinetic_energy_at_rest(const fabric::Totals& totals, const Vector& frame_velocity,
                              const std::vector<double>& masses) {
  double energy = totals.kinetic;
  const double mass = std::accumulate(masses.begin(), masses.end(), 0.0);
  for (std::size_t axis = 0; axis < 3; ++axis)
    energy += frame_velocity[axis] * (totals.momentum[axis] + 0.5 * mass * frame_velocity[axis]);
  return energy;
}

bool has_mount(const Body& body) { return body.mount.has_value(); }

}  // namespace

/// State of the sheets as far as the columns of the scene need it.
SheetState Simulation::sheet_state() {
  const std::size_t vertices = _sheets.positions.size();
  SheetState state;
  state.on_air.resize(vertices);
  _coupled->download("sheet_force", coupling::numbers(state.on_air));
  if (_scene.canopies.empty() && _scene.flags.empty() && std::ranges::none_of(_scene.bodies, has_mount))
    return state;
  state.positions.resize(vertices), state.velocities.resize(vertices);
  _coupled->fabric().download(state.positions, state.velocities);
  if (_scene.canopies.empty()) return state;
  state.elastic.resize(vertices), state.air.resize(vertices);
  _coupled->fabric().forces(state.elastic);
  _coupled->air_velocity(state.air);
  state.drag.resize(_sheets.line_drag.size() + _sheets.vertex_drag.size());
  if (!state.drag.empty()) _coupled->download("drag", coupling::numbers(state.drag));
  return state;
}

/// Forces of the fluid on the bodies in the last step, N; then of the fluid outside of closed ones that move,
/// without the inertia of the fluid inside; then mean displacements of plates on springs along their normals.
void Simulation::append_body_values(const RowState& state, framework::HistoryRow& row) {
  std::vector<Vector> forces(_scene.bodies.size(), Vector{});
  auto on_fluid = state.sheets.on_air.begin();
  for (std::size_t i = 0; i < forces.size(); ++i)
    for (std::size_t k = 0; k < static_cast<std::size_t>(_scene.bodies[i].vertices()); ++k, ++on_fluid)
      for (std::size_t axis = 0; axis < 3; ++axis) forces[i][axis] -= (*on_fluid)[axis];
  for (const Vector& force : forces) row.values.insert(row.values.end(), force.begin(), force.end());
  for (std::size_t i = 0; i < _inside.size(); ++i) {
    if (!_inside[i].moves()) continue;
    const Vector inertia = _inside[i].inertia(row.time, state.progress.flow.last_dt);
    for (std::size_t axis = 0; axis < 3; ++axis) row.values.push_back(forces[i][axis] + inertia[axis]);
  }
  std::size_t vertex = 0;
  for (const Body& body : _scene.bodies) {
    const auto begin = vertex, normal = static_cast<std::size_t>(body.axis);
    vertex += static_cast<std::size_t>(body.vertices());
    if (!has_mount(body)) continue;
    double sum = 0.0;
    for (std::size_t k = begin; k < vertex; ++k)
      sum += state.sheets.positions[k][normal] - body.centre[normal];
    row.values.push_back(sum / static_cast<double>(vertex - begin));
  }
}

void Simulation::append_canopy_values(const RowState& state, framework::HistoryRow& row) const {
  const SheetState& sheets = state.sheets;
  const coupling::FrameMotion& frame = state.progress.frame;
  const Vector origin = frame.position(row.time);
  append_measures(_scene, _airstream, _sheets, sheets, origin, frame.velocity, row);
  std::vector<Vector> on_air = sheets.on_air;
  for (std::size_t k = 0; k < _sheets.line_drag.size(); ++k)
    on_air.push_back({-sheets.drag[k][0], -sheets.drag[k][1], -sheets.drag[k][2]});
  fabric::Totals totals = state.fabric;
  // The vertices of moving bodies have a mass without meaning.
  for (std::size_t i = 0; i < vertices_of(_scene.bodies); ++i)
    for (const double v : sheets.velocities[i]) totals.kinetic -= 0.5 * _sheets.fabric.mass[i] * v * v;
  row.values.insert(row.values.end(), {kinetic_energy_at_rest(totals, frame.velocity, _sheets.fabric.mass),
                                       totals.elastic, force_balance(state.on_air, on_air)});
  if (_scene.verify.intersections)
    row.values.push_back(count_intersections(_scene, _sheets, sheets.positions, row.time));
  if (_scene.frame == Frame::follow)
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (_scene.open_axes()[axis]) row.values.insert(row.values.end(), {frame.velocity[axis], origin[axis]});
}

/// Forces of the fluid on flags in the last step, and the places of their tips.
void Simulation::append_flag_values(const SheetState& state, framework::HistoryRow& row) const {
  for (const FlagRows& flag : _sheets.flags) {
    std::array<double, 2> force{}, tip{};
    for (std::size_t axis = 0; axis < 2; ++axis) {
      for (std::size_t i = flag.begin; i < flag.end; ++i) force[axis] -= state.on_air[i][axis];
      tip[axis] = 0.5 * (state.positions[flag.tip[0]][axis] + state.positions[flag.tip[1]][axis]);
    }
    row.values.insert(row.values.end(), {force[0], force[1], tip[0], tip[1]});
  }
}

void Simulation::sample_canopy_field(const std::string& name, std::vector<double>& values) {
  if (name == "position") {
    std::vector<Vector> positions(_sheets.positions.size()), velocities(positions.size());
    _coupled->fabric().download(positions, velocities);
    copy_canopy_positions(_sheets, positions, values);
    return;
  }
  std::vector<fabric::Stress> stress(_sheets.fabric.mesh.triangles.size());
  _coupled->fabric().stress(fabric::StressMeasure::cauchy, stress);
  copy_canopy_stress(_sheets, stress, values);
}

void Simulation::sample_positions(const SheetGrid& grid, std::vector<double>& values) {
  std::vector<Vector> positions(_sheets.positions.size()), velocities(positions.size());
  _coupled->fabric().download(positions, velocities);
  copy_positions(grid.begin, positions, values);
}

}  // namespace drogue::parachute_app
