#pragma once

#include <Kokkos_Core.hpp>

#include "kernels/device/memory.hpp"
#include "kernels/gas/flux/face_flux.hpp"
#include "kernels/gas/tile/team_shape.hpp"

namespace drogue::gas {

inline constexpr int ghost_cells = 3;

/// Conserved fields of one state, shape (cells, 3), each field contiguous: kg/m^3, kg/(m^2 s), J/m^3.
template <class ExecutionSpace>
using FieldsView = Kokkos::View<double* [3], Kokkos::LayoutLeft, typename ExecutionSpace::memory_space>;

/// Number of cells of the mesh and the boundary condition at either end.
struct BoundaryConditions {
  std::int64_t cells;
  Boundary left, right;
};

/// Shape of a tile: cells that it updates, halo cells on either side, and stride of its scratch rows.
struct TileShape {
  int cells;
  int halo;
  int stride;
};

struct BoundaryImage {
  std::int64_t cell;
  double sign;  ///< factor of the momentum: -1 at a reflecting wall
};

/// Cell and sign that provide the value at `index`, which may lie outside the mesh. Beyond the ghost cells of
/// a wall or an outflow any admissible state suffices.
KOKKOS_INLINE_FUNCTION BoundaryImage boundary_image(const BoundaryConditions& boundaries,
                                                    std::int64_t index) {
  const std::int64_t n = boundaries.cells;
  if (index >= 0 && index < n) return {index, 1.0};
  const bool left = index < 0;
  const Boundary kind = left ? boundaries.left : boundaries.right;
  if (kind == Boundary::periodic) {
    // The halo may wrap around the smallest meshes more than once. A loop avoids the integer division of a
    // remainder, which is slow on a GPU.
    while (index < 0) index += n;
    while (index >= n) index -= n;
    return {index, 1.0};
  }
  const std::int64_t beyond = left ? -1 - index : index - n;
  if (kind == Boundary::outflow || beyond >= ghost_cells) return {left ? 0 : n - 1, 1.0};
  return {left ? beyond : n - 1 - beyond, -1.0};
}

/// States of `lanes` cells from `cell` on, all inside the mesh. `in` holds three rows of `cells`.
template <class P>
KOKKOS_INLINE_FUNCTION ConservedVector<P> state_of(const double* in, std::int64_t cells, std::int64_t cell) {
  using Lanes = device::Access<P>;
  return {Lanes::load(in + cell), Lanes::load(in + cells + cell), Lanes::load(in + 2 * cells + cell)};
}

/// States of `lanes` cells from `index` on, ghost cells included. `in` holds three rows of
/// `boundaries.cells`.
template <class R>
KOKKOS_INLINE_FUNCTION ConservedVector<R> load_state(const double* in, const BoundaryConditions& boundaries,
                                                     std::int64_t index) {
  using Lanes = device::Access<R>;
  const std::int64_t n = boundaries.cells;
  if constexpr (Lanes::lanes == 1) {
    // No branch: threads inside and outside the mesh load together.
    const BoundaryImage from = boundary_image(boundaries, index);
    return {Lanes::load(in + from.cell), from.sign * Lanes::load(in + n + from.cell),
            Lanes::load(in + 2 * n + from.cell)};
  }
  if (index >= 0 && index + Lanes::lanes <= n) return state_of<R>(in, n, index);
  double rho[Lanes::lanes], m[Lanes::lanes], energy[Lanes::lanes];
  for (int lane = 0; lane < Lanes::lanes; ++lane) {
    const BoundaryImage from = boundary_image(boundaries, index + lane);
    rho[lane] = in[from.cell];
    m[lane] = from.sign * in[n + from.cell];
    energy[lane] = in[2 * n + from.cell];
  }
  return {Lanes::load(rho), Lanes::load(m), Lanes::load(energy)};
}

enum class TileField : int { rho, m, energy, flux_m, flux_energy, u, enthalpy, slow, fast, count };
static_assert(static_cast<int>(TileField::count) == cell_rows);

/// Scratch memory of a tile: rows of cell values (`TileField`), three rows of face fluxes and, on a device,
/// three rows of U^n. Slot i of a cell row belongs to cell `first - halo + i`. Face f lies left of slot f + 3
/// and depends on slots f .. f + 5.
template <class ExecutionSpace>
class Tile {
 public:
  static constexpr bool on_host = device::is_host<ExecutionSpace>;
  /// True if U^n stays in scratch. On a host it would exceed the L1 cache, and main memory is cached.
  static constexpr bool keeps_start = !on_host;
  static constexpr int rows = keeps_start ? device_rows : cell_rows + flux_rows;

