#pragma once

#include "kernels/options/grid/domain.hpp"

namespace drogue::options {

/// The nodes x_i = (i - strike) h, i = 0 .. mesh, of ln(spot/strike). `strike` is even, so that every other
/// node makes the coarser grid; a pack's members may have it at different nodes.
template <class R>
struct Grid {
  int mesh;
  R h;
  R strike;  ///< index of the node x = 0
};

/// The widest steps that reach as far as `domain`.
template <class R>
KOKKOS_INLINE_FUNCTION Grid<R> grid_of(const Domain<R>& domain, int mesh) {
  const R wished = (0.5 * mesh) * domain.below / (domain.below + domain.above);
  const R whole = (wished + rounding_shift) - rounding_shift;
  const R pairs = device::maximum(device::minimum(whole, R(0.5 * mesh - 2.0)), R(1.0));
  const R strike = 2.0 * pairs;
  return {mesh, device::maximum(domain.below / strike, domain.above / (double(mesh) - strike)), strike};
}

/// The mesh of a kernel that may be compiled for a fixed one, which a compiler may unroll loops for; 0: none.
template <int fixed>
KOKKOS_INLINE_FUNCTION constexpr int mesh_for(int mesh) {
  return fixed > 0 ? fixed : mesh;
}

/// Every other node.
template <class R>
KOKKOS_INLINE_FUNCTION Grid<R> coarser(const Grid<R>& grid) {
  return {grid.mesh / 2, 2.0 * grid.h, 0.5 * grid.strike};
}

/// The lanes that an option on a mesh has, so that each of them has eight nodes or four. Two options of 16
/// lanes share a warp.
KOKKOS_INLINE_FUNCTION constexpr int lanes_of(int mesh) {
  return mesh == 64 || mesh == 128 ? 16 : most_lanes;
}

/// Whether lanes, so many an option, keep the spectrum of its jumps in registers: where two options share a
/// warp shared memory has no room for it, and else registers have none.
KOKKOS_INLINE_FUNCTION constexpr bool keeps_spectrum(int lanes) { return lanes < most_lanes; }

/// Whether the sum over jumps of a mesh goes through Fourier transforms, which are the faster where every
/// lane has work in them.
KOKKOS_INLINE_FUNCTION constexpr bool is_transformed(int mesh, int lanes) {
  return mesh >= 128 && mesh >= 8 * lanes && (mesh & (mesh - 1)) == 0;
}

/// Place of number i of a transform: numbers that lanes read or write at once then are in different banks of
/// shared memory, whatever power of two lies between them, and do not meet in a cache.
KOKKOS_INLINE_FUNCTION constexpr int padded(int i) { return i + i / 8; }

/// Blocks of nodes that lanes own, and the length of an array that holds them all and whole octets of nodes,
/// two of which hold a transform.
KOKKOS_INLINE_FUNCTION int block_of(int mesh, int lanes) { return (mesh + lanes - 1) / lanes; }
KOKKOS_INLINE_FUNCTION int node_count(int mesh) {
  const int owned = block_of(mesh, most_lanes) * most_lanes, octets = (mesh + 7) / 8 * 8 + 8;
  if (is_transformed(mesh, 1)) return padded(mesh);
  return owned > octets ? owned : octets;
}

/// Where the weight of a jump by d nodes, |d| <= mesh + 7, lies. On CUDA a warp reads every eighth of them at
/// once: these are neighbours there, so that no two are in one bank.
template <class R>
struct WeightLayout {
  static constexpr bool interleaved = device::Access<R>::lanes == 1;
  int centre, stride;

  KOKKOS_INLINE_FUNCTION constexpr explicit WeightLayout(int mesh)
      : centre(mesh / 8 * 8 + 16), stride((2 * centre + 8) / 8 + 1) {}
  [[nodiscard]] KOKKOS_INLINE_FUNCTION int size() const { return 8 * stride; }
  [[nodiscard]] KOKKOS_INLINE_FUNCTION int place(int d) const {
    const int e = centre + d;
    return interleaved ? (e % 8) * stride + e / 8 : e;
  }
};

/// Angles at which the jumps' symbol is known.
inline constexpr int symbols = 16;

/// The puts' jumps on their grid: the weights w_d = h g(d h) of jumps by d nodes (half of it for d = +-1),
/// what goes beyond the grid, and what of the variance and of the drift is left for differences.
template <class R>
struct Jumps {
  R* w;           ///< in the order of a WeightLayout; 0 for d = 0 and |d| > mesh
  R* left;        ///< (node_count): mass of the jumps from a node to below the grid, a year
  R* left_price;  ///< (node_count): the same of e^{x + y}
  R rate;         ///< mass of all jumps, a year
  R diffusion;    ///< D, so that D, the weights and the tails have the variance of the law
  R drift;        ///< b, so that the scheme prices e^x without an error
  R excess;       ///< variance a year that they have beyond the law's, which no D can take back
  R* symbol;      ///< (symbols): sum of w_d (1 - cos(d angle)) at the angles pi 2^{-k/2}
};

}  // namespace drogue::options
