#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "kernels/mesh/mesh.hpp"

namespace drogue::parachute_app {

/// Low and high end along each axis, m.
using Box = std::array<std::array<double, 2>, 3>;

inline constexpr std::array<double, 2> inverted_range = {std::numeric_limits<double>::infinity(),
                                                         -std::numeric_limits<double>::infinity()};
/// Box around nothing.
inline constexpr Box empty_box = {inverted_range, inverted_range, inverted_range};

inline void extend(Box& box, const mesh::Vector& x) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    box[axis] = {std::min(box[axis][0], x[axis]), std::max(box[axis][1], x[axis])};
}

/// Box around points.
template <class Points>
[[nodiscard]] Box box_around(const Points& points) {
  Box box = empty_box;
  for (const mesh::Vector& x : points) extend(box, x);
  return box;
}

[[nodiscard]] inline mesh::Vector displaced(const mesh::Vector& x, const mesh::Vector& by) {
  return {x[0] + by[0], x[1] + by[1], x[2] + by[2]};
}

[[nodiscard]] inline Box displaced(Box box, const mesh::Vector& by) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (double& x : box[axis]) x += by[axis];
  return box;
}

/// Distance of boxes, m, along the axis where it is largest; negative if they overlap.
[[nodiscard]] inline double distance(const Box& a, const Box& b) {
  double result = inverted_range[1];
  for (std::size_t axis = 0; axis < 3; ++axis)
    result = std::max({result, a[axis][0] - b[axis][1], b[axis][0] - a[axis][1]});
  return result;
}

/// Intersection of two boxes; inverted if they have none.
[[nodiscard]] inline Box common(Box a, const Box& b) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    a[axis] = {std::max(a[axis][0], b[axis][0]), std::min(a[axis][1], b[axis][1])};
  return a;
}

/// Appends an element, such as a triangle, that reaches into a box, with numbers of vertices from `first` on.
template <std::size_t n, class Points>
void append_within(const Box& box, const std::array<int, n>& element, const Points& positions, int first,
                   std::vector<std::array<int, n>>& result) {
  Box around = empty_box;
  std::array<int, n> moved = element;
  for (int& i : moved) {
    extend(around, positions[static_cast<std::size_t>(i)]);
    i += first;
  }
  if (distance(around, box) <= 0.0) result.push_back(moved);
}

}  // namespace drogue::parachute_app
