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

/// Values at the vertices of a surface at positions x, smoothed so many times along it: by the means of the
/// corners of each triangle, then of the triangles around each vertex, weighted by their areas. Zero where
/// there is no area.
[[nodiscard]] std::vector<double> smoothed_along(const Mesh& mesh, const std::vector<Vector>& x,
                                                 std::vector<double> values, int times);

}  // namespace drogue::reference
