#pragma once

#include "kernels/gas/flux/limiter.hpp"
#include "kernels/gas/tile/tile_update.hpp"

namespace drogue::gas {

/// Output of the limiter.
struct LimiterCounters {
  std::uint8_t* limited_cells;  ///< one flag per cell of the mesh: 1 if it lies beside a limited face
  std::int64_t cells;           ///< cells of the mesh
  std::int64_t* limited_faces;  ///< counter of limited faces
};

/// Slow path of `limit_fluxes` for one pack of faces. Two neighbouring tiles compute their common face; the
/// right one counts it.
template <class R, class Tile>
KOKKOS_INLINE_FUNCTION void limit_face_pack(const Tile& tile, int face, int last,
                                            const ConservedVector<R>& left, const ConservedVector<R>& right,
                                            const ConservedVector<R>& high, double two_lambda, double gamma,
                                            const LimiterCounters& counters) {
  using Lanes = device::Access<R>;
  const auto load = [&](TileField field, int side) { return tile.template load<R>(field, face + side); };
  const auto fastest = [&](int side) {
    return device::maximum(load(TileField::slow, side), load(TileField::fast, side));
  };
  const ConservedVector<R> low = lax_friedrichs(
      left, load(TileField::flux_m, 2), load(TileField::flux_energy, 2), right, load(TileField::flux_m, 3),
      load(TileField::flux_energy, 3), device::maximum(fastest(2), fastest(3)));
  const LimitedFlux<R> limited = limit(left, right, high, low, two_lambda, gamma);
  tile.store_flux(face, limited.flux);
  for (int lane = 0; lane < Lanes::lanes; ++lane) {
    const std::int64_t cell = tile.cell(face + lane + ghost_cells);  // right of the face
    const std::int64_t in_tile = cell - tile.first;
    if (face + lane > last || !(Lanes::lane(limited.theta, lane) < 1.0)) continue;
    if (in_tile < 0 || in_tile > tile.cells || (in_tile == tile.cells && !tile.last)) continue;
    Kokkos::atomic_inc(counters.limited_faces);
    if (cell > 0) counters.limited_cells[cell - 1] = 1;
    if (cell < counters.cells) counters.limited_cells[cell] = 1;
  }
}

/// Limits the stored fluxes of the faces `first` to `last` of a tile. All threads must have stored their
/// fluxes before. The first-order flux uses the alpha of the two cells beside the face, which bounds their
/// wave speeds. The guarantee therefore equals the one with the mesh-wide alpha, with less dissipation and no
/// reduction over the mesh.
template <class R, class Member, class Tile>
KOKKOS_INLINE_FUNCTION void limit_fluxes(const Member& member, const Tile& tile, int first, int last,
                                         double two_lambda, double gamma, const LimiterCounters& counters) {
  constexpr int lanes = device::Access<R>::lanes;
  for (int face = first + member.team_rank() * lanes; face <= last; face += member.team_size() * lanes) {
    const ConservedVector<R> left = tile.template state<R>(face + 2),
                             right = tile.template state<R>(face + 3), flux = tile.template flux<R>(face);
    if (!device::all(keeps_positive(left, right, flux, two_lambda, gamma)))
      limit_face_pack(tile, face, last, left, right, flux, two_lambda, gamma, counters);
  }
}

}  // namespace drogue::gas
