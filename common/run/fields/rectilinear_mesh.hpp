#pragma once

#include <string>
#include <vector>

#include "common/run/fields/field_sink.hpp"

namespace drogue::run {

/// Face coordinates of a rectilinear grid, m, ascending: one more than there are cells along each axis.
struct FaceCoordinates {
  std::vector<double> x, y, z;
};

/// Order of the axes of field datasets, slowest first: shapes (nz, ny, nx[, 3]) or (nx, ny, nz[, 3]).
enum class AxisOrder { zyx, xyz };

/// Adds the mesh of a rectilinear grid to `fields`: `x`, `y` and `z`, and for the order xyz the vertices
/// `points` of shape (nx + 1, ny + 1, nz + 1, 3).
///
/// XDMF requires x to vary fastest in fields of a rectilinear grid and has no transposition. Exchanging the
/// names of the axes would show each value at mirrored coordinates. Fields with the order xyz are therefore
/// described as a structured grid with explicit vertices in the order of the fields; the file holds as many
/// numbers for them as for one vector field. `grid` names the grid, empty for the main one. Throws
/// std::invalid_argument for fewer than two coordinates of an axis, and `Failure` (io_error).
void add_rectilinear_mesh(FieldSink& fields, const FaceCoordinates& faces, AxisOrder order,
                          const std::string& grid = {});

}  // namespace drogue::run
