#include <array>
#include <string>
#include <vector>

#include "common/program/stopwatch.hpp"
#include "miniapps/gas/simulation/fields.hpp"
#include "miniapps/gas/simulation/simulation.hpp"

namespace drogue::gas_app {

namespace {

constexpr std::array<const char*, 3> field_names = {"rho", "momentum", "energy"};

/// Visits every scalar entry of a restart file. `number` and `integer` write or read one entry.
template <class State, class Row, class Number, class Integer>
void visit(State& r, Row& i, const Number& number, const Integer& integer) {
  number("time", r.time);
  integer("step", r.step);
  integer("limited", r.limited);
  integer("limited_left", r.limited_left);
  integer("halvings", r.halvings);
  number("dt_scale", r.dt_scale);
  integer("redone", r.redone);
  integer("touches", r.limited_faces);
  number("last_dt", r.last_dt);
  number("dt_min", r.dt_min);
  number("dt_max", r.dt_max);
  for (int k = 0; k < 3; ++k) integer("speed_bits_" + std::to_string(k), r.speed[k]);
  for (int side = 0; side < 2; ++side)
    for (int k = 0; k < 3; ++k) {
      const std::string end = std::to_string(side) + "_" + field_names[static_cast<std::size_t>(k)];
      number("boundary_" + end, r.boundary[side][k]);
      number("compensation_" + end, r.compensation[side][k]);
    }
  number("initial_mass", i.mass);
  number("initial_momentum", i.momentum);
  number("initial_energy", i.energy);
}

/// A rejected step may have marked cells before it was redone.
bool has_marks(const gas::RestartState& state) { return state.limited_faces > 0 || state.redone > 0; }

}  // namespace

void Simulation::write_restart(run::RestartWriter& writer) {
  gas::RestartState state = _solver->restart_state();
  _solver->begin_snapshot();
  const gas::ConstConservedFields u = _solver->finish_snapshot();
  visit(
      state, _initial, [&](const std::string& name, double value) { writer.number(name, value); },
      [&](const std::string& name, auto value) { writer.integer(name, static_cast<std::int64_t>(value)); });
  const std::array<std::span<const double>, 3> fields = {u.rho, u.momentum, u.energy};
  for (std::size_t k = 0; k < 3; ++k) {
    writer.array(field_names[k], fields[k].size());
    writer.write(field_names[k], 0, fields[k]);
  }
  if (!has_marks(state)) return;
  writer.array("touched", u.rho.size());
  std::vector<std::uint8_t> flags;
  std::vector<double> values;
  for_chunks(_scene.parameters.cells, [&](std::int64_t first, std::size_t count) {
    flags.resize(count);
    _solver->download_limited_cells(first, flags);
    values.assign(flags.begin(), flags.end());
    writer.write("touched", static_cast<std::uint64_t>(first), values);
  });
}

void Simulation::restore(const run::RestartReader& reader) {
  {
    const ScopedStopwatch stopwatch(_h2d_s);
    gas::RestartState state;
    visit(
        state, _initial, [&](const std::string& name, double& value) { value = reader.number(name); },
        [&](const std::string& name, auto& value) {
          value = static_cast<std::remove_reference_t<decltype(value)>>(reader.integer(name));
        });
    std::array<std::vector<double>, 3> fields;
    for_chunks(_scene.parameters.cells, [&](std::int64_t first, std::size_t count) {
      for (std::size_t k = 0; k < 3; ++k) {
        fields[k].resize(count);
        reader.read(field_names[k], static_cast<std::uint64_t>(first), fields[k]);
      }
      _solver->upload(first, {fields[0], fields[1], fields[2]});
      if (!has_marks(state)) return;
      reader.read("touched", static_cast<std::uint64_t>(first), fields[0]);
      std::vector<std::uint8_t> flags(fields[0].begin(), fields[0].end());
      _solver->upload_limited_cells(first, flags);
    });
    _solver->restore(state);
  }
  allocate_snapshot();
}

}  // namespace drogue::gas_app
