#pragma once

#include "kernels/options/march.hpp"

namespace drogue::options {

/// What the stated error is made of, beside what interpolation and the grid's ends leave.
template <class R>
struct Doubt {
  R factor;  ///< of the largest difference of two grids near the spot
  R gap;     ///< what that difference does not tell at all, of the strike
};

/// What the largest |V(fine) - V(coarse)| near the spot is multiplied by for the error of their
/// extrapolation, which is of an order between two, at kinks, and three: docs/options.md tells how often it
/// is below what is stated. The largest near the spot and not that at it, which changes sign somewhere. The
/// part that time leaves falls with the steps and so with the mesh, that of space with the steps h in which
/// differences that spread the payoff by `spread`, 2 D T, go through it; all with prefactors that are fitted
/// to European prices.
///
/// A kink that hardly spreads, of short times or of pure jumps, leaves an order far below two: the difference
/// counts 1 + 2.6 (1 - phi)^2 (h^2/spread)^{3/4} times, phi = spread/(spread + h^2).
template <class R>
KOKKOS_INLINE_FUNCTION R error_factor(R h, int mesh, R spread) {
  const double finer = mesh <= 128 ? 1.0 : 128.0 / mesh;
  const double in_time = 0.22 * Kokkos::sqrt(finer * Kokkos::sqrt(finer));
  const R wide = 25.0 * h * h, in_space = 0.18 * (wide / device::maximum(spread, wide));
  const R sharp = h * h / (spread + h * h), bare = h * h / device::maximum(spread, h * h * (1.0 / 500));
  const R kink = 1.0 + 2.6 * sharp * sharp * device::square_root(bare * device::square_root(bare));
  return device::maximum(R(in_time), in_space) * kink;
}

/// The same beside the boundary of exercise, between which and the nodes neither grid knows: as far as it
/// lies on a node the errors of the grids do not follow from one another. Fitted to American prices of finer
/// grids.
KOKKOS_INLINE_FUNCTION double boundary_factor(const Put& put, double boundary, double h) {
  if (put.split || !(boundary == boundary)) return 0.0;
  const double away = device::portable::magnitude(put.log_spot - boundary), beside = 1.5 * h;
  return away > beside ? 0.42 * beside / away : 0.42;
}

/// Of a solve on a mesh of steps h whose differences spread the payoff by `spread`.
///
/// A step that does not resolve e^x misses h^4/20.
///
/// Generalized hyperbolic jumps that are shorter than a step have their variance on the grid but not their
/// skewness. Of the integral of y^2 e^{-p y} the nodes, with half the first one, sum the part x^3 (q (1 +
/// q)/(1 - q)^3 - q/2)/2, x = p h, q = e^{-x}; p is 1.8 times the least decay, since a mixture has faster
/// ones. The rest, squared since an extrapolation sees what is little, times the third cumulant over the
/// variance and V_xxx/6, of which far from the strike there is little.
///
/// Exercise that is split off is of first order in time, and extrapolation for the second leaves 2/3 of the
/// difference where it decides and less elsewhere: twice as much counts, and more on finer meshes, where
/// `error_factor` expects the difference to tell more.
template <class R>
KOKKOS_INLINE_FUNCTION Doubt<R> doubt_of(const PutPack<R>& put, R h, int mesh, R spread) {
  const R resolved = device::minimum(h, R(2.0)), squared = resolved * resolved;
  Doubt<R> doubt{error_factor(h, mesh, spread), 0.05 * squared * squared};
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
    const R more = 2.0 * device::square_root(device::square_root(R(finer)));
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
