#include "kernels/mesh/incidence.hpp"

#include <cstddef>

namespace drogue::mesh {

VertexTriangles vertex_triangles(const Mesh& mesh) {
  VertexTriangles result;
  result.first.assign(mesh.rest.size() + 1, 0);
  for (const auto& corners : mesh.triangles)
    for (const int i : corners) ++result.first[static_cast<std::size_t>(i) + 1];
  for (std::size_t i = 0; i < mesh.rest.size(); ++i) result.first[i + 1] += result.first[i];
  result.triangle.resize(static_cast<std::size_t>(result.first.back()));
  std::vector<int> next(result.first.begin(), result.first.end() - 1);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const int i : mesh.triangles[t])
      result.triangle[static_cast<std::size_t>(next[static_cast<std::size_t>(i)]++)] = static_cast<int>(t);
  return result;
}

}  // namespace drogue::mesh
