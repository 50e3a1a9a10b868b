#pragma once

#include <random>
#include <vector>

#include "kernels/fabric/material.hpp"

namespace drogue::testing {

using fabric::Vector;

/// Patch of nx by ny randomly displaced vertices with random diagonals, so that inner vertices have four to
/// eight triangles; plus a string of three pieces at its first vertex, and a line that reinforces an edge.
inline fabric::Mesh random_patch(int nx, int ny, unsigned seed) {
  std::mt19937 engine(seed);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * std::generate_canonical<double, 53>(engine);
  };
  fabric::Mesh mesh;
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) mesh.rest.push_back({i + uniform(-0.2, 0.2), j + uniform(-0.2, 0.2), 0.0});
  for (int j = 0; j + 1 < ny; ++j)
    for (int i = 0; i + 1 < nx; ++i) {
      const int a = j * nx + i, b = a + 1, c = a + nx, d = c + 1;
      if (uniform(0, 1) < 0.5) {
        mesh.triangles.push_back({a, b, d});
        mesh.triangles.push_back({a, d, c});
      } else {
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({b, d, c});
      }
    }
  const int last = nx * ny - 1;
  int above = 0;
  for (int k = 1; k <= 3; ++k) {
    mesh.rest.push_back({mesh.rest[0][0], mesh.rest[0][1], -0.5 * k});
    mesh.lines.push_back({above, last + k});
    above = last + k;
  }
  mesh.lines.push_back({last - nx, last});
  return mesh;
}

/// Displaces every vertex by up to `size`, m, along each axis.
inline std::vector<Vector> shaken(const std::vector<Vector>& points, double size, unsigned seed) {
  std::mt19937 engine(seed);
  std::vector<Vector> moved = points;
  for (Vector& x : moved)
    for (double& value : x) value += size * (2.0 * std::generate_canonical<double, 53>(engine) - 1.0);
  return moved;
}

}  // namespace drogue::testing
