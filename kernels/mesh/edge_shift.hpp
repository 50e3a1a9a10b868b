#pragma once

#include <array>
#include <vector>

#include "kernels/mesh/edges.hpp"
#include "kernels/mesh/mesh.hpp"

namespace drogue::mesh {

/// Point of the surface that takes the place of a vertex.
struct SurfacePoint {
  int vertex;                    ///< that it replaces
  std::array<int, 3> corner;     ///< of the triangle in which it lies
  std::array<double, 3> weight;  ///< barycentric coordinates
};

/// Edges that belong to a single triangle, in ascending order. Throws only std::bad_alloc.
[[nodiscard]] std::vector<Edge> open_edges(const Mesh& mesh);

/// Points of the surface at rest that lie farther from some of its open edges than the vertices do: a vertex
/// at the distance d moves by shift (1 - d / band) away from the nearest of `edges`, into the surface, as
/// far as that reaches. Vertices beyond `band` > shift, m, do not move and are left out; the others come in
/// ascending order. Distances are straight, from edges that vertices within `band` connect to. Does not
/// throw but std::bad_alloc.
[[nodiscard]] std::vector<SurfacePoint> shifted_from_edges(const Mesh& mesh, const std::vector<Edge>& edges,
                                                           double shift, double band);

}  // namespace drogue::mesh
