#pragma once

#include "kernels/options/grid/domain.hpp"

namespace drogue::options {

/// Nodes x_i = (i - strike) h, i = 0 .. mesh, of ln(spot/strike). `strike` is even, so that every second node
/// belongs to the coarser grid. The members of a pack may have different `strike` indices.
template <class R>
struct Grid {
  int mesh;
  R h;
  R strike;  ///< index of the node x = 0
};

/// Grid of `mesh` intervals with the smallest step that covers `domain`.
template <class R>
KOKKOS_INLINE_FUNCTION Grid<R> grid_of(const Domain<R>& domain, int mesh) {
  const R wished = (0.5 * mesh) * domain.below / (domain.below + domain.above);
  const R whole = (wished + rounding_shift) - rounding_shift;
  const R pairs = device::maximum(device::minimum(whole, R(0.5 * mesh - 2.0)), R(1.0));
  const R strike = 2.0 * pairs;
  return {mesh, device::maximum(domain.below / strike, domain.above / (double(mesh) - strike)), strike};
}

/// Number of intervals as a compile-time constant if `fixed` > 0, so that loops can be unrolled; `mesh`
/// otherwise.
template <int fixed>
KOKKOS_INLINE_FUNCTION constexpr int mesh_for(int mesh) {
  return fixed > 0 ? fixed : mesh;
}

/// Grid of every second node.
template <class R>
KOKKOS_INLINE_FUNCTION Grid<R> coarser(const Grid<R>& grid) {
  return {grid.mesh / 2, 2.0 * grid.h, 0.5 * grid.strike};
}

/// Lanes per option on a mesh, so that each lane owns eight or four nodes. Two options of 16 lanes share a
/// warp.
KOKKOS_INLINE_FUNCTION constexpr int lanes_of(int mesh) { return mesh == 64 || mesh == 128 ? 16 : max_lanes; }

/// Whether lanes keep the spectrum of the jumps in registers. With two options in a warp shared memory is too
/// small for it; with one option there are too few registers.
KOKKOS_INLINE_FUNCTION constexpr bool keeps_spectrum(int lanes) { return lanes < max_lanes; }

/// Whether the sum over jumps uses Fourier transforms, which are faster if every lane has work in each pass.
KOKKOS_INLINE_FUNCTION constexpr bool is_transformed(int mesh, int lanes) {
  return mesh >= 128 && mesh >= 8 * lanes && (mesh & (mesh - 1)) == 0;
}

/// Padded index of element i of a transform. It avoids bank conflicts in shared memory and cache conflicts
/// for any power-of-two stride.
KOKKOS_INLINE_FUNCTION constexpr int padded(int i) { return i + i / 8; }

/// Nodes per lane (`block_of`), and length of a node array (`node_count`). The length covers all lanes and
/// whole octets of nodes; two arrays hold one transform.
KOKKOS_INLINE_FUNCTION int block_of(int mesh, int lanes) { return (mesh + lanes - 1) / lanes; }
KOKKOS_INLINE_FUNCTION int node_count(int mesh) {
  const int owned = block_of(mesh, max_lanes) * max_lanes, octets = (mesh + 7) / 8 * 8 + 8;
  if (is_transformed(mesh, 1)) return padded(mesh);
  return owned > octets ? owned : octets;
}

/// Storage order of the weights of jumps by d nodes, |d| <= mesh + 7. On CUDA a warp reads every eighth
/// weight at once; these are adjacent, which avoids bank conflicts.
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

/// Number of angles at which the symbol of the jumps is evaluated.
inline constexpr int symbol_count = 16;

/// Discretized jumps on a grid: weights w_d = h g(d h) of jumps by d nodes (for d = +-1 half of it, less what
/// is `moved`), the mass that leaves the grid, and the remaining variance and drift for finite differences.
template <class R>
struct Jumps {
  R* w;           ///< in the order of a WeightLayout; 0 for d = 0 and |d| > mesh
  R* exit_mass;   ///< (node_count): rate of jumps from a node to below the grid, per year
  R* exit_price;  ///< (node_count): the same integral of e^{x + y}, per year
  R rate;         ///< rate of all jumps, per year
  R diffusion;  ///< D: with D, weights and tails have the variance of the Levy measure and the Brownian part
  R moved;      ///< part of D that comes from the weights of d = +-1 (`discretize_jumps`)
  R drift;      ///< b: makes the scheme exact for e^x
  R excess_variance;  ///< variance of weights and tails in excess of the exact one, per year; D cannot be
                      ///< negative
  R* symbol;          ///< (symbol_count): sum of w_d (1 - cos(d angle)) at the angles pi 2^{-k/2}
};

}  // namespace drogue::options