  std::int64_t first;  ///< first cell
  int cells;           ///< cells that the tile updates
  int halo;
  int slots;  ///< cells with the halo on both sides
  bool last;

  /// With `used_rows` = `cell_rows` the tile has no rows for fluxes.
  template <class Member>
  KOKKOS_FUNCTION Tile(const Member& member, const TileShape& shape, std::int64_t mesh_cells,
                       int used_rows = rows)
      : first(static_cast<std::int64_t>(member.league_rank()) * shape.cells),
        cells(static_cast<int>(device::minimum<std::int64_t>(shape.cells, mesh_cells - first))),
        halo(shape.halo),
        slots(cells + 2 * halo),
        last(first + cells == mesh_cells),
        _stride(shape.stride),
        _data(static_cast<double*>(
            member.team_scratch(0).get_shmem_aligned(scratch_bytes(shape, used_rows), alignof(double)))) {}

  KOKKOS_FUNCTION std::int64_t cell(int slot) const { return first - halo + slot; }

  static KOKKOS_FUNCTION std::size_t scratch_bytes(const TileShape& shape, int used_rows = rows) {
    return sizeof(double) * static_cast<std::size_t>(used_rows) * static_cast<std::size_t>(shape.stride);
  }

  template <class P>
  KOKKOS_FUNCTION P load(TileField field, int i) const {
    return device::Access<P>::load(_data + static_cast<int>(field) * _stride + i);
  }
  template <class P>
  KOKKOS_FUNCTION void store(TileField field, int i, P value) const {
    device::Access<P>::store(_data + static_cast<int>(field) * _stride + i, value);
  }
  template <class P>
  KOKKOS_FUNCTION ConservedVector<P> state(int i) const {
    return {load<P>(TileField::rho, i), load<P>(TileField::m, i), load<P>(TileField::energy, i)};
  }
  template <class P>
  KOKKOS_FUNCTION FaceCell<P> face_cell(int i) const {
    return {.rho = load<P>(TileField::rho, i),
            .m = load<P>(TileField::m, i),
            .energy = load<P>(TileField::energy, i),
            .u = load<P>(TileField::u, i),
            .enthalpy = load<P>(TileField::enthalpy, i)};
  }
  template <class P>
  KOKKOS_FUNCTION ConservedVector<P> flux(int face) const {
    return load_vector<P>(cell_rows, face);
  }
  template <class P>
  KOKKOS_FUNCTION void store_flux(int face, const ConservedVector<P>& value) const {
    store_vector(cell_rows, face, value);
  }
  template <class P>
  KOKKOS_FUNCTION ConservedVector<P> start(int i) const {
    return load_vector<P>(cell_rows + flux_rows, i);
  }
  template <class P>
  KOKKOS_FUNCTION void store_start(int i, const ConservedVector<P>& value) const {
    store_vector(cell_rows + flux_rows, i, value);
  }

 private:
  template <class P>
  KOKKOS_FUNCTION ConservedVector<P> load_vector(int row, int i) const {
    using Lanes = device::Access<P>;
    const double* f = _data + row * _stride + i;
    return {Lanes::load(f), Lanes::load(f + _stride), Lanes::load(f + 2 * _stride)};
  }
  template <class P>
  KOKKOS_FUNCTION void store_vector(int row, int i, const ConservedVector<P>& value) const {
    using Lanes = device::Access<P>;
    double* f = _data + row * _stride + i;
    Lanes::store(f, value.rho);
    Lanes::store(f + _stride, value.m);
    Lanes::store(f + 2 * _stride, value.energy);
  }

  int _stride;
  double* _data;
};

}  // namespace drogue::gas
