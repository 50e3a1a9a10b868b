#pragma once

#include "kernels/gas/tile/sliding_stencil.hpp"

namespace drogue::gas {

/// Chunk of faces of a host tile. Short loops first compute the data that neighbouring faces share
/// (differences, maximum wave speeds) and the slow operations (square roots and divisions of the
/// eigensystems), so that several of these overlap. The long loop over the corrections then waits for none of
/// them. Lanes beyond the last face hold stale values, and their fluxes are never read. A host team has one
/// thread.
template <class N, class R>
class FaceChunk {
 public:
  static constexpr int lanes = device::Access<R>::lanes;
  static constexpr int faces = 32;  ///< capacity

  /// Loads the faces `first` to `last` of the tile, both included.
  template <class Tile>
  KOKKOS_FUNCTION void load(const Tile& tile, int first, int last, FaceAverage average, double gamma) {
    const auto absolute = [&](TileField field, int i) {
      return device::absolute(tile.template load<R>(field, i));
    };
    for (int i = 0; first + i <= last + 4; i += lanes)
      for (int row = 0; row < 5; ++row) {
        const R left = tile.template load<R>(differing(row), first + i);
        Lanes::store(_difference[row] + i, tile.template load<R>(differing(row), first + i + 1) - left);
      }
    for (int i = 0; first + i <= last + 3; i += lanes)
      for (int row = 0; row < 3; ++row) {
        const R right =
            device::maximum(absolute(signal(row), first + i + 1), absolute(signal(row), first + i + 2));
        Lanes::store(_fastest[row] + i, device::maximum(absolute(signal(row), first + i), right));
      }
    for (int i = 0; first + i <= last; i += lanes)
      _eigensystem[i / lanes] =
          face_eigensystem<N, R>(average, gamma, tile.template face_cell<R>(first + i + 2),
                                 tile.template face_cell<R>(first + i + 3));
  }

  /// Stencil of the faces from the `i`-th on, equal to `load_stencil`.
  template <class Tile>
  [[nodiscard]] KOKKOS_FUNCTION Stencil<R> stencil(const Tile& tile, int face, int i) const {
    Stencil<R> s;
    const auto difference = [&](int row, int k) { return Lanes::load(_difference[row] + i + k); };
    for (int k = 0; k < 5; ++k) {
      s.d_state[k] = {difference(0, k), difference(1, k), difference(2, k)};
      s.d_flux_m[k] = difference(3, k);
      s.d_flux_energy[k] = difference(4, k);
    }
    s.flux_sum = flux_sum<R>(tile, face);
    return s;
  }

  /// Maximum wave speeds of the stencil, equal to `stencil_wave_speeds`.
  [[nodiscard]] KOKKOS_FUNCTION WaveSpeeds<N> wave_speeds(int i) const {
    const auto fastest = [&](int row) {
      return device::Convert<N>::from(
          device::maximum(Lanes::load(_fastest[row] + i), Lanes::load(_fastest[row] + i + 3)));
    };
    return {fastest(0), fastest(1), fastest(2)};
  }

  [[nodiscard]] KOKKOS_FUNCTION const Eigensystem<N>& eigensystem(int i) const {
    return _eigensystem[i / lanes];
  }

 private:
  using Lanes = device::Access<R>;

  // These are functions because nvcc does not accept static constexpr arrays of a class in device code.
  /// Tile row of the `row`-th difference of the flux.
  KOKKOS_FUNCTION static constexpr TileField differing(int row) { return static_cast<TileField>(row); }
  KOKKOS_FUNCTION static constexpr TileField signal(int row) {
    return row == 0 ? TileField::slow : row == 1 ? TileField::u : TileField::fast;
  }

  static constexpr int slots = faces + 4 + lanes;

  double _difference[5][slots];  ///< of slots first + i + 1 and first + i
  double _fastest[3][slots];     ///< over slots first + i .. first + i + 2
  Eigensystem<N> _eigensystem[faces / lanes];
};

/// Calls `store(face, flux)` for the faces `first` to `last` of a tile, `lanes` faces per call. Alpha is
/// taken over the stencil if `local`, otherwise it is `alpha`. The assignment of faces to threads is
/// unspecified.
template <Reconstruction scheme, class N, class R, class Member, class Tile, class Store>
KOKKOS_INLINE_FUNCTION void for_face_fluxes(const Member& member, const Tile& tile, int first, int last,
                                            FaceAverage average, double gamma, bool local,
                                            const WaveSpeeds<N>& alpha, const Store& store) {
  constexpr int lanes = device::Access<R>::lanes;
  if constexpr (Tile::on_host) {
    using Chunk = FaceChunk<N, R>;
    Chunk chunk;
    for (int begin = first; begin <= last; begin += Chunk::faces) {
      const int end = device::minimum(last, begin + Chunk::faces - 1);
      chunk.load(tile, begin, end, average, gamma);
      for (int i = 0; begin + i <= end; i += lanes)
        store(begin + i, weno5_face<scheme, N>(chunk.stencil(tile, begin + i, i), chunk.eigensystem(i),
                                               local ? chunk.wave_speeds(i) : alpha));
    }
  } else if constexpr (!std::is_same_v<N, R>) {
    const int run = (last - first + member.team_size()) / member.team_size();
    for (int begin = first + member.team_rank() * run; begin <= last; begin += member.team_size() * run) {
      SlidingStencil<N, Tile> window(tile, begin);
      for (int face = begin; face < begin + run && face <= last; ++face) {
        window.advance();
        store(face, weno5_face<scheme, N>(
                        window,
                        face_eigensystem<N, R>(average, gamma, tile.template face_cell<R>(face + 2),
                                               tile.template face_cell<R>(face + 3)),
                        local ? window.wave_speeds() : alpha));
      }
    }
  } else {
    for (int face = first + member.team_rank() * lanes; face <= last; face += member.team_size() * lanes)
      store(face, face_flux<scheme, N>(tile, face, load_stencil<R>(tile, face), average, gamma,
                                       local ? stencil_wave_speeds<N, R>(tile, face) : alpha));
  }
}

}  // namespace drogue::gas
