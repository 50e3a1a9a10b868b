#pragma once

#include <vector>

#include "kernels/reference/fabric/membrane.hpp"

namespace drogue::reference {

/// Areas (m^2) and unit normals of the vertices of a surface of triangles.
struct SurfaceGeometry {
  std::vector<double> area;
  std::vector<Vector> normal;
};

/// Geometry at positions x, m: areas by Heron's formula, a third of each triangle scattered to its corners,
/// and normals of vertices as means weighted by area. Zero where there is no area.
[[nodiscard]] SurfaceGeometry surface_geometry(const Mesh& mesh, const std::vector<Vector>& x);

}  // namespace drogue::reference
