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

}  // namespace

SheetState Simulation::sheet_state() {
  const std::size_t vertices = _sheets.positions.size();
  SheetState state;
  for (auto* values : {&state.positions, &state.velocities, &state.on_air, &state.elastic})
    values->resize(vertices);
  _coupled->fabric().download(state.positions, state.velocities);
  _coupled->download("sheet_force", coupling::numbers(state.on_air));
  _coupled->fabric().forces(state.elastic);
  state.drag.resize(_sheets.line_drag.size() + _sheets.vertex_drag.size());
  if (!state.drag.empty()) _coupled->download("drag", coupling::numbers(state.drag));
  return state;
}

/// Forces of the fluid on the bodies in the last step, N.
std::vector<Vector> Simulation::body_forces() {
  std::vector<Vector> sums(_scene.bodies.size(), Vector{});
  if (sums.empty()) return sums;
  std::vector<Vector> on_fluid(_sheets.positions.size());
  _coupled->download("sheet_force", coupling::numbers(on_fluid));
  auto force = on_fluid.begin();
  for (std::size_t i = 0; i < sums.size(); ++i)
    for (std::size_t k = 0; k < static_cast<std::size_t>(_scene.bodies[i].vertices()); ++k, ++force)
      for (std::size_t axis = 0; axis < 3; ++axis) sums[i][axis] -= (*force)[axis];
  return sums;
}

/// Forces of the fluid outside of closed bodies that move: those of all fluid, in the last step of dt, s,
/// without the inertia of the fluid inside.
void Simulation::append_outside_forces(const std::vector<Vector>& forces, double dt,
                                       framework::HistoryRow& row) {
  for (std::size_t i = 0; i < _inside.size(); ++i) {
    if (!_inside[i].moves()) continue;
    const Vector inertia = _inside[i].inertia(row.time, dt);
    for (std::size_t axis = 0; axis < 3; ++axis) row.values.push_back(forces[i][axis] + inertia[axis]);
  }
}

/// Mean displacements of plates on springs along their normals.
void Simulation::append_displacements(framework::HistoryRow& row) {
  const auto has_mount = [](const Body& body) { return body.mount.has_value(); };
  if (std::ranges::none_of(_scene.bodies, has_mount)) return;
  std::vector<Vector> positions(_sheets.positions.size()), velocities(positions.size());
  _coupled->fabric().download(positions, velocities);
  std::size_t vertex = 0;
  for (const Body& body : _scene.bodies) {
    const auto vertices = static_cast<std::size_t>(body.vertices()),
               normal = static_cast<std::size_t>(body.axis);
    double sum = 0.0;
    for (std::size_t k = 0; k < vertices; ++k, ++vertex)
      sum += positions[vertex][normal] - body.centre[normal];
    if (body.mount) row.values.push_back(sum / static_cast<double>(vertices));
  }
}

void Simulation::append_canopy_values(const coupling::FrameMotion& frame, framework::HistoryRow& row) {
  if (_scene.canopies.empty()) return;
  SheetState state = sheet_state();
  state.air.resize(state.positions.size());
  _coupled->air_velocity(state.air);
  const Vector origin = frame.position(row.time);
  append_measures(_scene, _airstream, _sheets, state, origin, frame.velocity, row);
  std::vector<Vector> on_air = state.on_air;
  for (std::size_t k = 0; k < _sheets.line_drag.size(); ++k)
    on_air.push_back({-state.drag[k][0], -state.drag[k][1], -state.drag[k][2]});
  const double balance = force_balance(_coupled->total_force_on_air(), on_air);
  fabric::Totals totals = _coupled->fabric().totals();
  // The vertices of moving bodies have a mass without meaning.
  for (std::size_t i = 0; i < vertices_of(_scene.bodies); ++i)
    for (const double v : state.velocities[i]) totals.kinetic -= 0.5 * _sheets.fabric.mass[i] * v * v;
  row.values.insert(row.values.end(), {kinetic_energy_at_rest(totals, frame.velocity, _sheets.fabric.mass),
                                       totals.elastic, balance});
  if (_scene.verify.intersections)
    row.values.push_back(count_intersections(_scene, _sheets, state.positions, row.time));
  if (_scene.frame == Frame::follow)
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (_scene.open_axes()[axis]) row.values.insert(row.values.end(), {frame.velocity[axis], origin[axis]});
}

/// Forces of the fluid on flags in the last step, and the places of their tips.
void Simulation::append_flag_values(framework::HistoryRow& row) {
  if (_scene.flags.empty()) return;
  const SheetState state = sheet_state();
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
