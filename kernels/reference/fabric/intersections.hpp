#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace drogue::reference {

/// -1, 0 or 1: on which side of the plane through a, b, c the point d lies; 1 where a, b, c turn clockwise
/// seen from d. Exact for any finite doubles: in rational numbers where extended precision cannot tell.
[[nodiscard]] int side_of_plane(const std::array<double, 3>& a, const std::array<double, 3>& b,
                                const std::array<double, 3>& c, const std::array<double, 3>& d);

/// Whether a segment and a triangle have a point in common, touching included.
[[nodiscard]] bool meet(const std::array<std::array<double, 3>, 2>& segment,
                        const std::array<std::array<double, 3>, 3>& triangle);

/// A segment, as two vertices, that meets a triangle of which it shares no vertex.
struct Intersection {
  std::array<int, 2> segment;
  std::size_t triangle;
};

/// All of them among the edges of the triangles, the lines, and the triangles; every pair whose boxes overlap
/// is decided exactly. Two triangles of a mesh without common vertex intersect exactly if an edge of one
/// meets the other.
[[nodiscard]] std::vector<Intersection> intersections(std::span<const std::array<double, 3>> positions,
                                                      std::span<const std::array<int, 3>> triangles,
                                                      std::span<const std::array<int, 2>> lines);

}  // namespace drogue::reference
