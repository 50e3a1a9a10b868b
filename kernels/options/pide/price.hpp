#pragma once

#include "kernels/options/pide/error_estimate.hpp"

namespace drogue::options {

/// Why a put has no price on a grid of steps h. `upper_bound`: what it can earn, in money; `variance`: of its
/// measure, a year.
KOKKOS_INLINE_FUNCTION Failure failure_of(const NormalizedPut& put, double upper_bound, double variance,
                                          double h) {
  if (put.rate * put.maturity < -650.0 || !(upper_bound < 1e300)) return Failure::too_large;
  if (variance != variance) return Failure::overflow;
  if (!(h < 100.0)) return Failure::no_grid;
  // Steps have the square of this.
  const double pull = device::absolute(put.rate) + device::absolute(put.dividend);
  const double largest = (pull + variance / h) / h;
  if (!(largest * largest < 1e300)) return Failure::overflow;
  // From a million jumps until maturity on, or a discount e^{-1e10}, the most steps there are, 16384, rarely
  // tell anything.
  const bool counted = put.model == Model::merton || put.model == Model::kou;
  const bool stiff = (counted && put.jump[0] * put.maturity >= 1e6) || put.rate * put.maturity >= 1e10;
  return stiff ? Failure::stiff : Failure::grown;
}

/// The node next to the spot of a put.
KOKKOS_INLINE_FUNCTION int nearest_node(const NormalizedPut& put, double strike, double h, int mesh) {
  const double t = put.log_spot / h + strike + 0.5;
  return t > 0.0 ? t < mesh ? static_cast<int>(t) : mesh - 1 : 0;
}

/// The answer for a put of strike 1 on two grids, the coarser one with steps h, extrapolated to steps of
/// length zero (the error of both is of second order), as the contract's price. `largest`: |V(fine) -
/// V(coarse)| near the spot.
KOKKOS_INLINE_FUNCTION Price price_of(const Contract& contract, const NormalizedPut& put,
                                      const SolutionAtSpot& fine, const SolutionAtSpot& coarse,
                                      const ErrorEstimate<double>& estimate, double largest, double h,
                                      int mesh, int steps, double tolerance) {
  const auto extrapolate = [](double f, double c) { return f + (f - c) * (1.0 / 3); };
  const double asset = exponential(put.log_spot);
  const bool exercised = put.early && fine.first_derivative == -asset && fine.time_derivative == 0.0;
  SolutionAtSpot a = fine;
  if (!exercised) {
    a.value = extrapolate(fine.value, coarse.value);
    a.first_derivative = extrapolate(fine.first_derivative, coarse.first_derivative);
    a.second_derivative = extrapolate(fine.second_derivative, coarse.second_derivative);
    a.time_derivative = extrapolate(fine.time_derivative, coarse.time_derivative);
  }
  const bool call = contract.type == Type::call;
  const double unit = call ? contract.spot : contract.strike, s = contract.spot;
  // The extrapolation has 4/3 of what the fine grid misses and a third of what the coarse one does. Twice
  // that, since beside a sharp kink the terms that follow are no smaller.
  const double interpolation_error =
      2.0 * (4.0 * fine.interpolation_error + coarse.interpolation_error) * (1.0 / 3);
  const double near_weight = boundary_weight(put, fine.boundary, 0.5 * h),
               hidden_error = estimate.offset + truncation_error(mesh);
  const double contact_error = near_weight > 0.0 ? boundary_error(fine) : 0.0;
  const double contact_weight =
      near_weight > 0.0 ? device::maximum(near_weight, standing_boundary_weight(put, fine, estimate.variance))
                        : 0.0;
  // Where the payoff is the price nothing is in doubt but whether the boundary lies above.
  const double stated =
      exercised && near_weight > 0.0
          ? near_weight * near_weight * (contact_error + hidden_error) + time_value_tolerance
          : estimate.factor * largest + contact_weight * contact_error + interpolation_error + hidden_error;
  // Nobody pays more for a put than what it can earn at most, and no error is larger; nor less than what
  // exercise now or at expiry, whatever happens, is worth. A value that is not a number stays one.
  const double bond = exponential(-put.rate * put.maturity);
  const double upper_bound = put.rate < 0.0 ? bond : 1.0;
  const double late = bond - exponential(put.log_spot - put.dividend * put.maturity);
  const double lower_bound = device::maximum(put.early ? 1.0 - asset : 0.0, device::maximum(0.0, late));
  const bool finite = fine.value <= 1.001 * upper_bound && largest <= 4.0 * upper_bound &&
                      unit * upper_bound < 1e300 && put.rate * put.maturity >= -650.0 && h < 100.0;
  if (a.value < lower_bound) a.value = lower_bound;
  if (a.value > (put.early ? upper_bound : bond)) a.value = put.early ? upper_bound : bond;
  // Grids that differ by a quarter of all there is to know say nothing of the error.
  const bool applied = largest < 0.25 * upper_bound && estimate.factor < unreliable_factor;
  const double error = stated < upper_bound && applied ? stated : upper_bound;
  Price price;
  price.price = unit * a.value;
  price.error = unit * error;
  price.delta = call ? a.value - a.first_derivative : unit * a.first_derivative / s;
  price.gamma = call ? (a.second_derivative - a.first_derivative) / s
                     : unit * (a.second_derivative - a.first_derivative) / (s * s);
  price.theta = -unit * a.time_derivative;
  price.exercise_boundary = contract.strike * exponential(call ? -fine.boundary : fine.boundary);
  if (!(fine.boundary == fine.boundary)) price.exercise_boundary = fine.boundary;
  price.mesh = mesh;
  price.steps = steps;
  if (!finite) price.price = device::portable::not_a_number();
  price.outcome = !finite                                     ? Outcome::failed
                  : price.error > tolerance * contract.strike ? Outcome::coarse
                                                              : Outcome::ok;
  if (!finite) price.failure = failure_of(put, unit * upper_bound, estimate.variance, h);
  return price;
}

}  // namespace drogue::options
