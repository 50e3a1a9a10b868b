#pragma once

#include <stdexcept>

#include "kernels/device/launch.hpp"
#include "kernels/fabric/surface/triangle_geometry.hpp"
#include "kernels/fabric/views.hpp"
#include "kernels/mesh/incidence.hpp"
#include "kernels/spatial/points.hpp"

namespace drogue::fabric {

// Geometry of a moving surface of triangles. The functions are asynchronous on the given instance, allocate
// nothing and may be captured into a CUDA graph. Positions and velocities are Views (vertices, 3) of any
// layout, such as those of `State`. Each sum has a fixed order, so results do not depend on the backend in a
// build that promises reproducibility.

/// Connectivity of a surface on a device. Constructed once; copies share the Views.
template <class ExecutionSpace>
struct SurfaceViews {
  /// Copies the connectivity of a mesh to the device. Blocks. Throws std::invalid_argument for a triangle of
  /// a vertex that the mesh lacks, and std::runtime_error if memory runs out.
  SurfaceViews(const ExecutionSpace& space, const mesh::Mesh& mesh)
      : SurfaceViews(space, mesh, mesh::vertex_triangles(with_valid_triangles(mesh))) {}

  /// Numbers of triangles and vertices. Does not throw.
  [[nodiscard]] int triangles() const { return static_cast<int>(corner.extent(0)); }
  [[nodiscard]] int vertices() const { return static_cast<int>(first.extent(0)) - 1; }

  TableView<ExecutionSpace, int, 3> corner;     ///< vertices of triangle t
  ListView<ExecutionSpace, int> first, around;  ///< triangles of vertex i: around(first(i)) and on

 private:
  SurfaceViews(const ExecutionSpace& space, const mesh::Mesh& mesh, const mesh::VertexTriangles& incidence)
      : corner(table_view(space, "drogue::fabric::surface_corners", columns(mesh))),
        first(list_view(space, "drogue::fabric::surface_first", incidence.first)),
        around(list_view(space, "drogue::fabric::surface_around", incidence.triangle)) {}

  static const mesh::Mesh& with_valid_triangles(const mesh::Mesh& mesh) {
    const auto vertices = static_cast<int>(mesh.rest.size());
    for (const auto& corners : mesh.triangles)
      for (const int i : corners)
        if (i < 0 || i >= vertices)
          throw std::invalid_argument("fabric surface: a triangle has a vertex that the mesh lacks");
    return mesh;
  }

  static std::array<std::vector<int>, 3> columns(const mesh::Mesh& mesh) {
    std::array<std::vector<int>, 3> result;
    for (const auto& corners : mesh.triangles)
      for (std::size_t k = 0; k < 3; ++k) result[k].push_back(corners[k]);
    return result;
  }
};

/// Doubled area vector of triangle t, m^2. All corners obtain the same bits.
template <class ExecutionSpace, class Positions>
KOKKOS_INLINE_FUNCTION spatial::Point doubled_area_vector(const SurfaceViews<ExecutionSpace>& surface,
                                                          const Positions& x, int t) {
  return doubled_area_vector(spatial::load_vector(x, surface.corner(t, 0)),
                             spatial::load_vector(x, surface.corner(t, 1)),
                             spatial::load_vector(x, surface.corner(t, 2)));
}

/// Gathers over the triangles around a vertex, in ascending order, without atomics.
template <class ExecutionSpace, class Positions, class Areas, class Normals>
struct VertexGeometryFunctor {
  SurfaceViews<ExecutionSpace> surface;
  Positions x;
  Areas area;
  Normals normal;

  KOKKOS_FUNCTION void operator()(const int i) const {
    spatial::Point sum{0.0, 0.0, 0.0};
    double doubled_area = 0.0;
    for (int k = surface.first(i); k < surface.first(i + 1); ++k) {
      const spatial::Point doubled = doubled_area_vector(surface, x, surface.around(k));
      sum = sum + doubled;
      doubled_area += device::square_root(dot(doubled, doubled));
    }
    area(i) = (1.0 / 6.0) * doubled_area;
    spatial::store_vector(normal, i, unit_normal(sum));
  }
};

/// Throws std::invalid_argument unless the number of rows of a View, in any unit, is at least `rows`.
template <class View>
void require_rows(const View& view, int rows) {
  if (view.extent(0) < static_cast<std::size_t>(rows))
    throw std::invalid_argument("fabric surface: View '" + view.label() + "' has too few rows");
}

/// Area of each vertex, a third of the triangles around it, m^2, and its unit normal, the mean of their
/// normals weighted by area, at positions x, m: `area` (vertices), `normal` (vertices, 3). Both are zero at a
/// vertex without triangles (a string or payload has no area); the normal is zero where a fold cancels it.
/// The velocity of a vertex is that of the state. Asynchronous. Throws std::invalid_argument for too few
/// rows.
template <class ExecutionSpace, class Positions, class Areas, class Normals>
void vertex_geometry(const ExecutionSpace& space, const SurfaceViews<ExecutionSpace>& surface,
                     const Positions& x, const Areas& area, const Normals& normal) {
  static_assert(spatial::accessible_from<ExecutionSpace, Positions, Areas, Normals>);
  require_rows(x, surface.vertices());
  require_rows(area, surface.vertices());
  require_rows(normal, surface.vertices());
  device::launch_each(
      space, "drogue::fabric::vertex_geometry", surface.vertices(),
      VertexGeometryFunctor<ExecutionSpace, Positions, Areas, Normals>{surface, x, area, normal});
}

}  // namespace drogue::fabric
