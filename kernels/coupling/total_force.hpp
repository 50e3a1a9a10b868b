#pragma once

#include <array>
#include <cstddef>

#include "kernels/coupling/face_stencil.hpp"
#include "kernels/coupling/grid_transfer.hpp"
#include "kernels/device/copy.hpp"
#include "kernels/device/launch.hpp"

namespace drogue::coupling {

/// Index n sums the densities on the faces of component n % 3 with the last index n / 3, in a fixed order.
template <class ExecutionSpace, class View>
struct SumLayersFunctor {
  View force_density[3];
  Kokkos::View<double*, typename ExecutionSpace::memory_space> layers;

  KOKKOS_FUNCTION void operator()(const int n) const {
    const View& values = force_density[n % 3];
    const auto k = static_cast<std::size_t>(n / 3);
    double sum = 0.0;
    if (k < values.extent(2))
      for (std::size_t j = 0; j < values.extent(1); ++j)
        for (std::size_t i = 0; i < values.extent(0); ++i) sum += values(i, j, k);
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
        _layers("drogue::coupling::layers", 3 * (static_cast<std::size_t>(grid.cells[2]) + 1)),
        _mirror(Kokkos::create_mirror_view(_layers)) {}

  /// Sum of `force_density`, N/m^3, times the volume of a cell, with the same bits for any number of threads.
  /// Blocks. Throws std::runtime_error after a failed kernel.
  template <class View>
  [[nodiscard]] std::array<double, 3> operator()(const ExecutionSpace& space,
                                                 const FaceViews<View>& force_density) const {
    device::launch_each(
        space, "drogue::coupling::sum_layers", static_cast<int>(_layers.extent(0)),
        SumLayersFunctor<ExecutionSpace, View>{
            {force_density.component[0], force_density.component[1], force_density.component[2]}, _layers});
    device::copy(space, _mirror, _layers);
    space.fence("drogue::coupling::total_force");
    std::array<double, 3> sum{};
    for (std::size_t n = 0; n < _mirror.extent(0); ++n) sum[n % 3] += _volume * _mirror(n);
    return sum;
  }

 private:
  double _volume;  ///< m^3
  Kokkos::View<double*, typename ExecutionSpace::memory_space> _layers;
  typename Kokkos::View<double*, typename ExecutionSpace::memory_space>::host_mirror_type _mirror;
};

}  // namespace drogue::coupling
