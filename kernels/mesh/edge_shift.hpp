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

/// Edge of a single triangle.
struct OpenEdge {
  Edge ends;
  Vector inward;  ///< unit vector in the triangle at rest, normal to the edge, into the triangle
};

/// All edges of single triangles at rest, in ascending order of their ends. Lengths in any unit. Throws only
/// std::bad_alloc.
[[nodiscard]] std::vector<OpenEdge> open_edges(const Mesh& mesh);

/// Points of the surface at rest that lie farther from some of its open edges than the vertices do. A vertex
/// at the distance d from the nearest of `edges` moves by shift (1 - d / band) away from it, and likewise
/// away from the nearest one of those that lie in another direction, by more than 60 degrees: from both edges
/// of a corner, and by the difference from the two of a narrow strip, so that points keep their order for
/// shifts up to half of `band`. They stay in the surface. Vertices at `band` or farther do not move and are
/// left out; the others come in ascending order. Distances are straight, to edges to which vertices within
/// `band` connect; lengths have the unit of the mesh. Throws only std::bad_alloc.
[[nodiscard]] std::vector<SurfacePoint> shifted_from_edges(const Mesh& mesh,
                                                           const std::vector<OpenEdge>& edges, double shift,
                                                           double band);

}  // namespace drogue::mesh
