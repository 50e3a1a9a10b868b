#include <bit>
#include <string>

#include "common/program/stopwatch.hpp"
#include "miniapps/parachute/scene/functions.hpp"
#include "miniapps/parachute/simulation/simulation.hpp"

namespace drogue::parachute_app {
namespace {

/// Visits every member of the progress of a run. `number` and `integer` write or read one entry.
template <class Progress, class Number, class Integer>
void visit(Progress& progress, const Number& number, const Integer& integer) {
  number("time", progress.time);
  integer("step", progress.step);
  number("last_dt", progress.last_dt);
  number("dt_min", progress.dt_min);
  number("dt_max", progress.dt_max);
  integer("rate_bits", progress.rate_bits);
  integer("velocity_rate_bits", progress.velocity_rate_bits);
  number("longest_dt", progress.longest_dt);
}

}  // namespace

void Simulation::write_coupling(run::RestartWriter& writer) {
  std::vector<double> values;
  for (const stepping::StateArray& array : _coupled->state()) {
    values.resize(array.size());
    _coupled->download(array.name, values);
    writer.array(array.name, values.size());
    writer.write(array.name, 0, values);
  }
  const auto [flow, block, frame] = _coupled->progress();
  writer.number("block_dt", block.dt);
  writer.integer("block_substeps", block.substeps);
  writer.integer("block_end", block.end);
  writer.integer("block_cloth_step", block.cloth_step);
  writer.integer("block_since", block.since);
  writer.number("block_start", block.start);
  if (_scene.frame != Frame::follow) return;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    writer.number(std::string("frame_velocity_") + axis_names[axis], frame.velocity[axis]);
    writer.number(std::string("frame_start_") + axis_names[axis], frame.start[axis]);
  }
  writer.number("frame_since", frame.since);
}

void Simulation::read_coupling(const run::RestartReader& reader, coupling::Progress& progress) {
  std::vector<double> values;
  for (const stepping::StateArray& array : _coupled->state()) {
    values.resize(array.size());
    reader.read(array.name, 0, values);
    _coupled->upload(array.name, values);
  }
  progress.block = {.dt = reader.number("block_dt"),
                    .substeps = reader.integer("block_substeps"),
                    .end = reader.integer("block_end"),
                    .cloth_step = reader.integer("block_cloth_step"),
                    .since = reader.integer("block_since"),
                    .start = reader.number("block_start")};
  if (_scene.frame != Frame::follow) return;
  coupling::FrameMotion& frame = progress.frame;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    frame.velocity[axis] = reader.number(std::string("frame_velocity_") + axis_names[axis]);
    frame.start[axis] = reader.number(std::string("frame_start_") + axis_names[axis]);
  }
  frame.since = reader.number("frame_since");
}

void Simulation::write_restart(run::RestartWriter& writer) {
  const flow::Progress progress = _solver->progress();
  visit(
      progress, [&](const std::string& name, double value) { writer.number(name, value); },
      [&](const std::string& name, auto value) { writer.integer(name, std::bit_cast<std::int64_t>(value)); });
  _statistics.write(writer, *_solver);
  if (_coupled != nullptr) write_coupling(writer);
  std::vector<double> values;
  for (const stepping::StateArray& array : _solver->state()) {
    values.resize(array.size());
    _solver->download(array.name, values);
    const std::array<int, 3> whole = flow::x_first(array.whole);
    writer.array(array.name, linear::CellBox{{}, whole}.size());
    _parts.collect(whole, values, [&](const run::Blocks& blocks, std::span<const double> part) {
      writer.write(array.name, blocks, part);
    });
  }
}

void Simulation::restore(const run::RestartReader& reader) {
  const ScopedStopwatch stopwatch(_h2d_s);
  coupling::Progress progress;
  visit(
      progress.flow, [&](const std::string& name, double& value) { value = reader.number(name); },
      [&](const std::string& name, auto& value) {
        value = std::bit_cast<std::remove_reference_t<decltype(value)>>(reader.integer(name));
      });
  std::vector<double> values;
  for (const stepping::StateArray& array : _solver->state()) {
    values.resize(array.size());
    reader.read(array.name, _parts.blocks(flow::x_first(array.whole)), values);
    _solver->upload(array.name, values);
  }
  if (_coupled != nullptr) {
    read_coupling(reader, progress);
    _coupled->restore(progress);
  } else {
    _solver->restore(progress.flow);
  }
  _statistics.read(reader, *_solver);
  static_cast<void>(_solver->totals());
  sample_fields(_snapshots[0]);
}

}  // namespace drogue::parachute_app
