#pragma once

#include "kernels/options/greek_bounds.hpp"
#include "kernels/options/pide/error_estimate.hpp"

namespace drogue::options {

/// Reason why a put has no price on a grid of step h. `upper_bound`: largest possible gain, money;
/// `variance`: that of the process, per year.
KOKKOS_INLINE_FUNCTION PricingFailure failure_of(const NormalizedPut& put, double upper_bound,
                                                 double variance, double h) {
  if (put.rate * put.maturity < -650.0 || !(upper_bound < 1e300)) return PricingFailure::discount_overflow;
  if (variance != variance) return PricingFailure::coefficient_overflow;
  if (!(h < 100.0)) return PricingFailure::no_grid;
  // The steps contain the square of this.
  const double rate_scale = device::absolute(put.rate) + device::absolute(put.dividend);
  const double largest = (rate_scale + variance / h) / h;
  if (!(largest * largest < 1e300)) return PricingFailure::coefficient_overflow;
  // With 1e6 jumps until maturity, or a discount factor e^{-1e10}, the maximum of 16384 steps is rarely
  // sufficient.
  const bool has_intensity = put.model == JumpModel::merton || put.model == JumpModel::kou;
  const bool stiff = (has_intensity && put.jump[0] * put.maturity >= 1e6) || put.rate * put.maturity >= 1e10;
  return stiff ? PricingFailure::stiff : PricingFailure::unstable;
}

/// Node next to the spot of a put.
KOKKOS_INLINE_FUNCTION int nearest_node(const NormalizedPut& put, double strike, double h, int mesh) {
  const double t = put.log_spot / h + strike + 0.5;
  return t > 0.0 ? t < mesh ? static_cast<int>(t) : mesh - 1 : 0;
}

/// Price of a contract from the solutions for a put of strike 1 on two grids, the coarser one with step h.
/// Both have errors of second order and are extrapolated to zero step lengths. `largest`: |V(fine) -
/// V(coarse)| near the spot.
KOKKOS_INLINE_FUNCTION Price price_of(const Contract& contract, const NormalizedPut& put,
                                      const SolutionAtSpot& fine, const SolutionAtSpot& coarse,
                                      const ErrorEstimate<double>& estimate, double largest, double h,
                                      int mesh, int steps, double tolerance) {
  const auto extrapolate = [](double f, double c) { return f + (f - c) * (1.0 / 3); };
  const double asset = exponential(put.log_spot);
  const bool exercised = put.early && fine.first_derivative == -asset && fine.time_derivative == 0.0;
  SolutionAtSpot limit = fine;
  if (!exercised) {
    limit.value = extrapolate(fine.value, coarse.value);
    limit.first_derivative = extrapolate(fine.first_derivative, coarse.first_derivative);
    limit.second_derivative = extrapolate(fine.second_derivative, coarse.second_derivative);
    limit.time_derivative = extrapolate(fine.time_derivative, coarse.time_derivative);
  }
  const bool call = contract.type == Type::call;
  const double unit = call ? contract.spot : contract.strike, s = contract.spot;
  // The extrapolation has 4/3 of the interpolation error of the fine grid and a third of that of the coarse
  // one. Doubled, since at a sharp kink the following terms are no smaller.
  const double interpolation_error =
      2.0 * (4.0 * fine.interpolation_error + coarse.interpolation_error) * (1.0 / 3);
  const double near_weight = boundary_weight(put, fine.boundary, 0.5 * h),
               hidden_error = estimate.offset + truncation_error(mesh);
  const double contact_error =
      near_weight > 0.0 ? boundary_error(fine, coarse, estimate.variance, 0.5 * h) : 0.0;
  const double contact_weight =
      near_weight > 0.0 ? device::maximum(near_weight, standing_boundary_weight(put, fine, estimate.variance))
                        : 0.0;
  // If the price is the payoff, only the position of the exercise boundary is uncertain.
  const double stated =
      exercised && near_weight > 0.0
          ? near_weight * near_weight * (contact_error + hidden_error) + time_value_tolerance
          : estimate.factor * largest + contact_weight * contact_error + interpolation_error + hidden_error;
  // The price is at most the largest possible gain and at least the value of exercise now or at expiry. The
  // error is clamped likewise. NaN is kept.
  const double bond = exponential(-put.rate * put.maturity);
  const double upper_bound = put.rate < 0.0 ? bond : 1.0;
  const double late = bond - exponential(put.log_spot - put.dividend * put.maturity);
  const double lower_bound = device::maximum(put.early ? 1.0 - asset : 0.0, device::maximum(0.0, late));
  const bool finite = fine.value <= 1.001 * upper_bound && largest <= 4.0 * upper_bound &&
                      unit * upper_bound < 1e300 && put.rate * put.maturity >= -650.0 && h < 100.0;
  if (limit.value < lower_bound) limit.value = lower_bound;
  if (limit.value > (put.early ? upper_bound : bond)) limit.value = put.early ? upper_bound : bond;
  // If the grids differ by a quarter of the largest possible gain, their difference is no measure of the
  // error.
  const bool reliable = largest < 0.25 * upper_bound && estimate.factor < unreliable_factor;
  const double error = stated < upper_bound && reliable ? stated : upper_bound;
  Price price;
  price.price = unit * limit.value;
  price.error = unit * error;
  price.delta = call ? limit.value - limit.first_derivative : unit * limit.first_derivative / s;
  price.gamma = call ? (limit.second_derivative - limit.first_derivative) / s
                     : unit * (limit.second_derivative - limit.first_derivative) / (s * s);
  price.theta = -unit * limit.time_derivative;
  if (put.early && asset < 1.0 && limit.value == 1.0 - asset) set_exercised_greeks(contract, price);
  bound_greeks(contract, price);
  price.exercise_boundary = contract.strike * exponential(call ? -fine.boundary : fine.boundary);
  if (!(fine.boundary == fine.boundary)) price.exercise_boundary = fine.boundary;
  price.mesh = mesh;
  price.steps = steps;
  if (!finite) price.price = device::portable::not_a_number();
  price.status = !finite                                     ? PriceStatus::failed
                 : price.error > tolerance * contract.strike ? PriceStatus::coarse
                                                             : PriceStatus::ok;
  if (!finite) price.failure = failure_of(put, unit * upper_bound, estimate.variance, h);
  return price;
}

}  // namespace drogue::options
