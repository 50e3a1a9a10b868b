#pragma once

#include <vector>

#include "kernels/device/copy.hpp"
#include "kernels/options/grid/grid.hpp"
#include "kernels/options/transforms/complex_number.hpp"

namespace drogue::options {

/// e^{2 pi i phi m/8}, m = 1 .. 7.
struct SevenRoots {
  ComplexNumber<double> root[7];
};

/// Roots of unity for transforms of up to 4096 points. x^n - i splits into eight factors, each of these into
/// eight, and so on. On a level with 8^level factors, factor b is x^m - e^{2 pi i phi} with m = n/8^level.
/// phi is 1/4 on the first level and (phi + q)/8 for part q of a factor. The roots do not depend on n.
struct FourierRoots {
  const ComplexNumber<double>* table;  ///< (8^levels - 1), in the memory of the backend

  KOKKOS_INLINE_FUNCTION static FourierRoots from_table(const double* table) {
    return {reinterpret_cast<const ComplexNumber<double>*>(table)};
  }
  /// e^{2 pi i phi m/8}, m = 1 .. 7. The roots of one m are contiguous, as lanes read them.
  [[nodiscard]] KOKKOS_INLINE_FUNCTION ComplexNumber<double> at(int level, int m, int factor) const {
    return table[first(level) + ((m - 1) << (3 * level)) + factor];
  }
  [[nodiscard]] KOKKOS_INLINE_FUNCTION SevenRoots seven(int level, int factor) const {
    SevenRoots roots;
    for (int m = 1; m < 8; ++m) roots.root[m - 1] = at(level, m, factor);
    return roots;
  }
  /// Offset of a level in the table: 7 (1 + 8 + ... + 8^{level-1}).
  [[nodiscard]] KOKKOS_INLINE_FUNCTION static constexpr int first(int level) {
    return (1 << (3 * level)) - 1;
  }
  static constexpr int levels = 4;
};

/// Table of `FourierRoots` on the host, (8^levels - 1, 2): cosines and sines, dimensionless. Does not throw
/// except `std::bad_alloc`.
[[nodiscard]] std::vector<double> fourier_roots();

/// Owner of the table of `FourierRoots` on `ExecutionSpace`.
template <class ExecutionSpace>
class FourierRootsTable {
  using Space = typename ExecutionSpace::memory_space;

 public:
  /// Roots for solves on a mesh; empty if the mesh uses no transforms. The first call that needs the table
  /// enqueues its copy.
  [[nodiscard]] FourierRoots for_mesh(const ExecutionSpace& space, int mesh) {
    if (_table.size() == 0 && is_transformed(mesh, lanes_of(mesh))) {
      _host_table = fourier_roots();
      _table = Kokkos::View<double*, Space>("drogue::options::roots", _host_table.size());
      device::copy_in(space, _table, _host_table.data(), _host_table.size());
    }
    return FourierRoots::from_table(_table.data());
  }

 private:
  Kokkos::View<double*, Space> _table;
  std::vector<double> _host_table;
};

}  // namespace drogue::options
