#include "kernels/fabric/elastic/triangle_list.hpp"

#include <cmath>
#include <map>
#include <utility>

#include "kernels/mesh/edge_vector.hpp"
#include "kernels/mesh/edges.hpp"
#include "kernels/mesh/incidence.hpp"

namespace drogue::fabric {

TriangleList triangle_list(const Mesh& mesh, const Material& material) {
  TriangleList list;
  std::map<mesh::Edge, int> sharing;
  if (material.model == Model::edge)
    for (const auto& t : mesh.triangles)
      for (std::size_t k = 0; k < 3; ++k) ++sharing[mesh::opposite_edge(t, k)];
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
  mesh::VertexTriangles incidence = mesh::vertex_triangles(mesh);
  list.first = std::move(incidence.first);
  list.around = std::move(incidence.triangle);
  return list;
}

}  // namespace drogue::fabric
