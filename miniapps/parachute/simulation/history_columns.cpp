#include "miniapps/parachute/simulation/history_columns.hpp"

#include <string>

#include "miniapps/parachute/bodies/inside_fluid.hpp"

namespace drogue::parachute_app {
namespace {

using Columns = std::vector<run::Column>;

std::string numbered(const char* name, std::size_t i) { return name + std::to_string(i) + "_"; }

void append_vector(Columns& columns, const std::string& name, const char* unit) {
  for (const char* axis : axis_names) columns.push_back({name + "_" + axis, unit});
}

void append_fluid(const FlowScene& scene, Columns& columns) {
  columns.insert(columns.end(), {{"kinetic_energy", "J"}, {"enstrophy", "m^3/s^2"}, {"dissipation", "W"}});
  append_vector(columns, "momentum", "kg m/s");
  columns.insert(columns.end(), {{"max_speed", "m/s"}, {"divergence_rms", "1/s"}, {"divergence_max", "1/s"}});
  for (std::size_t side = 0; side < 6; ++side)
    if (scene.parameters.boundary[side].kind != flow::BoundaryKind::periodic)
      columns.push_back({std::string("outflow_") + side_names[side], "m^3/s"});
}

void append_bodies(const FlowScene& scene, Columns& columns) {
  for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    append_vector(columns, numbered("body_", i) + "force", "N");
  for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    if (InsideFluid(scene.bodies[i], scene.parameters).moves())
      append_vector(columns, numbered("body_", i) + "outside_force", "N");
  for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    if (scene.bodies[i].mount) columns.push_back({numbered("body_", i) + "displacement", "m"});
}

void append_canopy(const FlowScene& scene, std::size_t i, Columns& columns) {
  const std::string name = numbered("canopy_", i);
  if (scene.has_fluid()) append_vector(columns, name + "force", "N");
  append_vector(columns, name + "line_force", "N");
  append_vector(columns, name + "payload", "m");
  append_vector(columns, name + "payload_velocity", "m/s");
  columns.push_back({name + "projected_area", "m^2"});
  if (scene.has_fluid()) columns.push_back({name + "leak", "m^3/s"});
  if (scene.lack_of_airspeed(i).empty()) {
    columns.insert(columns.end(), {{name + "airspeed", "m/s"}, {name + "drag_coefficient", ""}});
    if (scene.descends(i)) columns.push_back({name + "rate_of_descent", "m/s"});
  }
  columns.insert(columns.end(), {{name + "largest_strain", ""}, {name + "inversion", ""}});
  if (scene.canopies[i].has_lines()) columns.push_back({name + "lean", "degrees"});
  if (scene.canopies[i].lines.drag) append_vector(columns, name + "line_drag", "N");
  if (scene.canopies[i].payload.drag) append_vector(columns, name + "payload_drag", "N");
}

void append_canopies(const FlowScene& scene, Columns& columns) {
  for (std::size_t i = 0; i < scene.canopies.size(); ++i) append_canopy(scene, i, columns);
  columns.insert(columns.end(), {{"cloth_kinetic_energy", "J"}, {"cloth_elastic_energy", "J"}});
  if (scene.has_fluid())
    columns.push_back({"force_balance", ""});
  else
    columns.insert(columns.end(), {{"potential_energy", "J"}, {"energy", "J"}});
  if (scene.verify.intersections) columns.push_back({"intersections", ""});
  if (scene.frame != Frame::follow) return;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (scene.open_axes()[axis])
      columns.insert(columns.end(), {{std::string("frame_velocity_") + axis_names[axis], "m/s"},
                                     {std::string("frame_position_") + axis_names[axis], "m"}});
}

}  // namespace

std::vector<run::Column> history_columns(const FlowScene& scene) {
  Columns columns = {{"step", ""}, {"dt", "s"}};
  if (scene.has_fluid()) append_fluid(scene, columns);
  append_bodies(scene, columns);
  if (!scene.canopies.empty()) append_canopies(scene, columns);
  for (std::size_t i = 0; i < scene.flags.size(); ++i)
    for (const auto& [quantity, unit] : {std::pair{"force", "N"}, std::pair{"tip", "m"}})
      for (const char* axis : {"x", "y"})
        columns.push_back({numbered("flag_", i) + quantity + "_" + axis, unit});
  return columns;
}

}  // namespace drogue::parachute_app
