#pragma once

#include <span>
#include <vector>

#include "kernels/fabric/parameters.hpp"
#include "kernels/flow/parameters.hpp"

namespace drogue::parachute_app {

/// Displacements, m, by which a domain with periodic sides repeats: one of each pair of opposites, those to
/// neighbours alone. Axes of one cell have none. Throws only std::bad_alloc.
[[nodiscard]] std::vector<fabric::Vector> periods_of(const flow::Parameters& p);

/// Edge or line of sheets that meets a triangle of their image, by vertices of the sheets themselves.
struct ImageIntersection {
  int of_segment, of_triangle;  ///< first vertices
};

/// All intersections of sheets at positions, m, with their images beyond periodic sides. Vertices before
/// `bodies_end` are those of bodies, whose images may touch them. Throws only std::bad_alloc.
[[nodiscard]] std::vector<ImageIntersection> image_intersections(
    std::span<const fabric::Vector> positions, std::span<const std::array<int, 3>> triangles,
    std::span<const std::array<int, 2>> lines, std::span<const fabric::Vector> periods, int bodies_end);

}  // namespace drogue::parachute_app
