#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "kernels/fabric/parameters.hpp"
#include "kernels/flow/parameters.hpp"
#include "miniapps/parachute/canopy/canopy.hpp"

namespace drogue::parachute_app {

/// Displacements, m, by which a domain with periodic sides repeats: one of each pair of opposites, those to
/// neighbours alone. Axes of one cell have none. Throws only std::bad_alloc.
[[nodiscard]] std::vector<fabric::Vector> periods_of(const flow::Parameters& p);

/// The bodies, then the canopies, then the flags, as parts of all vertices of a scene.
struct SheetParts {
  std::vector<std::size_t> ends;         ///< of the vertices of every part
  std::size_t bodies = 0, canopies = 0;  ///< numbers of parts
  std::vector<bool> moves;               ///< of every part

  /// Number of the part of a vertex; the last one for a vertex beyond all. Does not throw.
  [[nodiscard]] std::size_t of(int vertex) const;
  /// Name of a part in the scene, such as "canopy[0]". Throws only std::bad_alloc.
  [[nodiscard]] std::string name(std::size_t part) const;
};

/// Parts of sheets that begin with bodies. Throws only std::bad_alloc.
[[nodiscard]] SheetParts parts_of(const std::vector<Body>& bodies, const Sheets& sheets);

/// Triangles of all sheets, and lines that are not cut.
struct SheetElements {
  std::span<const std::array<int, 3>> triangles;
  std::span<const std::array<int, 2>> lines;
};

/// Edge or line of sheets that meets a triangle of an image, by vertices of the sheets themselves.
struct ImageIntersection {
  int of_segment, of_triangle;  ///< first vertices
};

/// All intersections of sheets at positions, m, with images beyond periodic sides, but for those of a body
/// with its own image, which it may touch. What ends at the sides does not meet the image that begins there.
/// Throws only std::bad_alloc.
[[nodiscard]] std::vector<ImageIntersection> image_intersections(std::span<const fabric::Vector> positions,
                                                                 const SheetElements& elements,
                                                                 std::span<const fabric::Vector> periods,
                                                                 const SheetParts& parts);

/// Least distance, m, of the boxes around parts that move and the boxes around images, or images of parts
/// that move; not positive where they overlap, infinite without such a pair. Throws only std::bad_alloc.
[[nodiscard]] double distance_from_images(std::span<const fabric::Vector> positions,
                                          std::span<const std::array<int, 2>> lines,
                                          std::span<const fabric::Vector> periods, const SheetParts& parts);

/// Lines of canopies that are not cut at a time, s; the springs of plates are no obstacles. Throws only
/// std::bad_alloc.
[[nodiscard]] std::vector<std::array<int, 2>> whole_lines(const Sheets& sheets, double time);

}  // namespace drogue::parachute_app
