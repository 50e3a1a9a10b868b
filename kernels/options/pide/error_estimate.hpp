#pragma once

#include "kernels/options/pide/solution.hpp"

namespace drogue::options {

/// What the stated error is made of, beside what interpolation and the grid's ends leave.
template <class R>
struct ErrorEstimate {
  R factor;    ///< of the largest difference of two grids near the spot
  R offset;    ///< what that difference does not tell at all, of the strike
  R variance;  ///< of the measure, a year
};

/// The factor of a solve that tells nothing.
inline constexpr double unreliable_factor = 1e6;

/// What the factor is at least where exercise is split off and the premium of it is not known. Splitting is
/// of first order in time, and extrapolation for the second leaves 2/3 of the difference where it decides and
/// less elsewhere: this is fitted.
inline constexpr double splitting_factor = 0.4;

/// The doubt of member k of a pack, of whose put no premium is known.
template <class R>
KOKKOS_INLINE_FUNCTION ErrorEstimate<double> estimate_without_premium(const ErrorEstimate<R>& estimate,
                                                                      const NormalizedPut& put, int k) {
  const double factor = device::Access<R>::lane(estimate.factor, k);
  return {put.split ? device::maximum(factor, splitting_factor) : factor,
          device::Access<R>::lane(estimate.offset, k), device::Access<R>::lane(estimate.variance, k)};
}

/// What splitting exercise off may miss where its premium, of the strike, is known: no more than a part of
/// the premium that falls with the steps, or with the mesh where that is coarse, since nodes know the two
/// boundaries to a part of a step in space. Fitted.
KOKKOS_INLINE_FUNCTION double splitting_error(double premium, int mesh, int steps, double largest) {
  const double resolved = device::minimum(double(steps), 0.25 * mesh);
  return device::minimum(0.5 * device::absolute(premium) / resolved, splitting_factor * largest);
}

/// What the largest |V(fine) - V(coarse)| near the spot is multiplied by for the error of their
/// extrapolation: docs/options.md tells how often it is below what is stated. The largest near the spot and
/// not that at it, which changes sign somewhere. The difference is of second order and what extrapolation
/// leaves is of the next one, so their quotient falls with the steps, measured by what they resolve. In time
/// that is the maturity, of which a drift that crosses many deviations, `drift_ratio` >= 1, leaves a part. In
/// space it is the deviation sqrt(spread), spread = 2 D T, by which differences smooth the kink of the
/// payoff: y^{1/2}, y = h^2/spread. A kink that hardly spreads, of short times or of pure jumps, leaves an
/// order far below two, and the quotient grows faster, y^{3/4}. The numbers and the root of `drift_ratio` are
/// fitted to prices of random laws; at the strike the one of space is 0.42.
template <class R>
KOKKOS_INLINE_FUNCTION R error_factor(R h, int steps, R spread, R drift_ratio) {
  const R in_time = device::minimum(R(0.3), R(6.5 / steps)) * device::square_root(drift_ratio);
  const R y = h * h / device::maximum(spread, h * h * (1.0 / 500)), root = device::square_root(y);
  return device::maximum(in_time, 0.45 * root * device::square_root(device::maximum(root, R(1.0))));
}

/// How much of what is in doubt at the boundary of exercise is so at a put's spot: from two steps on it falls
/// with the distance, since the boundary moves on and is now above a node and now below one. None where
/// exercise is split off, whose own doubt holds it.
KOKKOS_INLINE_FUNCTION double boundary_weight(const NormalizedPut& put, double boundary, double h) {
  if (put.split || !(boundary == boundary)) return 0.0;
  const double distance = device::portable::magnitude(put.log_spot - boundary), near_distance = 2.0 * h;
  return distance > near_distance ? near_distance / distance : 1.0;
}

/// The part that is so whatever the distance, since the boundary of decades hardly moves. Near the boundary b
/// the time value is B (x - b)^2/2, of which `contact` and `parting` tell the time t = 3/4 contact/parting in
/// which b moves by half a step. The chance to get from x to b within t falls with q = (x - b)^2/(variance
/// t), as fitted like 1/(1 + q + q^2/2).
KOKKOS_INLINE_FUNCTION double standing_boundary_weight(const NormalizedPut& put,
                                                       const SolutionAtSpot& solution, double variance) {
  const double distance = put.log_spot - solution.boundary;
  const double stays = device::maximum(solution.time_value_step * variance, 1e-150),
               moves = (4.0 / 3) * distance * distance * device::maximum(solution.time_value_rate, 0.0);
  return stays * stays / (stays * stays + moves * (stays + 0.5 * moves));
}

/// What exercise at nodes alone may change of the value. Grids know the boundary to a part of a step,
/// elsewhere on each, so their difference does not tell this. Where the time value is half its bend times the
/// distance squared, `SolutionAtSpot::contact` is that bend times h^2, and a boundary that is off by 0.35 h
/// misses 0.06 of it. Without diffusion the time value has an angle, and what 0.06 h is worth is missed.
/// Fitted to American prices of finer grids. Away from the boundary the value says how likely a path gets
/// there: it is no less than that of exercise at the boundary alone.
KOKKOS_INLINE_FUNCTION double boundary_error(const SolutionAtSpot& solution) {
  const double payoff = 1.0 - exponential(solution.boundary);
  return 0.06 * solution.time_value_step * (solution.value < payoff ? solution.value / payoff : 1.0);
}

/// How many deviations the drift crosses until maturity, as `error_factor` counts them, 1 at least.
template <class R>
KOKKOS_INLINE_FUNCTION R drift_in_deviations(const PutPack<R>& put, const LevyMeasure<R>& measure) {
  const R variance = device::maximum((put.variance + measure.variance) * put.maturity, R(1e-100));
  // What a mean of e^y - 1 - y takes from the drift is nearly half of the variance, but not where Kou's jumps
  // upwards hardly have a mean.
  R taken = 0.5 * measure.variance;
  if (put.model == Model::merton || put.model == Model::kou) taken = jump_cumulant(put, measure, R(1.0));
  const R drift = (put.rate - put.dividend - 0.5 * put.variance - taken) * put.maturity;
  const R drift_ratio =
      device::maximum(R(1.0), device::absolute(drift) * device::reciprocal(device::square_root(variance)));
  if (put.model != Model::generalized_hyperbolic) return drift_ratio;
  // Tilted jumps (those of beta = -1/2 are alike in both directions but for e^y) leave more once they have
  // deviations and years to act on; where exercise is early they have less time to. Fitted.
  const R years = put.maturity * device::minimum(R(1.0), 0.25 * put.maturity);
  const R tilted = (1.0 - put.early) * device::absolute(put.jump[2] + 0.5) *
                   device::square_root(measure.variance * years + R(1e-100));
  return drift_ratio * device::minimum(device::maximum(R(1.0), tilted - 0.4), R(10.0));
}

/// Kou's jumps in the cell about 0 have their variance on the grid but not their skewness: the third cumulant
/// that cells miss over the variance, and V_xxx/6. 4 f, since the coarser grid misses up to sixteen times the
/// part f that the finer one does.
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
  return 0.06 * missed * device::reciprocal(device::maximum(put.variance + measure.variance, R(1e-100)));
}

