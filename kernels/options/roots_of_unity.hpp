#pragma once

#include <vector>

#include "kernels/device/copy.hpp"
#include "kernels/options/fourier_roots.hpp"

namespace drogue::options {

/// The table behind `FourierRoots` on `ExecutionSpace`.
template <class ExecutionSpace>
class RootsOfUnity {
  using Space = typename ExecutionSpace::memory_space;

 public:
  /// Enqueues the copy of the table when it is needed first.
  void fetch(const ExecutionSpace& space) {
    if (_table.size() != 0) return;
    _host_table = fourier_roots();
    _table = Kokkos::View<double*, Space>("drogue::options::roots", _host_table.size());
    copy_bytes(space, device::copy_way<ExecutionSpace, Space, Kokkos::HostSpace>(), _table.data(),
               _host_table.data(), _host_table.size() * sizeof(double));
  }

  [[nodiscard]] FourierRoots roots() const { return FourierRoots::of(_table.data()); }

 private:
  Kokkos::View<double*, Space> _table;
  std::vector<double> _host_table;
};

}  // namespace drogue::options
