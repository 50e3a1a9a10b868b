#pragma once

#include "kernels/gas/limiter.hpp"
#include "kernels/gas/tile_update.hpp"

namespace drogue::gas {

/// Where the limiter leaves word of itself.
struct LimiterMarks {
  std::uint8_t* touched;  ///< of every cell of the mesh: whether it lies beside a limited face
  std::int64_t cells;     ///< of the mesh
  std::int64_t* touches;  ///< faces limited
};

/// The slow path of `limit_fluxes`. A face between two tiles is computed by both; the right one counts it.
template <class R, class Tile>
KOKKOS_INLINE_FUNCTION void limit_faces(const Tile& tile, int face, int last, const Triple<R>& left,
                                        const Triple<R>& right, const Triple<R>& high, double two_lambda,
                                        double gamma, const LimiterMarks& marks) {
  using Lanes = device::Access<R>;
  const auto load = [&](TileField field, int side) { return tile.template load<R>(field, face + side); };
  const auto fastest = [&](int side) {
    return device::maximum(load(TileField::slow, side), load(TileField::fast, side));
  };
  const Triple<R> low = lax_friedrichs(left, load(TileField::flux_m, 2), load(TileField::flux_energy, 2),
                                       right, load(TileField::flux_m, 3), load(TileField::flux_energy, 3),
                                       device::maximum(fastest(2), fastest(3)));
  const LimitedFlux<R> limited = limit(left, right, high, low, two_lambda, gamma);
  tile.store_flux(face, limited.flux);
  for (int lane = 0; lane < Lanes::lanes; ++lane) {
    const std::int64_t cell = tile.cell(face + lane + ghost_cells);  // right of the face
    const std::int64_t in_tile = cell - tile.first;
    if (face + lane > last || !(Lanes::lane(limited.theta, lane) < 1.0)) continue;
    if (in_tile < 0 || in_tile > tile.cells || (in_tile == tile.cells && !tile.last)) continue;
    Kokkos::atomic_inc(marks.touches);
    if (cell > 0) marks.touched[cell - 1] = 1;
    if (cell < marks.cells) marks.touched[cell] = 1;
  }
}

/// Limits the fluxes of the faces `first` to `last` of a tile, which all threads have stored. The first-order
/// flux has the alpha of the two cells beside the face: no signal of theirs is faster, so the guarantee is
/// that of the mesh's alpha, with less dissipation and without asking the rest of the mesh.
template <class R, class Member, class Tile>
KOKKOS_INLINE_FUNCTION void limit_fluxes(const Member& member, const Tile& tile, int first, int last,
                                         double two_lambda, double gamma, const LimiterMarks& marks) {
  constexpr int lanes = device::Access<R>::lanes;
  for (int face = first + member.team_rank() * lanes; face <= last; face += member.team_size() * lanes) {
    const Triple<R> left = tile.template state<R>(face + 2), right = tile.template state<R>(face + 3),
                    flux = tile.template flux<R>(face);
    if (!device::all(is_harmless(left, right, flux, two_lambda, gamma)))
      limit_faces(tile, face, last, left, right, flux, two_lambda, gamma, marks);
  }
}

}  // namespace drogue::gas
