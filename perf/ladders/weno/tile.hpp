#pragma once

#include <Kokkos_Core.hpp>

#include "kernels/device/memory.hpp"
#include "kernels/gas/flux/euler.hpp"
#include "kernels/gas/flux/face_flux.hpp"
#include "perf/ladders/weno/tile_shape.hpp"

namespace drogue::perf::ladder {

using gas::CellState;
using gas::ConservedVector;

/// Cells of a tile and their ghosts in scratch memory (shared memory on a GPU), and room for its fluxes.
class CellTile {
 public:
  /// Rows of cell values, and of fluxes; bytes of all rows.
  static constexpr int cell_rows = 7, rows = cell_rows + 3;
  static constexpr std::size_t bytes = sizeof(double) * rows * tile_stride + 16;

  template <class Member>
  KOKKOS_FUNCTION explicit CellTile(const Member& member)
      : first(static_cast<std::int64_t>(member.league_rank()) * tile_cells),
        _data(static_cast<double*>(
            member.team_scratch(0).get_shmem_aligned(sizeof(double) * rows * tile_stride, 8))) {}

  std::int64_t first;  ///< first cell that the team updates

  /// Cell of a slot; face f lies between slots f + 2 and f + 3.
  template <class R>
  KOKKOS_FUNCTION CellState<R> cell(int slot) const {
    return {.rho = row<R>(0, slot),
            .m = row<R>(1, slot),
            .energy = row<R>(2, slot),
            .u = row<R>(3, slot),
            .p = row<R>(4, slot),
            .enthalpy = row<R>(5, slot),
            .c = row<R>(6, slot)};
  }
  template <class R>
  KOKKOS_FUNCTION void store_cell(int slot, const CellState<R>& s) const {
    const R values[cell_rows] = {s.rho, s.m, s.energy, s.u, s.p, s.enthalpy, s.c};
    for (int k = 0; k < cell_rows; ++k) store(k, slot, values[k]);
  }
  template <class R>
  KOKKOS_FUNCTION ConservedVector<R> flux(int face) const {
    return {row<R>(cell_rows, face), row<R>(cell_rows + 1, face), row<R>(cell_rows + 2, face)};
  }
  template <class R>
  KOKKOS_FUNCTION void store_flux(int face, const ConservedVector<R>& f) const {
    store(cell_rows, face, f.rho), store(cell_rows + 1, face, f.m), store(cell_rows + 2, face, f.energy);
  }

 private:
  template <class R>
  KOKKOS_FUNCTION R row(int k, int slot) const {
    return device::Access<R>::load(_data + k * tile_stride + slot);
  }
  template <class R>
  KOKKOS_FUNCTION void store(int k, int slot, const R& value) const {
    device::Access<R>::store(_data + k * tile_stride + slot, value);
  }

  double* _data;
};

/// Conserved fields of a state, shape (cells, 3), each field contiguous; SI units.
template <class ExecutionSpace>
using Fields = Kokkos::View<double* [3], Kokkos::LayoutLeft, typename ExecutionSpace::memory_space>;

/// Values of `lanes` cells from `cell` on in a row of `cells` values; beyond the ends those of the last cell.
template <class R>
KOKKOS_FUNCTION R load_cell(const double* row, std::int64_t cells, std::int64_t cell) {
  constexpr int lanes = device::Access<R>::lanes;
  double values[lanes];
  for (int lane = 0; lane < lanes; ++lane) {
    const std::int64_t i = cell + lane;
    values[lane] = row[i < 0 ? 0 : i < cells ? i : cells - 1];
  }
  return device::Access<R>::load(values);
}

/// Loads the cells of a tile and computes their states by `Flux::cell`. Ends with a barrier.
template <class Flux, class R, class Member>
KOKKOS_FUNCTION void load_tile(const Member& member, const CellTile& tile, const double* state,
                               std::int64_t cells, double gamma) {
  constexpr int lanes = device::Access<R>::lanes;
  for (int slot = member.team_rank() * lanes; slot < tile_slots; slot += member.team_size() * lanes) {
    const std::int64_t cell = tile.first - tile_ghosts + slot;
    const ConservedVector<R> u{load_cell<R>(state, cells, cell), load_cell<R>(state + cells, cells, cell),
                               load_cell<R>(state + 2 * cells, cells, cell)};
    tile.store_cell(slot, Flux::template cell<R>(gamma, u));
  }
  member.team_barrier();
}

/// Calls `use(face, flux)` for the faces of a tile, with fluxes by `Flux::face` from six cells each.
template <class Flux, class R, class Member, class Use>
KOKKOS_FUNCTION void for_tile_faces(const Member& member, const CellTile& tile, double gamma,
                                    const Use& use) {
  constexpr int lanes = device::Access<R>::lanes;
  for (int face = member.team_rank() * lanes; face <= tile_cells; face += member.team_size() * lanes) {
    CellState<R> cells[6];
    for (int k = 0; k < 6; ++k) cells[k] = tile.cell<R>(face + k);
    use(face, Flux::template face<R>(gamma, cells));
  }
}

/// Launches a team per tile. Asynchronous. `Bounds`: launch bounds.
template <class Bounds = Kokkos::LaunchBounds<>, class ExecutionSpace, class Functor>
void launch_tiles(const ExecutionSpace& space, const char* label, std::int64_t cells,
                  const Functor& functor) {
  Kokkos::TeamPolicy<ExecutionSpace, Bounds> policy(space, static_cast<int>(cells / tile_cells),
                                                    device::is_host<ExecutionSpace> ? 1 : tile_threads);
  policy.set_scratch_size(0, Kokkos::PerTeam(static_cast<int>(CellTile::bytes)));
  Kokkos::parallel_for(label, policy, functor);
}

}  // namespace drogue::perf::ladder
