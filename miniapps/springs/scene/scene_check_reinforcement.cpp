#include <algorithm>
#include <map>

#include "kernels/mesh/edges.hpp"
#include "miniapps/springs/scene/scene_check.hpp"

namespace drogue::springs_app {

using mesh::Edge;

void add_reinforcements(const scene::Place& root, SpringsScene& scene) {
  if (scene.reinforcements.empty()) return;
  fabric::Mesh& mesh = scene.mesh;
  const Fabric& f = scene.fabric;
  if (mesh.line_stiffness.empty()) mesh.line_stiffness.assign(mesh.lines.size(), f.material.axial_stiffness);
  mesh.line_density.assign(mesh.lines.size(), f.line_density);
  std::map<Edge, std::size_t> line_of;
  for (std::size_t k = 0; k < mesh.lines.size(); ++k) {
    const auto& [i, j] = mesh.lines[k];
    line_of[mesh::edge_between(i, j)] = k;
  }
  const std::vector<Edge> edges = edges_of(mesh);
  std::vector<std::size_t> holder(edges.size(), 0);  // number of the reinforcement from 1; 0: none
  for (std::size_t r = 0; r < scene.reinforcements.size(); ++r) {
    const Reinforcement& reinforcement = scene.reinforcements[r];
    const scene::Place at = root.at("reinforcement", r);
    std::vector<char> chosen(mesh.rest.size(), 0);
    for (const int i : require_some(at, scene, "where", reinforcement.where, "nothing is reinforced"))
      chosen[static_cast<std::size_t>(i)] = 1;
    bool any = false;
    for (std::size_t e = 0; e < edges.size(); ++e) {
      const auto [i, j] = edges[e];
      if (chosen[static_cast<std::size_t>(i)] == 0 || chosen[static_cast<std::size_t>(j)] == 0) continue;
      if (holder[e] > 0)
        at.contradict("where", at.path(), " and ", scene::element("reinforcement", holder[e] - 1),
                      " both reinforce the edge ", place_text(scene, static_cast<std::size_t>(i)), " and ",
                      place_text(scene, static_cast<std::size_t>(j)));
      holder[e] = r + 1;
      any = true;
      const auto [found, is_new] = line_of.try_emplace(edges[e], mesh.lines.size());
      if (is_new) {
        mesh.lines.push_back(edges[e]);
        mesh.line_stiffness.push_back(0.0), mesh.line_density.push_back(0.0);
      }
      mesh.line_stiffness[found->second] = reinforcement.axial_stiffness;
      mesh.line_density[found->second] = reinforcement.line_density;
    }
    at.refuse_if(!any, "where", " = ", scene::toml_string(reinforcement.where),
                 " holds at both ends of no edge: nothing is reinforced");
  }
  const std::vector<double> mass = fabric::lumped_masses(mesh, f.area_density, f.line_density, f.mass);
  if (const auto none = std::ranges::find(mass, 0.0); none != mass.end())
    root.refuse("reinforcement", ": lines without line_density leave no mass ",
                place_text(scene, static_cast<std::size_t>(none - mass.begin())));
}

}  // namespace drogue::springs_app
