#pragma once

#include "kernels/options/march.hpp"

namespace drogue::options {

/// What the difference of two grids does not show of an error.
template <class R>
struct Doubt {
  R factor;  ///< by which that difference tells too little
  R gap;     ///< what it does not tell at all, of the strike
};

/// Of a solve on a mesh of steps h whose differences spread the payoff by `spread`, 2 D T.
///
/// A kink that hardly spreads, of pure jumps in a short time, leaves an order far below two: with phi =
/// spread/(spread + h^2) the factor has 90 (1 - phi)^4. Jumps of Merton's that are alike within a step stand
/// on a node beside their place. A step that does not resolve e^x misses h^4/20.
///
/// Generalized hyperbolic jumps that are shorter than a step have their variance on the grid but not their
/// skewness. Of the integral of y^2 e^{-p y} the nodes, with half the first one, sum the part x^3 (q (1 +
/// q)/(1 - q)^3 - q/2)/2, x = p h, q = e^{-x}; p is 1.8 times the least decay, since a mixture has faster
/// ones. The rest, squared since an extrapolation sees what is little, times the third cumulant over the
/// variance and V_xxx/6, of which far from the strike there is little.
///
/// Exercise that is split off is of first order in time, and extrapolation for the second leaves 2/3 of the
/// difference where it decides and less elsewhere: 1.8 times more counts, and more on finer meshes, where
/// `error_factor` expects the difference to tell more.
template <class R>
KOKKOS_INLINE_FUNCTION Doubt<R> doubt_of(const PutPack<R>& put, R h, int mesh, R spread) {
  const R sharp = h * h / (spread + h * h), square = sharp * sharp;
  const R resolved = device::minimum(h, R(2.0)), squared = resolved * resolved;
  Doubt<R> doubt{1.0 + 90.0 * square * square, 0.05 * squared * squared};
  if (put.model == Model::merton) {
    const R alike = device::maximum(R(0.0), 1.0 - merton_deviation(put) / h);
    doubt.factor += device::select(put.jump[0] > R(0.0), 30.0 * alike, R(0.0));
  }
  if (put.model == Model::generalized_hyperbolic) {
    const R tilt = device::absolute(put.jump[2]);
    const R decay = put.jump[1] - tilt, slow = device::reciprocal(decay),
            fast = device::reciprocal(put.jump[1] + tilt);
    const R x = device::maximum(1.8 * h * decay, R(0.01)), q = exponential(-x);
    const R part = x * device::reciprocal(1.0 - q);
    const R summed = 0.5 * q * ((1.0 + q) * part * part * part - 0.5 * x * x * x);
    const R missed = device::maximum(R(0.0), 1.0 - summed);
    const R skew =
        2.0 * (slow * slow * slow - fast * fast * fast) * device::reciprocal(slow * slow + fast * fast);
    const R away = 0.125 * put.log_spot, near = spread * device::reciprocal(spread + away * away + R(1e-100));
    doubt.gap += 0.04 * near * skew * missed * missed;
  }
  if (put.any_split) {
    const double finer = mesh <= 128 ? 1.0 : mesh / 128.0;
    const R more = 1.8 * device::square_root(device::square_root(R(finer)));
    doubt.factor = doubt.factor * device::select(put.split > R(0.0), more, R(1.0));
  }
  return doubt;
}

/// What is added to diffusion and taken back from the values before leaves an error of
/// added h^2 dt^2 V_xxtt, which may hide behind that of space in the difference of two grids: dt is the last
/// step, 1.5 T/steps, V_xx at most 0.4/sqrt(v T), and the number in front is fitted to European prices.
template <class R>
KOKKOS_INLINE_FUNCTION R doubt_of_stiff_jumps(const PutPack<R>& put, const Law<R>& law, const Jumps<R>& jumps,
                                              const Scheme<R>& scheme, R h) {
  const R dt = step_length(put.maturity, scheme.steps, scheme.steps).dt;
  const R added = added_diffusion(put, jumps, 0.5 * (scheme.lower + scheme.upper), dt);
  const R variance = device::maximum(put.variance + law.variance, R(1e-100));
  const R wide = added * h * h * device::reciprocal(double(scheme.steps) * scheme.steps);
  return 0.6 * wide * device::square_root(put.maturity * device::reciprocal(variance));
}

}  // namespace drogue::options
