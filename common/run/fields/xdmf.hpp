#pragma once

#include <string>
#include <vector>

#include "common/run/fields/dataset_spec.hpp"

namespace drogue::run {

/// Output of a run: its group below /steps and its time, s.
struct OutputStep {
  std::string group;
  double time = 0.0;
};

/// Datasets of one grid. The names in `mesh` determine its kind:
///   points                        structured grid (3DSMesh): (n0,n1,n2,3) vertices in the index order of
///                                 the fields, for any order of the axes (`add_rectilinear_mesh`)
///   x, y [, z], centred at faces  rectilinear grid: fields of shape (nz,ny,nx), or (ny,nx) without z, with
///                                 the same order at vertices; x varies fastest
///   x alone                       line; fields at its points
///   vertices, triangles, strings  triangle mesh (m,3) and polylines (k,2) over vertices (n,3)
/// A uniform grid is a rectilinear grid with equidistant coordinates.
struct GridDatasets {
  std::string name;  ///< group below /mesh and /steps/N; empty: the datasets lie directly there
  std::vector<DatasetSpec> mesh, fields;
};

/// True if `mesh` holds all datasets of a kind of grid. Does not throw.
[[nodiscard]] bool is_complete(const std::vector<DatasetSpec>& mesh);

/// False if a field has another shape than the cells or vertices of a rectilinear grid, say before z is added
/// to the mesh; true for other grids. Does not throw.
[[nodiscard]] bool fields_fit(const GridDatasets& grid);

/// Content of fields.xdmf for ParaView: one temporal collection per grid, named `title` and the grid's name.
///
/// Fields are at vertices or cells as their `centering` states; a trailing dimension 3 makes a vector, 6 a
/// symmetric tensor (xx, xy, xz, yy, yz, zz). Vertices of a triangle mesh lie at the field `position`, if it
/// is written. Triangles and strings become two collections: a mixed mesh would require values of triangle
/// fields at strings, and ParaView renumbers the elements of a collection of pairs. The cell centres of a
/// line become points, because ParaView draws values at cells of a line as steps. Throws
/// std::invalid_argument for an incomplete mesh and for fields that do not fit a rectilinear grid.
[[nodiscard]] std::string xdmf_document(const std::string& title, const std::vector<GridDatasets>& grids,
                                        const std::vector<OutputStep>& outputs);

}  // namespace drogue::run
