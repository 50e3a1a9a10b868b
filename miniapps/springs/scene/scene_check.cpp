#include "miniapps/springs/scene/scene_check.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/fabric/solver.hpp"
#include "kernels/mesh/edges.hpp"
#include "kernels/mesh/orientation.hpp"
#include "kernels/mesh/topology.hpp"
#include "kernels/stepping/expression_steps.hpp"
#include "miniapps/framework/obj_file.hpp"
#include "miniapps/springs/scene/expressions.hpp"
#include "miniapps/springs/simulation/stress_fields.hpp"

namespace drogue::springs_app {
namespace {

using scene::element, scene::Place, scene::rough_text, scene::sentence;

constexpr std::array<const char*, 3> axis_names = {"x", "y", "z"};
/// Most steps by which loads and prescribed motion may be resolved.
constexpr double most_steps_of_changes = 1e9;

fabric::Mesh make_mesh(const Place& root, SpringsScene& scene) {
  MeshSource& source = scene.source;
  if (source.rectangle) return generate(*source.rectangle);
  if (source.disk) return generate(*source.disk);
  if (source.strip) return generate(*source.strip);
  if (source.triangle) return generate(*source.triangle);
  if (source.string) {
    root.refuse_if(source.string->from == source.string->to, "mesh.string",
                   ": from and to are the same point");
    return generate(*source.string);
  }
  return framework::read_obj(root.at("mesh"), source.scale, scene.file, source.file, scene.notices);
}

/// Checks the value of an expression at a vertex: finite, and below the limit of a lost state.
void require_finite_value(const Place& root, const SpringsScene& scene, const std::string& path, double value,
                          std::size_t vertex, const std::string& when = "") {
  if (!(std::abs(value) < 1e99))
    root.refuse(path, " gives ", value, " ", place_text(scene, vertex), when,
                std::isfinite(value) ? "; it must be less than 1e99" : "; it must be finite");
}

/// Checks an expression at every vertex and time 0: finite, and below the limit of a lost state. An
/// expression that a kernel evaluates must also fit its device program.
void require_finite(const Place& root, const SpringsScene& scene, const std::string& path,
                    const std::string& expression, bool for_device = false) {
  if (for_device) check_program(root, path, expression);
  const std::vector<double> values = values_at(expression, scene.mesh);
  for (std::size_t i = 0; i < values.size(); ++i) require_finite_value(root, scene, path, values[i], i);
}

void require_finite(const Place& root, const SpringsScene& scene, const std::string& path,
                    const ExpressionVector& vector) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    require_finite(root, scene, path + "." + axis_names[axis], vector.of(axis),
                   depends_on_time(vector.of(axis)));
}

/// Checks an expression that moves or loads `vertices` as above, at some of them during the run, and bounds
/// the automatic step, so that it resolves what changes.
void check_in_time(const Place& root, SpringsScene& scene, const std::string& path,
                   const std::string& expression, const std::vector<int>& vertices) {
  const double end = scene.time.end_time;
  if (!depends_on_time(expression) || vertices.empty() || end == 0.0) return;
  constexpr std::size_t most = 64;
  fabric::Mesh some;
  std::vector<std::size_t> vertex;
  for (std::size_t k = 0; k < vertices.size(); k += 1 + vertices.size() / most) {
    vertex.push_back(static_cast<std::size_t>(vertices[k]));
    some.rest.push_back(scene.mesh.rest[vertex.back()]);
  }
  for (const double time : sample_times(expression, end)) {
    const std::vector<double> values = values_at(expression, some, time);
    for (std::size_t k = 0; k < values.size(); ++k)
      require_finite_value(root, scene, path, values[k], vertex[k], sentence(" at t = ", time, " s"));
  }
  const auto changes = stepping::expression_intervals(device_program(expression), some.rest, end);
  scene.changes.push_back(changes);
  const double shortest = stepping::shortest_interval(changes, 0.0, end);
  const std::string needs =
      sentence(": steps that resolve it are at most ", rough_text(shortest), " s long, ");
  root.refuse_if(!scene.time.dt && end / shortest > most_steps_of_changes, path, needs,
                 rough_text(end / shortest), " to time.end_time; time.dt takes longer ones");
  if (scene.time.dt && *scene.time.dt > shortest)
    scene.notices.push_back(sentence(path, needs, "time.dt = ", rough_text(*scene.time.dt), " s"));
}

void check_in_time(const Place& root, SpringsScene& scene, const std::string& path,
                   const ExpressionVector& vector, const std::vector<int>& vertices) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    check_in_time(root, scene, path + "." + axis_names[axis], vector.of(axis), vertices);
}

