#include "kernels/fabric/elastic/triangle_list.hpp"

#include <cmath>
#include <map>

#include "kernels/mesh/edge_vector.hpp"
#include "kernels/mesh/edges.hpp"

namespace drogue::fabric {

TriangleList triangle_list(const Mesh& mesh, const Material& material) {
  TriangleList list;
  std::map<mesh::Edge, int> sharing;
  std::vector<std::vector<int>> around(mesh.rest.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      if (material.model == Model::edge) ++sharing[mesh::opposite_edge(mesh.triangles[t], k)];
      around[static_cast<std::size_t>(mesh.triangles[t][k])].push_back(static_cast<int>(t));
    }
  for (const auto& t : mesh.triangles) {
    spatial::Vector3<double> edge[3];
    for (std::size_t k = 0; k < 3; ++k) {
      edge[k] = edge_vector(mesh, t[(k + 1) % 3], t[(k + 2) % 3]);
      list.vertex[k].push_back(t[k]);
      list.rest[k].push_back(dot(edge[k], edge[k]));
      if (material.model == Model::edge)
        list.stiffness[k].push_back(material.stiffness / sharing[mesh::opposite_edge(t, k)]);
    }
    const spatial::Vector3<double> normal = cross(edge[0], edge[1]);
    list.inverse_area.push_back(2.0 / std::sqrt(dot(normal, normal)));
  }
  list.first.push_back(0);
  for (const auto& triangles : around) {
    list.around.insert(list.around.end(), triangles.begin(), triangles.end());
    list.first.push_back(static_cast<int>(list.around.size()));
  }
  return list;
}

}  // namespace drogue::fabric
