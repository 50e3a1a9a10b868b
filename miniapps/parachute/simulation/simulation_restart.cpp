#include <bit>
#include <string>

#include "common/program/stopwatch.hpp"
#include "miniapps/parachute/scene/functions.hpp"
#include "miniapps/parachute/simulation/simulation.hpp"

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

void Simulation::write_coupling(run::RestartWriter& writer) {
  const std::size_t vertices = _sheets.positions.size();
  std::vector<fabric::Vector> acceleration(vertices), positions(vertices), velocities(vertices);
  _coupled->download_air_acceleration(acceleration);
  _coupled->download_cloth(positions, velocities);
  const auto write = [&](const char* name, const std::vector<fabric::Vector>& values) {
    writer.array(name, 3 * vertices);
    writer.write(name, 0, {values.front().data(), 3 * vertices});
  };
  write("air_acceleration", acceleration);
  if (_scene.is_explicit()) {
    std::vector<fabric::Vector> forces(vertices);
    _coupled->forces(forces);
    write("sheet_force", forces);
  }
  write("sheet_position", positions);
  write("sheet_velocity", velocities);
  if (const std::vector<double> faces = _coupled->download_face_acceleration(); !faces.empty()) {
    writer.array("face_acceleration", faces.size());
    writer.write("face_acceleration", 0, faces);
  }
  _record.write(writer);
  const coupling::BlockProgress block = _coupled->block();
  writer.number("block_dt", block.dt);
  writer.integer("block_substeps", block.substeps);
  writer.integer("block_end", block.end);
  writer.integer("block_cloth_step", block.cloth_step);
  writer.integer("block_since", block.since);
  writer.number("block_start", block.start);
  if (_scene.frame != Frame::follow) return;
  const coupling::FrameMotion frame = _coupled->frame();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    writer.number(std::string("frame_velocity_") + axis_names[axis], frame.velocity[axis]);
    writer.number(std::string("frame_start_") + axis_names[axis], frame.start[axis]);
  }
  writer.number("frame_since", frame.since);
}

void Simulation::read_coupling(const run::RestartReader& reader) {
  const auto values = [&](const char* name) {
    std::vector<fabric::Vector> vectors(_sheets.positions.size());
    reader.read(name, 0, {vectors.front().data(), 3 * vectors.size()});
    return vectors;
  };
  _coupled->upload_cloth(values("sheet_position"), values("sheet_velocity"));
  _coupled->upload_air_acceleration(values("air_acceleration"));
  if (_scene.is_explicit()) _coupled->upload_forces(values("sheet_force"));
  if (std::vector<double> faces = _coupled->download_face_acceleration(); !faces.empty()) {
    reader.read("face_acceleration", 0, faces);
    _coupled->upload_face_acceleration(faces);
  }
  _record.read(reader);
  _coupled->set_block({reader.number("block_dt"), reader.integer("block_substeps"),
                       reader.integer("block_end"), reader.integer("block_cloth_step"),
                       reader.integer("block_since"), reader.number("block_start")});
  if (_scene.frame != Frame::follow) return;
  coupling::FrameMotion frame;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    frame.velocity[axis] = reader.number(std::string("frame_velocity_") + axis_names[axis]);
    frame.start[axis] = reader.number(std::string("frame_start_") + axis_names[axis]);
  }
  frame.since = reader.number("frame_since");
  _coupled->set_frame(frame);
}

void Simulation::write_restart(run::RestartWriter& writer) {
  const flow::Progress progress = _solver->progress();
  visit(
      progress, [&](const std::string& name, double value) { writer.number(name, value); },
      [&](const std::string& name, auto value) { writer.integer(name, std::bit_cast<std::int64_t>(value)); });
  _statistics.write(writer);
  if (_coupled != nullptr) write_coupling(writer);
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
  if (_coupled != nullptr) read_coupling(reader);
  static_cast<void>(_solver->totals());
  sample_fields(_snapshots[0]);
}

}  // namespace drogue::parachute_app
