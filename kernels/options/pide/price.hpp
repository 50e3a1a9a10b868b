#pragma once

#include "kernels/options/pide/error_estimate.hpp"

namespace drogue::options {

/// Why a put has no price on a grid of steps h. `most`: what it can earn, in money; `variance`: of its law, a
/// year.
KOKKOS_INLINE_FUNCTION FailureReason failure_of(const NormalizedPut& put, double most, double variance,
                                                double h) {
  if (put.rate * put.maturity < -650.0 || !(most < 1e300)) return FailureReason::discount_overflow;
  if (variance != variance) return FailureReason::coefficient_overflow;
  if (!(h < 100.0)) return FailureReason::no_grid;
  // Steps have the square of this.
  const double pull = device::absolute(put.rate) + device::absolute(put.dividend);
  const double largest = (pull + variance / h) / h;
  if (!(largest * largest < 1e300)) return FailureReason::coefficient_overflow;
  // From a million jumps until maturity on, or a discount e^{-1e10}, the most steps there are, 16384, rarely
  // tell anything.
  const bool counted = put.model == Model::merton || put.model == Model::kou;
  const bool stiff = (counted && put.jump[0] * put.maturity >= 1e6) || put.rate * put.maturity >= 1e10;
  return stiff ? FailureReason::stiff : FailureReason::unstable;
}

/// The node next to the spot of a put.
KOKKOS_INLINE_FUNCTION int node_beside(const NormalizedPut& put, double strike, double h, int mesh) {
  const double t = put.log_spot / h + strike + 0.5;
  return t > 0.0 ? t < mesh ? static_cast<int>(t) : mesh - 1 : 0;
}

/// The answer for a put of strike 1 on two grids, the coarser one with steps h, extrapolated to steps of
/// length zero (the error of both is of second order), as the contract's price. `largest`: |V(fine) -
/// V(coarse)| near the spot.
KOKKOS_INLINE_FUNCTION Price price_of(const Contract& contract, const NormalizedPut& put,
                                      const SolutionAtSpot& fine, const SolutionAtSpot& coarse,
                                      const ErrorEstimate<double>& doubt, double largest, double h, int mesh,
                                      int steps, double tolerance) {
  const auto limit = [](double f, double c) { return f + (f - c) * (1.0 / 3); };
  const double asset = exponential(put.log_spot);
  const bool exercised = put.early && fine.slope == -asset && fine.decay == 0.0;
  SolutionAtSpot a = fine;
  if (!exercised) {
    a.value = limit(fine.value, coarse.value);
    a.slope = limit(fine.slope, coarse.slope);
    a.bend = limit(fine.bend, coarse.bend);
    a.decay = limit(fine.decay, coarse.decay);
  }
  const bool call = contract.type == Type::call;
  const double unit = call ? contract.spot : contract.strike, s = contract.spot;
  // The extrapolation has 4/3 of what the fine grid misses and a third of what the coarse one does. Twice
  // that, since beside a sharp kink the terms that follow are no smaller.
  const double missed = 2.0 * (4.0 * fine.missed + coarse.missed) * (1.0 / 3);
  const double near = nearness(put, fine.boundary, 0.5 * h), unseen = doubt.gap + cut_doubt(mesh);
  const double contact = near > 0.0 ? doubt_of_contact(fine) : 0.0;
  const double lasting = near > 0.0 ? device::maximum(near, persistence(put, fine, doubt.variance)) : 0.0;
  // Where the payoff is the price nothing is in doubt but whether the boundary lies above.
  const double stated = exercised && near > 0.0
                            ? near * near * (contact + unseen) + no_time_value
                            : doubt.factor * largest + lasting * contact + missed + unseen;
  // Nobody pays more for a put than what it can earn at most, and no error is larger; nor less than what
  // exercise now or at expiry, whatever happens, is worth. A value that is not a number stays one.
  const double bond = exponential(-put.rate * put.maturity);
  const double most = put.rate < 0.0 ? bond : 1.0;
  const double late = bond - exponential(put.log_spot - put.dividend * put.maturity);
  const double least = device::maximum(put.early ? 1.0 - asset : 0.0, device::maximum(0.0, late));
  const bool finite = fine.value <= 1.001 * most && largest <= 4.0 * most && unit * most < 1e300 &&
                      put.rate * put.maturity >= -650.0 && h < 100.0;
  if (a.value < least) a.value = least;
  if (a.value > (put.early ? most : bond)) a.value = put.early ? most : bond;
  // Grids that differ by a quarter of all there is to know say nothing of the error.
  const bool known = largest < 0.25 * most && doubt.factor < nothing_known;
  const double error = stated < most && known ? stated : most;
  Price price;
  price.price = unit * a.value;
  price.error = unit * error;
  price.delta = call ? a.value - a.slope : unit * a.slope / s;
  price.gamma = call ? (a.bend - a.slope) / s : unit * (a.bend - a.slope) / (s * s);
  price.theta = -unit * a.decay;
  price.exercise_boundary = contract.strike * exponential(call ? -fine.boundary : fine.boundary);
  if (!(fine.boundary == fine.boundary)) price.exercise_boundary = fine.boundary;
  price.mesh = mesh;
  price.steps = steps;
  if (!finite) price.price = device::portable::not_a_number();
  price.status = !finite                                     ? PriceStatus::failed
                 : price.error > tolerance * contract.strike ? PriceStatus::coarse
                                                             : PriceStatus::ok;
  if (!finite) price.failure = failure_of(put, unit * most, doubt.variance, h);
  return price;
}

}  // namespace drogue::options
