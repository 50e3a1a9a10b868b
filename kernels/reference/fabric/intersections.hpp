#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace drogue::reference {

/// Side of the plane through a, b, c, m, on which d lies: 1 if a, b, c appear clockwise from d, -1 if
/// counterclockwise, 0 if coplanar. Exact for finite coordinates; falls back to rational arithmetic where
/// extended precision does not decide.
[[nodiscard]] int side_of_plane(const std::array<double, 3>& a, const std::array<double, 3>& b,
                                const std::array<double, 3>& c, const std::array<double, 3>& d);

/// Returns whether a segment and a triangle, m, have a common point, boundaries included. Exact.
[[nodiscard]] bool meet(const std::array<std::array<double, 3>, 2>& segment,
                        const std::array<std::array<double, 3>, 3>& triangle);

/// Intersection of a segment, given by two vertices, with a triangle that shares no vertex with it.
struct Intersection {
  std::array<int, 2> segment;
  std::size_t triangle;
};

/// All intersections of the edges of the triangles and of the lines with the triangles, by exact predicates.
/// Two triangles without a common vertex intersect if and only if an edge of one meets the other.
[[nodiscard]] std::vector<Intersection> intersections(std::span<const std::array<double, 3>> positions,
                                                      std::span<const std::array<int, 3>> triangles,
                                                      std::span<const std::array<int, 2>> lines);

}  // namespace drogue::reference