void complete_material(const Place& root, SpringsScene& scene) {
  Fabric& f = scene.fabric;
  const Place material = root.at("material");
  const bool cloth = scene.has_triangles(), lines = scene.has_lines();
  const bool springs = cloth && !fabric::has_triangles(f.material.model);
  material.refuse_if(
      cloth && f.material.model == fabric::Model::linear_vector && scene.time.end_time > 0.0, "model",
      " = \"linear-vector\" (Model I) stores energy in a rigid rotation and is refused in a scene that "
      "moves; take \"edge\", \"quadratic\" or \"biquadratic\"");
  // The content of a mesh file is known only now.
  const auto needless = [&](const std::string& key, bool applies, const char* needs) {
    material.refuse_if(material.given(key) && !applies, key, " applies only with ", needs,
                       ", and the mesh has none");
  };
  for (const char* key : {"membrane_modulus", "poisson", "area_density", "bending_stiffness"})
    needless(key, cloth, "triangles");
  for (const char* key : {"line_density", "axial_stiffness"}) needless(key, lines, "lines");
  needless("stiffness", lines || springs, "lines or model edge");
  material.refuse_if(f.stiffness && f.axial_stiffness && !springs, "axial_stiffness",
                     " and material.stiffness are both of strings, and the mesh has no triangles: give one");
  material.refuse_if(f.material.bending_stiffness > 0.0 && !is_planar(scene.mesh), "bending_stiffness",
                     " needs cloth that is flat at rest, and this mesh is not");
  if (springs && !f.stiffness) f.stiffness = f.material.stiffness;
  if (f.stiffness) f.material.stiffness = *f.stiffness;
  if (lines && !f.stiffness && !f.axial_stiffness) f.axial_stiffness = 5000.0;
  f.material.axial_stiffness = f.axial_stiffness.value_or(0.0);
  if (!lines || f.axial_stiffness) return;
  scene.mesh.line_stiffness.clear();
  for (const auto& [i, j] : scene.mesh.lines)
    scene.mesh.line_stiffness.push_back(*f.stiffness * mesh::rest_distance(scene.mesh, i, j));
  f.material.axial_stiffness = scene.mesh.line_stiffness.front();
}

void check_pins(const Place& root, SpringsScene& scene) {
  // Number of the pin that prescribes an axis of a vertex, from 1; 0: none.
  std::vector<std::array<std::size_t, 3>> holder(scene.mesh.rest.size(), {0, 0, 0});
  for (std::size_t k = 0; k < scene.pins.size(); ++k) {
    const Pin& pin = scene.pins[k];
    const std::string path = element("pin", k);
    require_finite(root, scene, path + ".motion", pin.motion);
    const auto vertices = require_some(root, scene, path + ".where", pin.where, "the pin holds nothing");
    check_in_time(root, scene, path + ".motion", pin.motion, vertices);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const bool fixed = pin.axes.find(axis_names[axis]) != std::string::npos;
      root.refuse_if(!fixed && !pin.motion.of(axis).empty(), path + ".motion." + axis_names[axis],
                     " moves an axis that ", path, ".axes = \"", pin.axes, "\" leaves free");
      if (!fixed) continue;
      for (const int i : vertices) {
        std::size_t& other = holder[static_cast<std::size_t>(i)][axis];
        if (other > 0 && scene.pins[other - 1].motion.of(axis) != pin.motion.of(axis))
          root.contradict(path + ".where", path, " and ", element("pin", other - 1), " hold the ",
                          axis_names[axis], " axis in different ways ",
                          place_text(scene, static_cast<std::size_t>(i)));
        other = k + 1;
      }
    }
  }
}

/// Checks that a pressure acts on one side of the cloth: along the normals of all faces.
void check_sides(const Place& root, SpringsScene& scene, const std::string& path) {
  const mesh::Orientation sides = orientation_of(scene.mesh);
  const auto faces = [](const std::array<int, 2>& pair) {
    return sentence("faces ", pair[0], " and ", pair[1], " of the mesh turn in opposite senses");
  };
  if (sides.one_sided)
    root.refuse(path, " has no side to act on: ", faces(*sides.one_sided),
                ", however others are turned: the cloth has one side, as a Moebius strip");
  if (const auto opposed = inconsistent_triangles(scene.mesh))
    root.refuse(path, " has no side to act on: ", faces(*opposed));
  const mesh::SurfacePart* outwards = nullptr;
  const mesh::SurfacePart* inwards = nullptr;
  for (const mesh::SurfacePart& part : sides.parts) {
    if (part.volume > 0.0) outwards = &part;
    if (part.volume < 0.0) inwards = &part;
  }
  if (inwards == nullptr) return;
  if (outwards != nullptr)
    root.refuse(path,
                " acts on opposite sides of closed parts of the cloth: the normals of the one with face ",
                inwards->first, " of the mesh point inwards, those of the one with face ", outwards->first,
                " outwards");
  scene.notices.push_back(
      sentence(path, " acts inwards where it is positive: the normals of the closed cloth with face ",
               inwards->first, " of the mesh point inwards"));
}

