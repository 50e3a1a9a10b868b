#pragma once

#include "kernels/mesh/mesh.hpp"

namespace drogue::mesh {

// Each generator returns the mesh whose number of vertices is closest to the requested one. All triangles
// turn counter-clockwise seen from +z, their normal. Lengths are in m. The generators throw only
// std::bad_alloc.

/// Rectangle [0, width] x [0, height] (m) in the plane z = 0: nearly square cells with alternating diagonals.
struct Rectangle {
  double width = 1.0, height = 1.0;
  int vertices = 1000;
  double distortion = 0.0;  ///< largest displacement of interior vertices as a fraction of a cell, below 1/4
};

/// Disk about the origin in the plane z = 0: ring k of n has 6 k vertices, 1 + 3 n (n + 1) in all.
struct Disk {
  double radius = 1.0;  ///< m
  int vertices = 1000;
};

/// Strip [0, length] x [0, width] (m) in the plane z = 0: rows of nearly equilateral triangles, halved at the
/// ends.
struct Strip {
  double length = 1.0, width = 0.2;
  int vertices = 1000;
};

/// Equilateral triangle with the corners (0, 0), (side, 0) and an apex above them (m), in n^2 equal
/// triangles.
struct Triangle {
  double side = 1.0;
  int vertices = 1000;
};

/// Straight string between two points (m), in equal segments.
struct String {
  Vector from{0.0, 0.0, 0.0}, to{1.0, 0.0, 0.0};
  int vertices = 100;
};

/// Rectangle [0, width] x [0, height] (m) in the plane z = 0 of columns and rows of cells with alternating
/// diagonals; vertices row by row. Throws only std::bad_alloc.
[[nodiscard]] Mesh rectangle(double width, double height, int columns, int rows);

/// Mesh of a rectangle, m. Throws only std::bad_alloc.
[[nodiscard]] Mesh generate(const Rectangle& shape);
/// Mesh of a disk, m. Throws only std::bad_alloc.
[[nodiscard]] Mesh generate(const Disk& shape);
/// Mesh of a strip, m. Throws only std::bad_alloc.
[[nodiscard]] Mesh generate(const Strip& shape);
/// Mesh of a triangle, m. Throws only std::bad_alloc.
[[nodiscard]] Mesh generate(const Triangle& shape);
/// Mesh of a string, m. Throws only std::bad_alloc.
[[nodiscard]] Mesh generate(const String& shape);

}  // namespace drogue::mesh
