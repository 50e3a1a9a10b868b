#pragma once

#include "kernels/options/pide/solution.hpp"

namespace drogue::options {

/// Coefficients of the error estimate of a solve on two grids, without the errors of interpolation and
/// truncation.
///
/// The numerical constants below are empirical unless a derivation is given. They were calibrated on random
/// contracts, with maturities from an hour to thirty years, so that the estimate covers 95 % of the rows of
/// each kind. The references were Fourier prices for European options and finer grids for others.
/// docs/options-error.md lists the constants. `scripts/studies/fit_error_estimate.py` fits those
/// of `error_factor`; how the others were fitted is not preserved. `scripts/studies/measure_coverage.py`
/// measures the coverage on random contracts against such references. The tests `OptionsError` assert nine
/// rows of ten.
template <class R>
struct ErrorEstimate {
  R factor;    ///< of the largest difference of the two grids near the spot
  R offset;    ///< error that is independent of this difference, as a fraction of the strike
  R variance;  ///< of the process, per year
};

/// Factor of a solve that provides no error estimate.
inline constexpr double unreliable_factor = 1e6;

/// Lower bound of the factor for split exercise with an unknown premium. Splitting is of first order in time.
/// Second-order extrapolation then leaves 2/3 of the difference where this error dominates, and less
/// elsewhere. Empirical value: `OptionsSurface.StatedErrorsCoverExerciseBetweenTwoBoundaries` tests it.
inline constexpr double splitting_factor = 0.4;

/// Estimate for member k of a pack without a known early exercise premium.
template <class R>
KOKKOS_INLINE_FUNCTION ErrorEstimate<double> estimate_without_premium(const ErrorEstimate<R>& estimate,
                                                                      const NormalizedPut& put, int k) {
  const double factor = device::Access<R>::lane(estimate.factor, k);
  return {put.split ? device::maximum(factor, splitting_factor) : factor,
          device::Access<R>::lane(estimate.offset, k), device::Access<R>::lane(estimate.variance, k)};
}

/// Error of split exercise with a known early exercise premium, as a fraction of the strike. It is at most a
/// part of the premium that decreases with the steps. On coarse meshes it decreases with the mesh, since
/// nodes resolve the two boundaries to a part of a step in space. The factors are empirical: 94 to 99 % of
/// 800 random contracts were covered (docs/options-notebook.md).
KOKKOS_INLINE_FUNCTION double splitting_error(double premium, int mesh, int steps, double largest) {
  const double resolved = device::minimum(double(steps), 0.25 * mesh);
  return device::minimum(0.5 * device::absolute(premium) / resolved, splitting_factor * largest);
}

/// Ratio of the error of the extrapolated price to the largest |V(fine) - V(coarse)| near the spot. The
/// difference at the spot itself is not used, because it changes sign somewhere. The difference is of second
/// order and the extrapolation error of the next one, so the ratio decreases with the number of resolved
/// steps. In time these are the steps until maturity; a drift over many standard deviations (`drift_ratio` >=
/// 1) leaves a part of them. In space the scale is sqrt(spread), spread = 2 D T, by which finite differences
/// smooth the kink of the payoff: y^{1/2}, y = h^2/spread. A kink that hardly spreads (short maturities, pure
/// jumps) has an order far below two, and the ratio grows faster, as y^{3/4}. 1/steps and y^{1/2} are
/// derived; 0.5, 6.5, 1/500, 0.45, y^{3/4} and the root of `drift_ratio` are empirical. `time_part`: part of
/// 6.5 that counts, 1 or that of `shared_time_part`.
template <class R>
KOKKOS_INLINE_FUNCTION R error_factor(R h, int steps, R spread, R drift_ratio, R time_part) {
  const R in_time = device::minimum(R(0.5), (6.5 / steps) * time_part) * device::square_root(drift_ratio);
  const R y = h * h / device::maximum(spread, h * h * (1.0 / 500)), root = device::square_root(y);
  return device::maximum(in_time, 0.45 * root * device::square_root(device::maximum(root, R(1.0))));
}

/// Weight of the exercise-boundary error at the spot. From two steps on it decreases with the distance, since
/// the boundary moves and lies now above and now below a node. 0 for split exercise, which has its own
/// estimate. The two steps are empirical.
KOKKOS_INLINE_FUNCTION double boundary_weight(const NormalizedPut& put, double boundary, double h) {
  if (put.split || !(boundary == boundary)) return 0.0;
  const double distance = device::portable::magnitude(put.log_spot - boundary), near_distance = 2.0 * h;
  return distance > near_distance ? near_distance / distance : 1.0;
}

/// Lower bound of `boundary_weight` for a boundary that hardly moves for decades. Near the boundary b the
/// time value is B (x - b)^2/2. `time_value_step` and `time_value_rate` yield the time t = 3/4 step/rate in
/// which b moves by half a step. The probability of reaching b from x within t decreases with q = (x -
/// b)^2/(variance t); 1/(1 + q + q^2/2) is an empirical fit, tested by
/// `OptionsError.CoversBoundariesThatHardlyMoveForDecades`.
KOKKOS_INLINE_FUNCTION double standing_boundary_weight(const NormalizedPut& put,
                                                       const SolutionAtSpot& solution, double variance) {
  const double distance = put.log_spot - solution.boundary;
  const double stays = device::maximum(solution.time_value_step * variance, 1e-150),
               moves = (4.0 / 3) * distance * distance * device::maximum(solution.time_value_rate, 0.0);
  return stays * stays / (stays * stays + moves * (stays + 0.5 * moves));
}

/// Error of restricting exercise to nodes, as a fraction of the strike. Both grids resolve the boundary to a
/// part of a step, at different places, so their difference does not contain this error. If the time value is
/// half its second derivative times the squared distance, `time_value_step` is that derivative times h^2. A
/// boundary displaced by 0.31 h changes the value by 0.048 of it; one that moves by a step h while diffusion
/// crosses it, by up to 0.083. Without diffusion the time value has an angle, and the same formula estimates
/// the value of 0.048 h. A boundary that stands keeps its place between nodes: extrapolation leaves 4/3 of
/// the `standing_error` of the fine grid less a third of that of the coarse one. At least the former is
/// stated, since both are known roughly. 0.048 and 0.035 are calibrated on American prices of finer grids,
/// tested by `OptionsCoverage`. Away from the boundary the value bounds the probability of reaching it.
/// `variance`: of the process, per year; `h`: step of the fine grid.
KOKKOS_INLINE_FUNCTION double boundary_error(const SolutionAtSpot& fine, const SolutionAtSpot& coarse,
                                             double variance, double h) {
  const double payoff = 1.0 - exponential(fine.boundary);
  const double stays = device::maximum(0.75 * fine.time_value_step * variance, 1e-150),
               moves = device::maximum(fine.time_value_rate, 0.0) * h * h;
  const double moving = (0.048 + 0.035 * moves / (moves + stays)) * fine.time_value_step;
  const double extrapolated = device::absolute(4.0 * fine.standing_error - coarse.standing_error) * (1.0 / 3);
  return device::maximum(moving, device::maximum(fine.standing_error, extrapolated)) *
         (fine.value < payoff ? fine.value / payoff : 1.0);
}

/// Standard deviations that the drift covers until maturity, at least 1, as used by `error_factor`.
template <class R>
KOKKOS_INLINE_FUNCTION R drift_in_deviations(const PutPack<R>& put, const LevyMeasure<R>& measure) {
  const R variance = device::maximum((put.variance + measure.variance) * put.maturity, R(1e-100));
  // The compensator e^y - 1 - y takes nearly half the variance from the drift, but much more if the mean of
  // Kou's upward jumps hardly exists.
  R compensator = 0.5 * measure.variance;
  if (put.model == JumpModel::merton || put.model == JumpModel::kou)
    compensator = jump_cumulant(put, measure, R(1.0));
  const R drift = (put.rate - put.dividend - 0.5 * put.variance - compensator) * put.maturity;
  return device::maximum(R(1.0), device::absolute(drift) * device::reciprocal(device::square_root(variance)));
}

/// Error of the skewness of Kou's jumps, as a fraction of the strike. Jumps in the cell around 0 have the
/// right variance on the grid, but no skewness. The error is the missing third cumulant divided by the
/// variance, times V_xxx/6, for which 0.15 is an empirical value. 4 f, since the coarser grid misses up to
/// sixteen times the part f that the finer one misses.
template <class R>
KOKKOS_INLINE_FUNCTION R kou_skewness_error(const PutPack<R>& put, const LevyMeasure<R>& measure, R h) {
  const auto third_missed = [=](R share, R decay) {
    const R length = device::reciprocal(decay), x = 0.5 * h * decay;
    const R f = 1.0 - exponential(-x) * (1.0 + x * (1.0 + x * (0.5 + x * (1.0 / 6))));
    return share * length * length * length * device::minimum(R(1.0), 4.0 * f);
  };
  const R p = put.jump[1];
  const R missed =
      6.0 * put.jump[0] * device::absolute(third_missed(p, put.jump[2]) - third_missed(1.0 - p, put.jump[3]));
  return 0.15 * missed * device::reciprocal(device::maximum(put.variance + measure.variance, R(1e-100)));
}

/// Error of the skewness of generalized hyperbolic jumps, as a fraction of the strike. Jumps shorter than a
/// step have the right variance on the grid, but no skewness. Of the integral of y^2 e^{-p y} the nodes, with
/// half the first weight, sum the part x^3 (q (1 + q)/(1 - q)^3 - q/2)/2, x = p h, q = e^{-x}. p is 1.8 times
/// the smallest decay rate, since a mixture contains faster ones. The missing part is squared, because
/// extrapolation removes small parts. It multiplies the third cumulant divided by the variance, and V_xxx/6,
/// which is small far from the strike. 1.8, 0.125 and 0.04 are empirical.
template <class R>
KOKKOS_INLINE_FUNCTION R hyperbolic_skewness_error(const PutPack<R>& put, R h, R spread) {
  const R tilt = device::absolute(put.jump[2]);
  const R decay = put.jump[1] - tilt, slow = device::reciprocal(decay),
          fast = device::reciprocal(put.jump[1] + tilt);
  const R x = device::maximum(1.8 * h * decay, R(0.01)), q = exponential(-x);
  const R part = x * device::reciprocal(1.0 - q);
  const R summed = 0.5 * q * ((1.0 + q) * part * part * part - 0.5 * x * x * x);
  const R missed = device::maximum(R(0.0), 1.0 - summed);
  const R skew =
      2.0 * (slow * slow * slow - fast * fast * fast) * device::reciprocal(slow * slow + fast * fast);
  const R distance = 0.125 * put.log_spot,
          near = spread * device::reciprocal(spread + distance * distance + R(1e-100));
  return 0.04 * near * skew * missed * missed;
}

/// Factor of the estimate for generalized hyperbolic jumps shorter than a step, of decay length 1/alpha,
/// whose errors in space may cancel those in time in the difference of the grids. 4 and at most 1.6 are
/// empirical, tested by `OptionsCoverage.CoversAlmostAllEuropeansOfShortJumps`.
template <class R>
KOKKOS_INLINE_FUNCTION R short_jump_ratio(const PutPack<R>& put, R h) {
  return device::maximum(R(1.0), device::minimum(R(1.6), 4.0 * h * put.jump[1]));
}

/// Part of 6.5 in `error_factor` for generalized hyperbolic jumps, since both grids share their part in D
/// (`discretize_jumps`), but for split exercise. The difference of the grids then is of space, proportional
/// to y = h^2/spread, and of time, proportional to 1/steps^2. Where the former is the larger one it cannot
/// hide the latter, whose error is a smaller part of the sum. That is not so where D comes from jumps within
/// a step instead of Brownian motion: longer jumps, explicit, spread the payoff too. 5.5, 0.5 and 4 are
/// empirical.
template <class R>
KOKKOS_INLINE_FUNCTION R shared_time_part(const PutPack<R>& put, const Jumps<R>& jumps, R h, int steps,
                                          R spread) {
  const R reach = h * double(steps);
  const R ratio = spread * device::reciprocal(reach * reach),
          within = jumps.moved * device::reciprocal(device::maximum(jumps.diffusion, R(1e-100)));
  const R part = device::maximum(R(0.5), device::maximum(5.5 * ratio, 4.0 * within));
  return device::minimum(R(1.0), device::maximum(R(put.split), part));
}

/// Error estimate of a solve on a mesh of step h whose finite differences spread the payoff by the variance
/// `spread`. A step that does not resolve e^x has the error h^4/20.
template <class R>
KOKKOS_INLINE_FUNCTION ErrorEstimate<R> estimate_error(const PutPack<R>& put, const LevyMeasure<R>& measure,
                                                       const Jumps<R>& jumps, R h, int steps, R spread) {
  const R resolved = device::minimum(h, R(2.0)), squared = resolved * resolved;
  R time_part = 1.0;
  if (put.model == JumpModel::generalized_hyperbolic)
    time_part = shared_time_part(put, jumps, h, steps, spread);
  ErrorEstimate<R> estimate{error_factor(h, steps, spread, drift_in_deviations(put, measure), time_part),
                            0.05 * squared * squared, put.variance + measure.variance};
  if (put.model == JumpModel::kou) estimate.offset += kou_skewness_error(put, measure, h);
  if (put.model == JumpModel::generalized_hyperbolic) {
    estimate.factor *= short_jump_ratio(put, h);
    estimate.offset += hyperbolic_skewness_error(put, h, spread);
  }
  return estimate;
}

/// Truncation error of rare jumps beyond `truncation_error`, as a fraction of the strike. A path that leaves
/// the grid and returns takes two of the n jumps until maturity. Chernoff's bounds of a single jump, rare by
/// n, are much closer than those of the sum of many, and the part 6 n e^{-n} of the target is left with
/// Merton's jumps, a third of it with Kou's. 6, 2 and e^{-n} are empirical, tested by
/// `OptionsCoverage.CoversAllRowsOfRareJumps`.
template <class R>
KOKKOS_INLINE_FUNCTION R rare_jump_truncation(const PutPack<R>& put, int mesh) {
  const double part = put.model == JumpModel::merton ? 6.0 : 2.0;
  const R jumps = put.jump[0] * put.maturity;
  return part * truncation_target(mesh) * jumps * exponential(-device::minimum(jumps, R(600.0)));
}

/// Lower bound of the factor for frequent jumps of Merton's and Kou's models, which may be shorter than a
/// step. On the nodes they have the right mean but too much variance, of second order in h; the excess is
/// subtracted from the diffusion. If the coarser grid, with four times the excess, has too little diffusion,
/// up to a third of the difference of the grids remains. If the finer grid has far too little, the solved
/// process is a different one. If the symbol of the shortest wave exceeds 40 per step, values may grow, and
/// exercise may cut them so that both grids agree. The limits 0.8, 0.1 and 40 and the factor 0.5 are
/// empirical, tested by `OptionsError.CoversFrequentShortJumps`.
template <class R>
KOKKOS_INLINE_FUNCTION R frequent_jump_factor(const PutPack<R>& put, const LevyMeasure<R>& measure,
                                              const Jumps<R>& jumps, int steps) {
  constexpr double largest_symbol = 40.0;
  const R symbol_per_step = jumps.symbol[0] * step_length(put.maturity, steps, steps).dt;
  const auto coarse = 2.0 * jumps.diffusion <= 0.8 * put.variance;
  const auto fine = (jumps.excess_variance > 0.1 * (put.variance + measure.variance)) |
                    (symbol_per_step > R(largest_symbol));
  return device::select(fine, R(unreliable_factor), device::select(coarse, R(0.5), R(0.0)));
}

/// Error of the diffusion that is added implicitly and subtracted explicitly: added h^2 dt^2 V_xxtt, as a
/// fraction of the strike. It may cancel against the error of space in the difference of the grids. dt is the
/// last step, 1.5 T/steps, and V_xx at most 0.4/sqrt(v T). The coefficient 1 is calibrated on European
/// prices.
template <class R>
KOKKOS_INLINE_FUNCTION R stiff_jump_error(const PutPack<R>& put, const LevyMeasure<R>& measure,
                                          const Jumps<R>& jumps, int steps, R h) {
  const R dt = step_length(put.maturity, steps, steps).dt;
  const R added = added_diffusion(put, jumps, jumps.diffusion / (h * h), dt);
  const R variance = device::maximum(put.variance + measure.variance, R(1e-100));
  const R wide = added * h * h * device::reciprocal(double(steps) * steps);
  return wide * device::square_root(put.maturity * device::reciprocal(variance));
}

}  // namespace drogue::options
