#include "kernels/fabric/triangle_list.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace drogue::fabric {

namespace {

/// Both ends of the edge opposite vertex k, the lower number first.
std::array<int, 2> opposite_edge(const std::array<int, 3>& t, std::size_t k) {
  const int a = t[(k + 1) % 3], b = t[(k + 2) % 3];
  return {std::min(a, b), std::max(a, b)};
}

double squared_length(const Vector& v) { return v[0] * v[0] + v[1] * v[1] + v[2] * v[2]; }

}  // namespace

TriangleList triangle_list(const Mesh& mesh, const Material& material) {
  TriangleList list;
  std::map<std::array<int, 2>, int> sharing;
  std::vector<std::vector<int>> around(mesh.rest.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      if (material.model == Model::edge) ++sharing[opposite_edge(mesh.triangles[t], k)];
      around[static_cast<std::size_t>(mesh.triangles[t][k])].push_back(static_cast<int>(t));
    }
  for (const auto& t : mesh.triangles) {
    Vector edge[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const auto from = static_cast<std::size_t>(t[(k + 1) % 3]),
                 to = static_cast<std::size_t>(t[(k + 2) % 3]);
      for (std::size_t axis = 0; axis < 3; ++axis)
        edge[k][axis] = mesh.rest[to][axis] - mesh.rest[from][axis];
      list.vertex[k].push_back(t[k]);
      list.rest[k].push_back(squared_length(edge[k]));
      if (material.model == Model::edge)
        list.stiffness[k].push_back(material.stiffness / sharing[opposite_edge(t, k)]);
    }
    const Vector &u = edge[0], &v = edge[1];
    list.inverse_area.push_back(
        2.0 / std::sqrt(squared_length(
                  {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]})));
  }
  list.first.push_back(0);
  for (const auto& triangles : around) {
    list.around.insert(list.around.end(), triangles.begin(), triangles.end());
    list.first.push_back(static_cast<int>(list.around.size()));
  }
  return list;
}

}  // namespace drogue::fabric