void check_loads(const Place& root, SpringsScene& scene) {
  for (std::size_t k = 0; k < scene.loads.size(); ++k) {
    const Load& load = scene.loads[k];
    const std::string path = element("load", k);
    for (const auto& [name, text] :
         {std::pair{".pressure", load.pressure}, std::pair{".follower_pressure", load.follower_pressure}}) {
      if (text.empty()) continue;
      root.refuse_if(!scene.has_triangles(), path + name, " needs triangles, and the mesh has none");
      check_sides(root, scene, path + name);
      require_finite(root, scene, path + name, text,
                     name != std::string(".pressure") || depends_on_time(text));
      check_in_time(root, scene, path + name, text, selected("", scene.mesh));
    }
    if (!load.force) continue;
    require_finite(root, scene, path + ".force", *load.force);
    root.refuse_if(!load.force->given(), path + ".force", " needs one of x, y, z");
    const std::vector<int> loaded =
        load.where.empty()
            ? selected("", scene.mesh)
            : require_some(root, scene, path + ".where", load.where, "the force acts on nothing");
    check_in_time(root, scene, path + ".force", *load.force, loaded);
  }
  for (std::size_t k = 0; k < scene.payloads.size(); ++k)
    require_some(root, scene, element("mass", k) + ".where", scene.payloads[k].where,
                 "the mass is added to nothing");
}

void complete_output(const Place& root, SpringsScene& scene) {
  Output& output = scene.output;
  framework::complete_output(root, output, {"position"}, {scene.time.end_time, "time.end_time"});
  for (const std::string& field : output.fields) {
    if (!stress_kind(field)) continue;
    root.refuse_if(!scene.has_triangles(), "output.fields", ": ", field,
                   " is a stress of triangles, and the mesh has none");
    root.refuse_if(scene.fabric.material.model == fabric::Model::linear_vector, "output.fields",
                   ": model \"linear-vector\" has no ", field, ", its forces are not along edges");
  }
}

}  // namespace

std::string place_text(const SpringsScene& scene, std::size_t vertex) {
  const fabric::Vector& x = scene.mesh.rest[vertex];
  return sentence("at vertex ", vertex, " (", x[0], ", ", x[1], ", ", x[2], ")");
}

void check_program(const Place& root, const std::string& path, const std::string& expression) {
  try {
    if (!expression.empty()) device_program(expression);
  } catch (const std::invalid_argument& refused) {
    root.refuse(path, ": ", refused.what());
  }
}

std::vector<int> require_some(const Place& root, const SpringsScene& scene, const std::string& path,
                              const std::string& where, const std::string& what) {
  require_finite(root, scene, path, where);
  std::vector<int> vertices = selected(where, scene.mesh);
  root.refuse_if(vertices.empty(), path, " = ", scene::short_toml_string(where),
                 " holds at no vertex: ", what);
  return vertices;
}

void complete_and_check(const Place& root, SpringsScene& scene) {
  const Time& time = scene.time;
  scene.mesh = make_mesh(root, scene);
  for (const auto& triangle : scene.mesh.triangles)
    if (!fabric::has_area(scene.mesh, triangle))
      root.refuse("mesh", ": the triangle ", place_text(scene, static_cast<std::size_t>(triangle[0])),
                  " has no area: it is too thin, or not between 1e-70 and 1e70 m long");
  scene.lines = scene.mesh.lines.size();
  complete_material(root, scene);
  add_reinforcements(root, scene);
  if (time.dt && time.end_time / *time.dt > most_steps)
    root.refuse("time.dt", " = ", *time.dt, " takes more than 1e15 steps to time.end_time = ", time.end_time);
  require_finite(root, scene, "initial.displacement", scene.initial.displacement);
  require_finite(root, scene, "initial.velocity", scene.initial.velocity);
  check_pins(root, scene);
  check_loads(root, scene);
  check_contact(root, scene);
  complete_output(root, scene);
  check_verify(root, scene);
}

}  // namespace drogue::springs_app
