#include <algorithm>
#include <cmath>

#include "miniapps/springs/contact_state.hpp"
#include "miniapps/springs/simulation.hpp"

// What is read back of a solver, in the numbering of the scene.

namespace drogue::springs_app {

using fabric::Vector;

double Simulation::time() const {
  const fabric::TimeState now = _solver->time_state();
  // At a stop the time is that stop to the bit.
  return now.step == _stop_step ? _stop_time : now.time();
}

Row Simulation::row() {
  const fabric::Totals sum = _solver->totals();
  Row row{time(),
          _solver->time_state().step,
          sum.kinetic,
          sum.elastic,
          sum.gravity + sum.load,
          sum.momentum,
          sum.angular_momentum,
          {},
          sum.contact,
          sum.friction,
          0};
  const bool counts = _scene.verify.intersections.has_value();
  if (_scene.output.probes.empty() && !counts) return row;
  std::vector<Vector> x(_problem.x.size()), v(x.size());
  _solver->download(x, v);
  if (counts) row.intersections = contact_state(_scene, _problem.to_scene(x)).intersections;
  for (const int vertex : _problem.probes) row.probes.push_back(x[static_cast<std::size_t>(vertex)]);
  return row;
}

std::map<std::string, double> Simulation::energies() {
  const Row now = row();
  std::map<std::string, double> account = {
      {"kinetic", now.kinetic}, {"elastic", now.elastic}, {"potential", now.potential}};
  if (!_scene.contact.asked_for()) return account;
  account["contact_work"] = now.contact_work;
  account["friction_work"] = now.friction_work;
  return account;
}

Snapshot Simulation::snapshot() {
  std::vector<Vector> x(_problem.x.size()), v(x.size());
  _solver->download(x, v);
  Snapshot snapshot;
  snapshot.time = time();
  snapshot.step = _solver->time_state().step;
  const auto wanted = [&](const char* field) { return std::ranges::count(_scene.output.fields, field) > 0; };
  if (wanted("position")) snapshot.position = _problem.to_scene(x);
  if (wanted("velocity")) snapshot.velocity = _problem.to_scene(v);
  std::map<StressKind, std::vector<fabric::Stress>> known;
  for (const std::string& field : _scene.output.fields) {
    const auto kind = stress_kind(field);
    if (!kind) continue;
    if (!known.contains(*kind)) known[*kind] = stress_of(*kind);
    snapshot.stress[field] = stress_values(field, known[*kind]);
  }
  return snapshot;
}

std::vector<fabric::Stress> Simulation::stress_of(const StressKind& kind) {
  std::vector<fabric::Stress> stress(kind.at_vertices ? _problem.x.size() : _scene.mesh.triangles.size());
  if (!kind.at_vertices) {
    _solver->stress(kind.measure, stress);
    return stress;
  }
  _solver->vertex_stress(kind.measure, stress);
  return _problem.to_scene(stress);
}

void Simulation::reach_output(RunOutput& output) {
  if (!_scene.output.fields.empty()) output.write_fields(snapshot());
  if (!_settings.at_output) return;
  std::vector<Vector> x(_problem.x.size()), v(x.size());
  _solver->download(x, v);
  _settings.at_output(row(), _problem.to_scene(x));
}

RestartState Simulation::restart_state() {
  RestartState state{_solver->time_state(), _stop_step, _stop_time, _dt_min, _dt_max,
                     asked_steps(_scene),   {},         {},         {}};
  std::vector<Vector> x(_problem.x.size()), v(x.size());
  _solver->download(x, v);
  state.x = _problem.to_scene(x);
  state.v = _problem.to_scene(v);
  if (!_scene.contact.asked_for()) return state;
  std::vector<fabric::ContactWork> work(x.size());
  _solver->contact_work(work);
  state.contact_work = _problem.to_scene(std::span<const fabric::ContactWork>(work));
  return state;
}

FinalState Simulation::final_state() {
  const fabric::Parameters& p = _problem.parameters;
  FinalState state;
  state.mass = _problem.mass;
  state.payload = _problem.payload;
  std::vector<Vector> x(_problem.x.size()), v(x.size()), force(x.size());
  _solver->download(x, v);
  _solver->forces(force);
  for (std::size_t i = 0; i < force.size(); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      force[i][axis] += p.mass[i] * p.gravity[axis];
      state.largest_load = std::max(state.largest_load, std::abs(p.load[i][axis]));
    }
  state.x = _problem.to_scene(x);
  state.force = _problem.to_scene(force);
  state.pinned.resize(p.pinned.size());
  for (std::size_t k = 0; k < p.pinned.size(); ++k)
    state.pinned[static_cast<std::size_t>(_problem.order[k])] = p.pinned[k];
  return state;
}

}  // namespace drogue::springs_app
