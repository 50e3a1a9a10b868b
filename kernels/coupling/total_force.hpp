#pragma once

#include <array>
#include <cstddef>

#include "kernels/coupling/face_stencil.hpp"
#include "kernels/coupling/grid_transfer.hpp"
#include "kernels/device/copy.hpp"
#include "kernels/device/launch.hpp"

namespace drogue::coupling {

/// Sums the densities on the faces of each component along x: rows of y, and layers of z, one component after
/// the other.
template <class ExecutionSpace, class View>
struct SumRowsFunctor {
  View force_density[3];
  Kokkos::View<double***, Kokkos::LayoutLeft, typename ExecutionSpace::memory_space> rows;

  KOKKOS_FUNCTION void operator()(const int n) const {
    const int j = n % rows.extent_int(0), k = n / rows.extent_int(0) % rows.extent_int(1),
              c = n / (rows.extent_int(0) * rows.extent_int(1));
    const View& values = force_density[c];
    double sum = 0.0;
    if (j < values.extent_int(1) && k < values.extent_int(2))
      for (int i = 0; i < values.extent_int(0); ++i) sum += values(i, j, k);
    rows(j, k, c) = sum;
  }
};

/// Sums rows of a layer in order.
template <class ExecutionSpace>
struct SumLayersFunctor {
  Kokkos::View<double***, Kokkos::LayoutLeft, typename ExecutionSpace::memory_space> rows;
  Kokkos::View<double*, typename ExecutionSpace::memory_space> layers;

  KOKKOS_FUNCTION void operator()(const int n) const {
    double sum = 0.0;
    for (int j = 0; j < rows.extent_int(0); ++j)
      sum += rows(j, n % rows.extent_int(1), n / rows.extent_int(1));
    layers(n) = sum;
  }
};

/// Total force of densities on the faces of a grid, N, with memory that is allocated once.
template <class ExecutionSpace>
class TotalForce {
 public:
  /// Throws std::runtime_error if memory runs out.
  explicit TotalForce(const StaggeredGrid& grid)
      : _volume(cell_volume(grid)),
        _rows("drogue::coupling::rows", static_cast<std::size_t>(grid.cells[1]) + 1,
              static_cast<std::size_t>(grid.cells[2]) + 1, 3),
        _layers("drogue::coupling::layers", 3 * _rows.extent(1)),
        _mirror(Kokkos::create_mirror_view(_layers)) {}

  /// Sum of `force_density`, N/m^3, times the volume of a cell, with the same bits for any number of threads.
  /// Blocks. Throws std::runtime_error after a failed kernel.
  template <class View>
  [[nodiscard]] std::array<double, 3> operator()(const ExecutionSpace& space,
                                                 const FaceViews<View>& force_density) const {
    device::launch_each(
        space, "drogue::coupling::sum_rows", static_cast<int>(_rows.size()),
        SumRowsFunctor<ExecutionSpace, View>{
            {force_density.component[0], force_density.component[1], force_density.component[2]}, _rows});
    device::launch_each(space, "drogue::coupling::sum_layers", _layers.extent_int(0),
                        SumLayersFunctor<ExecutionSpace>{_rows, _layers});
    device::copy(space, _mirror, _layers);
    space.fence("drogue::coupling::total_force");
    std::array<double, 3> sum{};
    for (std::size_t n = 0; n < _mirror.extent(0); ++n) sum[n / _rows.extent(1)] += _volume * _mirror(n);
    return sum;
  }

 private:
  double _volume;  ///< m^3
  Kokkos::View<double***, Kokkos::LayoutLeft, typename ExecutionSpace::memory_space> _rows;
  Kokkos::View<double*, typename ExecutionSpace::memory_space> _layers;
  typename Kokkos::View<double*, typename ExecutionSpace::memory_space>::host_mirror_type _mirror;
};

}  // namespace drogue::coupling
