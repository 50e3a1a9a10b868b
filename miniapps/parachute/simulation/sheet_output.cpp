#include "miniapps/parachute/simulation/sheet_output.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "kernels/reference/fabric/intersections.hpp"
#include "miniapps/framework/mesh_output.hpp"
#include "miniapps/parachute/canopy/periodic_images.hpp"

namespace drogue::parachute_app {
namespace {

using fabric::Vector;

Vector sum(std::span<const Vector> vectors) {
  Vector total{};
  for (const Vector& each : vectors)
    for (std::size_t axis = 0; axis < 3; ++axis) total[axis] += each[axis];
  return total;
}

/// Elements whose vertices are all in a range, as numbered from its beginning.
template <std::size_t n>
std::vector<std::array<int, n>> elements_between(const std::vector<std::array<int, n>>& parts,
                                                 std::size_t begin, std::size_t end) {
  const auto first = static_cast<int>(begin), last = static_cast<int>(end);
  std::vector<std::array<int, n>> result;
  for (std::array<int, n> part : parts) {
    if (std::ranges::any_of(part, [&](int i) { return i < first || i >= last; })) continue;
    for (int& i : part) i -= first;
    result.push_back(part);
  }
  return result;
}

/// Writes the part of a mesh between two vertices. Springs of mounts lead out of it.
void write_part(const fabric::Mesh& mesh, std::size_t begin, std::size_t end, const std::string& strings,
                const std::string& grid, run::FieldSink& fields) {
  const auto rest = std::span(mesh.rest).subspan(begin, end - begin);
  fabric::Mesh part;
  part.rest.assign(rest.begin(), rest.end());
  part.triangles = elements_between(mesh.triangles, begin, end);
  part.lines = elements_between(mesh.lines, begin, end);
  framework::write_mesh(fields, part, strings, grid);
}

}  // namespace

Airstream::Airstream(const FlowScene& scene) : velocity(scene.stream().value_or(Vector{})) {
  const double gravity = std::hypot(scene.gravity[0], scene.gravity[1], scene.gravity[2]);
  for (std::size_t axis = 0; axis < 3; ++axis)
    up[axis] = gravity > 0.0 ? -scene.gravity[axis] / gravity : 0.0;
  for (std::size_t i = 0; i < scene.canopies.size(); ++i)
    has_speed.push_back(scene.lack_of_airspeed(i).empty());
}

void append_measures(const FlowScene& scene, const Airstream& stream, const Sheets& sheets,
                     const SheetState& state, const Vector& origin, const Vector& velocity,
                     framework::HistoryRow& row) {
  const auto append = [&row](const Vector& vector) {
    row.values.insert(row.values.end(), vector.begin(), vector.end());
  };
  for (std::size_t i = 0; i < sheets.canopies.size(); ++i) {
    const Canopy& canopy = scene.canopies[i];
    CanopyMeasures one = measure(sheets.canopies[i], sheets.fabric, state,
                                 canopy.payload.release && row.time > *canopy.payload.release);
    Vector relative = stream.velocity;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      one.payload[axis] += origin[axis];
      one.velocity[axis] += velocity[axis];
      relative[axis] -= one.velocity[axis];
    }
    if (scene.has_fluid()) append(one.force);
    for (const Vector& vector : {one.line_force, one.payload, one.velocity}) append(vector);
    row.values.push_back(one.projected_area);
    if (scene.has_fluid()) row.values.push_back(one.leak);
    if (stream.has_speed[i])
      row.values.insert(row.values.end(), {std::hypot(relative[0], relative[1], relative[2]),
                                           drag_coefficient(one.force, relative, scene.parameters.density,
                                                            canopy.nominal_area())});
    if (stream.has_speed[i] && scene.descends(i))
      row.values.push_back(relative[0] * stream.up[0] + relative[1] * stream.up[1] +
                           relative[2] * stream.up[2]);
    row.values.insert(row.values.end(), {one.largest_strain, one.inversion});
    if (canopy.has_lines()) row.values.push_back(one.lean);
    const CanopyRows& rows = sheets.canopies[i];
    if (canopy.lines.drag) append(sum(std::span(state.drag).subspan(rows.line_drag, rows.suspension.size())));
    if (canopy.payload.drag) append(state.drag[sheets.line_drag.size() + rows.payload_drag]);
  }
}

