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

/// Points of the surface at rest that lie farther from some of its open edges than the vertices do: a vertex
/// at the distance d from the nearest of `edges` moves by s (1 - d / b) away from it, on the surface. b is
/// `band`, or the largest such distance in the part of the mesh that hangs together, if it is less; s is
/// `shift`, or b / 2 if that is less. So points keep their order, narrow parts move less, and only beside
/// corners, where the nearest edge changes, do points change sides. Vertices at b or farther do not move and
/// are left out; the others come in ascending order. Distances are straight, to edges to which vertices
/// within `band` connect; lengths have the unit of the mesh. Throws only std::bad_alloc.
[[nodiscard]] std::vector<SurfacePoint> shifted_from_edges(const Mesh& mesh,
                                                           const std::vector<OpenEdge>& edges, double shift,
                                                           double band);

}  // namespace drogue::mesh
