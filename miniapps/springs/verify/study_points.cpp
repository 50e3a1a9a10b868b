#include "miniapps/springs/verify/study_points.hpp"

#include <algorithm>
#include <numbers>

#include "common/program/failure.hpp"
#include "common/scene/codec.hpp"
#include "common/study/axes.hpp"

namespace drogue::springs_app {
namespace {

study::Axes parse(const std::string& lists) {
  return study::parse_axes(lists, {"vertices", 2, 24},
                           {{"models", {"edge", "quadratic", "biquadratic"}},
                            {"masses", {"area", "equal"}},
                            {"integrators", {"rk4", "verlet"}}});
}

/// Settings of a point of the study. Empty texts and 0 vertices keep the value of the scene.
struct PointSettings {
  std::string model, mass, integrator;
  std::int64_t vertices = 0;
};

std::vector<PointSettings> product(const study::Axes& axes) {
  std::vector<std::int64_t> meshes = axes.meshes.empty() ? std::vector<std::int64_t>{0} : axes.meshes;
  std::ranges::sort(meshes);
  std::vector<PointSettings> all;
  for (const std::string& model : axes.of("models"))
    for (const std::string& mass : axes.of("masses"))
      for (const std::string& integrator : axes.of("integrators"))
        for (const std::int64_t vertices : meshes) all.push_back({model, mass, integrator, vertices});
  return all;
}

std::string generator_name(const MeshSource& source) {
  if (source.rectangle) return "rectangle";
  if (source.disk) return "disk";
  if (source.strip) return "strip";
  return source.triangle ? "triangle" : "string";
}

void check_axes_fit_mesh(const study::Axes& axes, const SpringsScene& base) {
  if (!axes.meshes.empty() && !base.source.file.empty())
    throw Failure(ExitCode::usage, "--study: meshes needs a generator, and the mesh of " + base.name +
                                       " is " + base.source.file + ", which has a fixed number of vertices");
  if (axes.words.contains("models") && !base.has_triangles())
    throw Failure(ExitCode::usage,
                  "--study: models needs triangles, and the mesh of " + base.name + " has none");
}

/// Table [material] for springs along edges in place of triangles, or vice versa.
std::string material_table(const SpringsScene& base, const std::string& model) {
  const Fabric& f = base.fabric;
  const auto pair = [](const char* key, double value) {
    return std::string(", ") + key + " = " + scene::toml_text(value);
  };
  const double of_equilateral = 0.5 * std::numbers::sqrt3;
  std::string text = "material={ model = \"" + model + '"';
  if (model == "edge")
    text += pair("stiffness", of_equilateral * f.material.membrane_modulus);
  else
    text += pair("membrane_modulus", f.material.stiffness / of_equilateral) + pair("poisson", 1.0 / 3.0);
  text += pair("area_density", f.area_density) + pair("bending_stiffness", f.material.bending_stiffness);
  if (base.has_lines()) text += pair("line_density", f.line_density);
  text += std::string(", tension_only = ") + (f.material.tension_only ? "true" : "false");
  return text + ", mass = \"" + (f.mass == fabric::Lumping::area ? "area" : "equal") + "\" }";
}

std::vector<std::string> assignments(const SpringsScene& base, const PointSettings& settings) {
  std::vector<std::string> sets;
  const Fabric& f = base.fabric;
  if (!settings.model.empty()) {
    const bool whole = settings.model != "edge";
    sets.push_back(whole == fabric::has_triangles(f.material.model)
                       ? "material.model=\"" + settings.model + '"'
                       : material_table(base, settings.model));
  }
  if (!settings.mass.empty()) sets.push_back("material.mass=\"" + settings.mass + '"');
  if (!settings.integrator.empty()) sets.push_back("time.integrator=\"" + settings.integrator + '"');
  if (settings.vertices == 0) return sets;
  sets.push_back("mesh." + generator_name(base.source) + ".vertices=" + std::to_string(settings.vertices));
  if (base.source.string && f.stiffness) {
    const double edges = static_cast<double>(base.mesh.lines.size());
    sets.push_back("material.stiffness=" +
                   scene::toml_text(*f.stiffness * static_cast<double>(settings.vertices - 1) / edges));
  }
  return sets;
}

/// Keeps E A of strings beside cloth, which the keys of another model cannot express.
void keep_strings(const SpringsScene& base, SpringsScene& scene) {
  if (!base.has_triangles() || !base.has_lines()) return;
  scene.mesh.line_stiffness = base.mesh.line_stiffness;
  scene.fabric.material.axial_stiffness = base.fabric.material.axial_stiffness;
}

StudyPoint named(SpringsScene scene) {
  StudyPoint point;
  point.model = scene.has_triangles() ? model_name(scene.fabric.material.model) : "string";
  point.mass = scene.fabric.mass == fabric::Lumping::area ? "area" : "equal";
  point.integrator = scene.time.integrator == fabric::Integrator::rk4 ? "rk4" : "verlet";
  point.label = point.model;
  if (point.mass != "area") point.label += ' ' + point.mass;
  if (point.integrator != "rk4") point.label += ' ' + point.integrator;
  point.scene = std::move(scene);
  return point;
}

}  // namespace

std::int64_t largest_study_mesh(const std::string& lists) {
  const std::vector<std::int64_t> meshes = parse(lists).meshes;
  return meshes.empty() ? 0 : *std::ranges::max_element(meshes);
}

std::vector<StudyPoint> study_points(const std::filesystem::path& file, const std::vector<std::string>& sets,
                                     const std::string& lists, std::int64_t most_vertices) {
  study::Axes axes = parse(lists);
  for (std::int64_t& vertices : axes.meshes) vertices = std::min(vertices, most_vertices);
  const SpringsScene base = read_springs_scene(file, sets);
  check_axes_fit_mesh(axes, base);
  std::vector<StudyPoint> points;
  for (const PointSettings& settings : product(axes)) {
    std::vector<std::string> all = sets;
    std::ranges::move(assignments(base, settings), std::back_inserter(all));
    SpringsScene scene = read_springs_scene(file, all);
    keep_strings(base, scene);
    StudyPoint point = named(std::move(scene));
    // A generator may round two sizes to the same mesh.
    const bool again = !points.empty() && points.back().label == point.label &&
                       points.back().scene.mesh.rest.size() == point.scene.mesh.rest.size();
    if (!again) points.push_back(std::move(point));
  }
  return points;
}

}  // namespace drogue::springs_app