double count_intersections(const FlowScene& scene, const Sheets& sheets, std::span<const Vector> positions,
                           double time) {
  const auto lines = whole_lines(sheets, time);
  const auto& triangles = sheets.fabric.mesh.triangles;
  double count = static_cast<double>(reference::intersections(positions, triangles, lines).size());
  if (scene.has_fluid())
    count +=
        static_cast<double>(image_intersections(positions, {triangles, lines}, periods_of(scene.parameters),
                                                parts_of(scene.bodies, sheets))
                                .size());
  return count;
}

run::DatasetSpec canopy_field_spec(const Sheets& sheets, const std::string& name) {
  const CanopyRows& first = sheets.canopies.front();
  if (name == "position")
    return {.name = name,
            .shape = {sheets.positions.size() - first.begin, 3},
            .units = "m",
            .centering = "vertex",
            .description = "positions of the vertices",
            .grid = "canopy"};
  return {.name = name,
          .shape = {sheets.fabric.mesh.triangles.size() - first.triangles_begin},
          .units = "N/m",
          .centering = "face",
          .description = "von Mises stress of the triangles, Cauchy stress times thickness",
          .grid = "canopy"};
}

void write_canopy_mesh(const Sheets& sheets, run::FieldSink& fields) {
  const fabric::Mesh& mesh = sheets.fabric.mesh;
  write_part(mesh, sheets.canopies.front().begin, mesh.rest.size(),
             "vertices of every reinforcement and line", "canopy", fields);
}

void copy_canopy_positions(const Sheets& sheets, std::span<const Vector> positions,
                           std::span<double> values) {
  copy_positions(sheets.canopies.front().begin, positions, values);
}

void copy_canopy_stress(const Sheets& sheets, std::span<const fabric::Stress> stress,
                        std::span<double> values) {
  const std::size_t first = sheets.canopies.front().triangles_begin;
  for (std::size_t k = 0; k < values.size(); ++k) values[k] = stress[first + k].von_mises();
}

std::vector<SheetGrid> grids_beside_canopies(const FlowScene& scene, const Sheets& sheets) {
  std::vector<SheetGrid> grids;
  if (!scene.bodies.empty()) {
    const bool moves = std::ranges::any_of(
        scene.bodies, [](const Body& body) { return body.moves() || body.mount.has_value(); });
    grids.push_back({"body", 0, vertices_of(scene.bodies), moves});
  }
  if (!sheets.flags.empty())
    grids.push_back({"flag", sheets.flags.front().begin, sheets.flags.back().end, true});
  return grids;
}

run::DatasetSpec position_spec(const SheetGrid& grid) {
  return {.name = "position",
          .shape = {grid.end - grid.begin, 3},
          .units = "m",
          .centering = "vertex",
          .description = "positions of the vertices",
          .grid = grid.name};
}

void write_sheet_mesh(const Sheets& sheets, const SheetGrid& grid, run::FieldSink& fields) {
  write_part(sheets.fabric.mesh, grid.begin, grid.end, "vertices of every line", grid.name, fields);
}

void copy_positions(std::size_t begin, std::span<const Vector> positions, std::span<double> values) {
  for (std::size_t k = 0; k < values.size(); ++k) values[k] = positions[begin + k / 3][k % 3];
}

const char* cloth_failure_text(fabric::FailureReason reason) {
  switch (reason) {
    case fabric::FailureReason::crossing:
      return "contact could not prevent an intersection of the cloth";
    case fabric::FailureReason::too_fast:
      return "the cloth moves farther than the search distance of contact";
    case fabric::FailureReason::too_dense:
      return "more cloth lies within reach than the lists of contact hold, which a smaller "
             "coupling.thickness "
             "may prevent,";
    case fabric::FailureReason::too_many_constraints:
      return "more parts of the cloth are in contact than its lists hold, which a smaller coupling.thickness "
             "may prevent,";
    default:
      return "the positions of the cloth are not finite";
  }
}

std::string canopy_vertex_text(const Sheets& sheets, std::size_t vertex) {
  std::ostringstream text;
  for (std::size_t i = 0; i < sheets.canopies.size(); ++i) {
    const CanopyRows& rows = sheets.canopies[i];
    if (vertex < rows.begin || vertex >= rows.end) continue;
    if (vertex < rows.cloth_end) text << "vertex " << vertex - rows.begin << " of ";
    text << "the " << rows.part_of(vertex) << " of canopy[" << i << "]";
  }
  return text.str();
}

std::string step_limit_text(const FlowScene& scene, double time) {
  std::ostringstream text;
  text.precision(9);
  text << "run.max_steps = " << scene.parameters.max_steps << " reached at t = " << time
       << " s, before run.end_time = " << scene.end_time << " s";
  return text.str();
}

}  // namespace drogue::parachute_app
