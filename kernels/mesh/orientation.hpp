#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "kernels/mesh/mesh.hpp"

namespace drogue::mesh {

/// Part of a surface whose triangles common edges connect.
struct SurfacePart {
  int first = 0;               ///< its first triangle
  std::size_t triangles = 0;   ///< their number
  std::size_t free_edges = 0;  ///< edges of one triangle; a part without them is closed
  /// Enclosed by a closed part whose triangles agree, m^3: positive if normals point outwards. 0: not closed.
  double volume = 0.0;
};

/// Sides of a surface.
struct Orientation {
  std::vector<SurfacePart> parts;  ///< in the order of their first triangles
  std::vector<int> part_of;        ///< number of the part of each triangle
  /// 1 for each triangle to be turned so that neighbours have their normals on one side: the fewer ones of
  /// each part.
  std::vector<char> turned;
  /// Two neighbours that cannot agree: the surface has one side, as a Moebius strip.
  std::optional<std::array<int, 2>> one_sided;

  /// Number of triangles to be turned. Does not throw.
  [[nodiscard]] std::size_t turns() const;
};

/// Parts and sides of the triangles of a mesh, each edge of at most two of them. `volume` is that after the
/// turns. Throws only std::bad_alloc.
[[nodiscard]] Orientation orientation_of(const Mesh& mesh);

/// Volume between triangles at the positions `x` of all vertices, m, and a point, m^3: positive where normals
/// point away from it, and for a closed surface the enclosed one, whatever the point. Does not throw.
[[nodiscard]] double volume_between(std::span<const std::array<int, 3>> triangles, std::span<const Vector> x,
                                    const Vector& point);

/// Exchanges two corners of each triangle that `orientation` turns. Does not throw.
void turn(Mesh& mesh, const Orientation& orientation);

/// Volume of the union of the closed parts of a mesh without turns, m^3. A part within another one adds
/// nothing. Throws only std::bad_alloc.
[[nodiscard]] double enclosed_volume(const Mesh& mesh, const Orientation& orientation);

}  // namespace drogue::mesh
