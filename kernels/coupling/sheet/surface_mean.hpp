#pragma once

#include "kernels/coupling/staggered_grid.hpp"
#include "kernels/device/pack.hpp"
#include "kernels/fabric/fabric_views.hpp"
#include "kernels/fabric/surface/surface.hpp"
#include "kernels/spatial/points.hpp"

namespace drogue::coupling {

/// Number of means along a surface that smooth values over half a cell, the root of their mean square
/// distance along each tangent, on equilateral triangles of the mean area of those at rest: 0.32 over that
/// area in cells, at least 1. Does not throw.
[[nodiscard]] int smoothing_sweeps(const mesh::Mesh& mesh, const StaggeredGrid& grid);

/// A value at each vertex, (vertices, 1), as an array of the state.
template <class ExecutionSpace>
using VertexValues = Kokkos::View<double**, Kokkos::LayoutLeft, typename ExecutionSpace::memory_space>;

template <class ExecutionSpace>
struct TriangleAreaFunctor {
  fabric::SurfaceViews<ExecutionSpace> surface;
  fabric::PointsView<ExecutionSpace> positions;   ///< m
  fabric::ListView<ExecutionSpace, double> area;  ///< doubled, m^2

  KOKKOS_FUNCTION void operator()(const int t) const {
    const spatial::Point doubled = doubled_area_vector(surface, positions, t);
    area(t) = device::square_root(dot(doubled, doubled));
  }
};

/// Mean along a surface at vertex i of the first column of `values`: of the corners of each triangle, then of
/// the triangles around the vertex, weighted by `area`. It keeps the integral over the surface, is symmetric
/// in the inner product of areas, and its factors are 0 to 1. Zero where there is no area.
template <class ExecutionSpace>
KOKKOS_FUNCTION double surface_mean(const fabric::SurfaceViews<ExecutionSpace>& surface,
                                    const fabric::ListView<ExecutionSpace, double>& area,
                                    const VertexValues<ExecutionSpace>& values, int i) {
  double sum = 0.0, weight = 0.0;
  for (int k = surface.first(i); k < surface.first(i + 1); ++k) {
    const int t = surface.around(k);
    const double corners =
        values(surface.corner(t, 0), 0) + values(surface.corner(t, 1), 0) + values(surface.corner(t, 2), 0);
    sum += area(t) * corners;
    weight += 3.0 * area(t);
  }
  return weight > 0.0 ? sum / weight : 0.0;
}

}  // namespace drogue::coupling