/// Generalized hyperbolic jumps that are shorter than a step have their variance on the grid but not their
/// skewness. Of the integral of y^2 e^{-p y} the nodes, with half the first one, sum the part x^3 (q (1 +
/// q)/(1 - q)^3 - q/2)/2, x = p h, q = e^{-x}; p is 1.8 times the least decay, since a mixture has faster
/// ones. The rest, squared since an extrapolation sees what is little, times the third cumulant over the
/// variance and V_xxx/6, of which far from the strike there is little.
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

/// Of a solve on a mesh of steps h whose differences spread the payoff by `spread`. A step that does not
/// resolve e^x misses h^4/20.
template <class R>
KOKKOS_INLINE_FUNCTION ErrorEstimate<R> estimate_error(const PutPack<R>& put, const LevyMeasure<R>& measure,
                                                       R h, int steps, R spread) {
  const R resolved = device::minimum(h, R(2.0)), squared = resolved * resolved;
  ErrorEstimate<R> estimate{error_factor(h, steps, spread, drift_in_deviations(put, measure)),
                            0.05 * squared * squared, put.variance + measure.variance};
  if (put.model == Model::kou) estimate.offset += kou_skewness_error(put, measure, h);
  if (put.model == Model::generalized_hyperbolic)
    estimate.offset += hyperbolic_skewness_error(put, h, spread);
  return estimate;
}

/// The factor at least, of Merton's and Kou's jumps, many of which may be shorter than a step. Nodes have
/// their mean, but more variance; what is more, of second order, is taken from that of diffusion. Where that
/// is not enough on the coarser grid, with four times as much, the extrapolation has up to a third of the
/// difference of both grids; where it is not by far on the finer one, the law that was solved is another one.
/// And where the rate at which nodes see them, as the symbol of the shortest wave tells it, is dozens a step,
/// values may grow; exercise would cut them back so that both grids agree.
template <class R>
KOKKOS_INLINE_FUNCTION R frequent_jump_factor(const PutPack<R>& put, const LevyMeasure<R>& measure,
                                              const Jumps<R>& jumps, int steps) {
  constexpr double most_a_step = 40.0;
  const R a_step = jumps.symbol[0] * step_length(put.maturity, steps, steps).dt;
  const auto coarse = 2.0 * jumps.diffusion <= 0.8 * put.variance;
  const auto fine =
      (jumps.excess_variance > 0.1 * (put.variance + measure.variance)) | (a_step > R(most_a_step));
  return device::select(fine, R(unreliable_factor), device::select(coarse, R(0.5), R(0.0)));
}

/// What is added to diffusion and taken back from the values before leaves an error of
/// added h^2 dt^2 V_xxtt, which may hide behind that of space in the difference of two grids: dt is the last
/// step, 1.5 T/steps, V_xx at most 0.4/sqrt(v T), and the number in front, 1, is fitted to European prices.
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
