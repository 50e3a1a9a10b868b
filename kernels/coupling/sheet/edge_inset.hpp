#pragma once

#include <array>
#include <vector>

#include "kernels/coupling/staggered_grid.hpp"
#include "kernels/device/launch.hpp"
#include "kernels/fabric/state.hpp"
#include "kernels/fabric/views.hpp"
#include "kernels/mesh/edge_shift.hpp"
#include "kernels/spatial/points.hpp"

namespace drogue::coupling {

/// Cells from a free edge within which vertices move inwards for the exchange with the air: twice the largest
/// `SheetParameters::edge_inset`.
inline constexpr double inset_band = 2.0;

/// Points at which the vertices near free edges exchange forces with the air: those of
/// `mesh::shifted_from_edges` with `inset` as shift and `inset_band` as band, all in cells, of which the axes
/// may have different spacings. Free are all edges of single triangles but those at which the sheet ends at a
/// side of the grid, within half a cell of it: of a plate that closes a channel, and the long ones of a strip
/// in two dimensions. None if `inset` is 0. Throws only std::bad_alloc.
[[nodiscard]] std::vector<mesh::SurfacePoint> inset_points(const mesh::Mesh& mesh, const StaggeredGrid& grid,
                                                           double inset);

/// Moves the points of vertices near free edges to where they exchange forces with the air.
template <class ExecutionSpace>
struct EdgeInsetFunctor {
  fabric::ListView<ExecutionSpace, int> vertex;
  fabric::TableView<ExecutionSpace, int, 3> corner;
  fabric::TableView<ExecutionSpace, double, 3> weight;
  fabric::State<ExecutionSpace> cloth;
  double time;  ///< s
  fabric::PointsView<ExecutionSpace> points;

  KOKKOS_FUNCTION void operator()(const int n) const {
    spatial::Point sum{0.0, 0.0, 0.0};
    for (int k = 0; k < 3; ++k) {
      const int i = corner(n, k);
      sum = sum + weight(n, k) * (spatial::load_vector(cloth.positions, i) +
                                  time * spatial::load_vector(cloth.velocities, i));
    }
    spatial::store_vector(points, vertex(n), sum);
  }
};

/// Inset of the free edges of a sheet. The delta function lets a sheet act on the air beyond its edges, so
/// that drag and added mass are too large to first order in the cells. With the inset, vertices near an edge
/// exchange forces with the air nearer to the middle of the sheet, and its edge in the air lies nearer to
/// that of the cloth. Both directions of the transfer use the same points, so that all its guarantees hold.
template <class ExecutionSpace>
class EdgeInset {
 public:
  /// `inset` in cells, 0 for none. Blocks. Throws only if memory runs out.
  EdgeInset(const ExecutionSpace& space, const mesh::Mesh& mesh, const StaggeredGrid& grid, double inset) {
    std::vector<int> vertex;
    std::array<std::vector<int>, 3> corner;
    std::array<std::vector<double>, 3> weight;
    for (const mesh::SurfacePoint& point : inset_points(mesh, grid, inset)) {
      vertex.push_back(point.vertex);
      for (std::size_t k = 0; k < 3; ++k) {
        corner[k].push_back(point.corner[k]);
        weight[k].push_back(point.weight[k]);
      }
    }
    _points = static_cast<int>(vertex.size());
    _vertex = fabric::list_view(space, "drogue::coupling::inset_vertices", vertex);
    _corner = fabric::table_view(space, "drogue::coupling::inset_corners", corner);
    _weight = fabric::table_view(space, "drogue::coupling::inset_weights", weight);
  }

  /// Number of vertices that it moves. Does not throw.
  [[nodiscard]] int size() const { return _points; }

  /// Sets the rows of `points`, m, of vertices near free edges to their places on the cloth at its positions
  /// plus time, s, times its velocities; leaves the others. Asynchronous. Throws only after a failed kernel.
  void operator()(const ExecutionSpace& space, const fabric::State<ExecutionSpace>& cloth, double time,
                  const fabric::PointsView<ExecutionSpace>& points) const {
    if (_points == 0) return;
    device::launch_each(space, "drogue::coupling::inset_edges", _points,
                        EdgeInsetFunctor<ExecutionSpace>{.vertex = _vertex,
                                                         .corner = _corner,
                                                         .weight = _weight,
                                                         .cloth = cloth,
                                                         .time = time,
                                                         .points = points});
  }

 private:
  int _points = 0;
  fabric::ListView<ExecutionSpace, int> _vertex;
  fabric::TableView<ExecutionSpace, int, 3> _corner;
  fabric::TableView<ExecutionSpace, double, 3> _weight;
};

}  // namespace drogue::coupling
