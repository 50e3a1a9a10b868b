#pragma once

#include <vector>

#include "kernels/device/copy.hpp"
#include "kernels/options/grid/grid.hpp"
#include "kernels/options/transforms/fourier_roots.hpp"

namespace drogue::options {

/// The table behind `FourierRoots` on `ExecutionSpace`.
template <class ExecutionSpace>
class RootsOfUnity {
  using Space = typename ExecutionSpace::memory_space;

 public:
  /// The roots that solves on a mesh need. Enqueues the copy of the table for the first mesh that does.
  [[nodiscard]] FourierRoots of_mesh(const ExecutionSpace& space, int mesh) {
    if (_table.size() == 0 && is_transformed(mesh, lanes_of(mesh))) {
      _host_table = fourier_roots();
      _table = Kokkos::View<double*, Space>("drogue::options::roots", _host_table.size());
      device::copy_in(space, _table, _host_table.data(), _host_table.size());
    }
    return FourierRoots::of(_table.data());
  }

 private:
  Kokkos::View<double*, Space> _table;
  std::vector<double> _host_table;
};

}  // namespace drogue::options
