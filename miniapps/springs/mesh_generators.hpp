#pragma once

#include "kernels/fabric/parameters.hpp"

namespace drogue::springs_app {

/// Each generator takes the finest mesh whose number of vertices is near the one asked for; all triangles
/// turn counter-clockwise seen from +z, their normal.

/// 0 .. width by 0 .. height (m) in the plane z = 0: nearly square cells, their diagonals alternating.
struct Rectangle {
  double width = 1.0, height = 1.0;
  int vertices = 1000;
  double distortion = 0.0;  ///< inner vertices are moved by up to this share of a cell, below 1/4
};

/// About the origin in the plane z = 0: ring k of n has 6 k vertices, 1 + 3 n (n + 1) in all.
struct Disk {
  double radius = 1.0;  ///< m
  int vertices = 1000;
};

/// 0 .. length by 0 .. width (m) in the plane z = 0: rows of nearly equilateral triangles, halved at the
/// ends.
struct Strip {
  double length = 1.0, width = 0.2;
  int vertices = 1000;
};

/// Equilateral, corners (0, 0), (side, 0) and above them (m), in n^2 equal triangles.
struct Triangle {
  double side = 1.0;
  int vertices = 1000;
};

/// Equal pieces between two points (m).
struct String {
  fabric::Vector from{0.0, 0.0, 0.0}, to{1.0, 0.0, 0.0};
  int vertices = 100;
};

fabric::Mesh generate(const Rectangle& wanted);
fabric::Mesh generate(const Disk& wanted);
fabric::Mesh generate(const Strip& wanted);
fabric::Mesh generate(const Triangle& wanted);
fabric::Mesh generate(const String& wanted);

}  // namespace drogue::springs_app
