#pragma once

#include "kernels/options/law.hpp"

namespace drogue::options {

/// What the difference of two grids does not show of an error.
template <class R>
struct Doubt {
  R factor;  ///< by which that difference tells too little
  R gap;     ///< what it does not tell at all, of the strike
};

/// Of a solve with the step h whose differences spread the payoff by `spread`, 2 D T.
///
/// A kink that hardly spreads, of pure jumps in a short time, leaves an order far below two: with phi =
/// spread/(spread + h^2) the factor has 90 (1 - phi)^4. Jumps of Merton's that are alike within a step stand
/// on a node beside their place. A step that does not resolve e^x misses h^4/20.
template <class R>
KOKKOS_INLINE_FUNCTION Doubt<R> doubt_of(const PutPack<R>& put, R h, R spread) {
  const R sharp = h * h / (spread + h * h), square = sharp * sharp;
  const R resolved = device::minimum(h, R(2.0)), squared = resolved * resolved;
  Doubt<R> doubt{1.0 + 90.0 * square * square, 0.05 * squared * squared};
  if (put.model == Model::merton) {
    const R alike = device::maximum(R(0.0), 1.0 - merton_deviation(put) / h);
    doubt.factor += device::select(put.jump[0] > R(0.0), 30.0 * alike, R(0.0));
  }
  return doubt;
}

}  // namespace drogue::options
