#include <algorithm>
#include <array>
#include <cmath>

#include "kernels/mesh/orientation.hpp"
#include "miniapps/framework/mesh_output.hpp"
#include "miniapps/springs/simulation/contact_state.hpp"
#include "miniapps/springs/simulation/energy_balance.hpp"
#include "miniapps/springs/simulation/history.hpp"
#include "miniapps/springs/simulation/simulation.hpp"
#include "miniapps/springs/vectors.hpp"

// Reads the state of a solver back, in the numbering of the scene.

namespace drogue::springs_app {

using fabric::Vector;

namespace {

run::DatasetSpec field_spec(const std::string& name, const fabric::Mesh& mesh) {
  const std::uint64_t vertices = mesh.rest.size();
  if (name == "position")
    return {.name = name,
            .shape = {vertices, 3},
            .units = "m",
            .centering = "vertex",
            .description = "positions of the vertices"};
  if (name == "velocity")
    return {.name = name,
            .shape = {vertices, 3},
            .units = "m/s",
            .centering = "vertex",
            .description = "velocities of the vertices"};
  return stress_spec(name, mesh);
}

/// Fields of one output, in the scene's numbering; empty where the scene does not request them.
struct FieldValues {
  std::vector<Vector> position, velocity;
  std::map<std::string, std::vector<double>> stress;  ///< by field name

  [[nodiscard]] std::span<const double> of(const std::string& field) const {
    if (field == "position") return numbers(position);
    return field == "velocity" ? numbers(velocity) : std::span<const double>(stress.at(field));
  }
};

}  // namespace

std::vector<Vector> Simulation::positions() {
  std::vector<Vector> x(_problem.x.size()), v(x.size());
  _solver->download(x, v);
  return _problem.to_scene(x);
}

StateTotals Simulation::totals() {
  const fabric::Totals sum = _solver->totals();
  StateTotals totals{.kinetic = sum.kinetic,
                     .elastic = sum.elastic,
                     .potential = sum.gravity + sum.load,
                     .momentum = sum.momentum,
                     .angular_momentum = sum.angular_momentum,
                     .probes = {},
                     .contact_work = sum.contact,
                     .friction_work = sum.friction,
                     .intersections = 0};
  const bool counts = _scene.verify.intersections.has_value();
  if (_scene.output.probes.empty() && !counts && _pressure == 0.0) return totals;
  std::vector<Vector> x(_problem.x.size()), v(x.size());
  _solver->download(x, v);
  const fabric::Mesh& mesh = _problem.parameters.mesh;
  if (_pressure != 0.0)
    totals.potential -= _pressure * mesh::volume_between(mesh.triangles, x, mesh.rest.front());
  if (counts) totals.intersections = contact_state(_scene, _problem.to_scene(x)).intersections;
  for (const int vertex : _problem.probes) totals.probes.push_back(x[static_cast<std::size_t>(vertex)]);
  return totals;
}

std::vector<run::Column> Simulation::history_columns() const { return springs_app::history_columns(_scene); }

framework::HistoryRow Simulation::row() {
  const StateTotals totals = this->totals();
  const framework::SimulationTime now = this->now();
  framework::HistoryRow row{now.time,
                            {static_cast<double>(now.step), totals.kinetic, totals.elastic, totals.potential,
                             totals.kinetic + totals.elastic + totals.potential}};
  std::vector<double>& values = row.values;
  const auto append = [&values](const Vector& v) { values.insert(values.end(), v.begin(), v.end()); };
  append(totals.momentum);
  append(totals.angular_momentum);
  if (_scene.contact.is_enabled()) values.insert(values.end(), {totals.contact_work, totals.friction_work});
  if (_scene.verify.intersections) values.push_back(totals.intersections);
  std::ranges::for_each(totals.probes, append);
  return row;
}

std::vector<run::DatasetSpec> Simulation::field_specs() const {
  std::vector<run::DatasetSpec> specs;
  for (const std::string& name : _scene.output.fields) specs.push_back(field_spec(name, _scene.mesh));
  return specs;
}

void Simulation::write_mesh(run::FieldSink& fields) const {
  framework::write_mesh(
      fields, _scene.mesh,
      "vertices of every piece of a string, those that reinforce edges of cloth alone last");
}

framework::FieldsTask Simulation::snapshot() {
  std::vector<Vector> x(_problem.x.size()), v(x.size());
  _solver->download(x, v);
  FieldValues values;
  const auto wanted = [&](const char* field) { return std::ranges::count(_scene.output.fields, field) > 0; };
  if (wanted("position")) values.position = _problem.to_scene(x);
  if (wanted("velocity")) values.velocity = _problem.to_scene(v);
  std::map<StressKind, std::vector<fabric::Stress>> computed;
  for (const std::string& field : _scene.output.fields) {
    const auto kind = stress_kind(field);
    if (!kind) continue;
    if (!computed.contains(*kind)) computed[*kind] = stress_of(*kind);
    values.stress[field] = stress_values(field, computed[*kind]);
  }
  return [this, values = std::move(values)](run::FieldSink& fields) {
    for (const std::string& name : _scene.output.fields) fields.write(name, 0, values.of(name));
  };
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

FinalState Simulation::final_state() {
  const fabric::Parameters& p = _problem.parameters;
  FinalState state;
  state.elastic_energy = _solver->totals().elastic;
  if (std::ranges::count(_scene.verify.values, FinalQuantity::von_mises, &FinalValue::quantity) > 0)
    state.von_mises = stress_values("vertex_von_mises", stress_of({true, fabric::StressMeasure::cauchy}));
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

ExitCode Simulation::verify(const run::RunDirectory* directory, run::ResultDocument& result) {
  const StateTotals now = totals();
  const auto set = [&result](const char* name, double value) { result.metrics.set("energy", name, value); };
  const bool contact = _scene.contact.is_enabled();
  if (contact) set("contact_work", now.contact_work);
  set("elastic", now.elastic);
  if (contact) set("friction_work", now.friction_work);
  set("kinetic", now.kinetic);
  const bool states_loss = _scene.output.history_every > 0 && conserves_energy(_scene);
  run::History history;
  if (states_loss || needs_history(_scene.verify))
    history = run::read_history(directory->file("history.csv"));
  if (states_loss)
    if (const std::optional<EnergyLoss> loss = energy_loss(history)) {
      set("lost", loss->energy);
      set("lost_share", loss->share);
      result.metrics.set("energy", "lost_rows", static_cast<std::int64_t>(history.at("time").size()));
    }
  set("potential", now.potential);
  springs_app::verify(_scene, final_state(), history, result);
  return ExitCode::ok;
}

}  // namespace drogue::springs_app
