#include <bit>
#include <string>

#include "common/program/stopwatch.hpp"
#include "miniapps/parachute/functions.hpp"
#include "miniapps/parachute/simulation.hpp"

namespace drogue::parachute_app {
namespace {

std::string array_name(flow::StateField field) {
  constexpr const char* names[] = {"velocity_x", "velocity_y", "velocity_z", "rate_x",
                                   "rate_y",     "rate_z",     "pressure"};
  return names[static_cast<int>(field)];
}

/// Visits every member of the progress of a run. `number` and `integer` write or read one entry.
template <class Progress, class Number, class Integer>
void visit(Progress& progress, const Number& number, const Integer& integer) {
  number("time", progress.time);
  integer("step", progress.step);
  number("last_dt", progress.last_dt);
  number("dt_min", progress.dt_min);
  number("dt_max", progress.dt_max);
  integer("rate_bits", progress.rate);
}

}  // namespace

std::vector<flow::StateField> Simulation::state_fields() const {
  using enum flow::StateField;
  std::vector<flow::StateField> fields = {velocity_x, velocity_y, velocity_z, pressure};
  if (_scene.parameters.time_scheme == flow::TimeScheme::ab2)
    fields.insert(fields.end(), {rate_x, rate_y, rate_z});
  return fields;
}

void Simulation::write_restart(run::RestartWriter& writer) {
  const flow::Progress progress = _solver->progress();
  visit(
      progress, [&](const std::string& name, double value) { writer.number(name, value); },
      [&](const std::string& name, auto value) { writer.integer(name, std::bit_cast<std::int64_t>(value)); });
  _statistics.write(writer);
  std::vector<double> values;
  for (const flow::StateField field : state_fields()) {
    values.resize(lattice_of(_scene.parameters, field).size());
    _solver->download(field, values);
    writer.array(array_name(field), values.size());
    writer.write(array_name(field), 0, values);
  }
}

void Simulation::restore(const run::RestartReader& reader) {
  const ScopedStopwatch stopwatch(_h2d_s);
  flow::Progress progress;
  visit(
      progress, [&](const std::string& name, double& value) { value = reader.number(name); },
      [&](const std::string& name, auto& value) {
        value = std::bit_cast<std::remove_reference_t<decltype(value)>>(reader.integer(name));
      });
  _statistics.read(reader);
  std::vector<double> values;
  for (const flow::StateField field : state_fields()) {
    values.resize(lattice_of(_scene.parameters, field).size());
    reader.read(array_name(field), 0, values);
    _solver->upload(field, values);
  }
  _solver->restore(progress);
  static_cast<void>(_solver->totals());
  sample_fields(_snapshots[0]);
}

}  // namespace drogue::parachute_app
