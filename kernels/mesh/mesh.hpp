#pragma once

#include <array>
#include <vector>

namespace drogue::mesh {

/// Cartesian coordinates, m, or another vector of three components.
using Vector = std::array<double, 3>;

/// Triangles and line segments over shared vertices. Indices count from 0.
struct Mesh {
  std::vector<Vector> rest;  ///< vertex positions at rest, m
  std::vector<std::array<int, 3>> triangles;
  std::vector<std::array<int, 2>> lines;  ///< segments of strings, or of reinforcements along edges
  std::vector<double> line_stiffness;     ///< axial stiffness E A per line, N; empty: one value for all lines
  std::vector<double> line_density;  ///< mass per length of each line, kg/m; empty: one value for all lines
  /// Length of each line without tension, m; empty, or 0 for a line: the distance of its ends in `rest`.
  std::vector<double> line_length;
};

}  // namespace drogue::mesh
