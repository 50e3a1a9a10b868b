#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "kernels/device/copy.hpp"
#include "kernels/options/contract.hpp"
#include "kernels/options/levy/hankel_table.hpp"

namespace drogue::options {

/// Chebyshev tables of the panels of orders that contracts need, on the host and on `ExecutionSpace`. Tables
/// are built once per panel.
template <class ExecutionSpace>
class HankelPanels {
  using Space = typename ExecutionSpace::memory_space;

 public:
  /// Builds the missing tables on the host.
  void build(std::span<const Contract> contracts) {
    for (const Contract& contract : contracts) {
      if (contract.model != JumpModel::generalized_hyperbolic || contract.jump[3] == 0.0) continue;
      const double order = std::fabs(contract.jump[0]);
      if (!(order < HankelGrid::largest_order)) continue;
      int& slot = _host_slots[static_cast<std::size_t>(panel_of(order))];
      if (slot >= 0) continue;
      slot = static_cast<int>(_host_series.size()) / HankelGrid::panel_size;
      const std::vector<double> panel = hankel_panel(panel_of(order));
      _host_series.insert(_host_series.end(), panel.begin(), panel.end());
      _copied = false;
    }
  }

  /// Copies new tables to the backend. Blocks until they are there.
  void copy_in(const ExecutionSpace& space) {
    if (_copied) return;
    _series = Kokkos::View<double*, Space>("drogue::options::panels", _host_series.size());
    _slots = Kokkos::View<int*, Space>("drogue::options::panel slots", _host_slots.size());
    device::copy_in(space, _series, _host_series.data(), _host_series.size());
    device::copy_in(space, _slots, _host_slots.data(), _host_slots.size());
    space.fence("drogue::options: panels are copied");  // the next `build` may change the sources
    _copied = true;
  }

  /// Tables, shape (number of built panels, HankelGrid::panel_size).
  [[nodiscard]] const Kokkos::View<double*, Space>& series() const { return _series; }
  /// Index of each panel's table, -1 for none; shape (HankelGrid::panels).
  [[nodiscard]] const Kokkos::View<int*, Space>& slots() const { return _slots; }
  /// As `series`, on the host.
  [[nodiscard]] const std::vector<double>& host_series() const { return _host_series; }
  /// As `slots`, on the host.
  [[nodiscard]] const std::vector<int>& host_slots() const { return _host_slots; }

 private:
  Kokkos::View<double*, Space> _series;
  Kokkos::View<int*, Space> _slots;
  bool _copied = false;
  std::vector<double> _host_series;
  std::vector<int> _host_slots = std::vector<int>(HankelGrid::panels, -1);
};

}  // namespace drogue::options
