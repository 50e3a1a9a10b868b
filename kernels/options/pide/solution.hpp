#pragma once

#include "kernels/options/pide/march.hpp"

namespace drogue::options {

/// Solution for a put of strike 1 at x = ln(spot/strike) and maturity.
struct SolutionAtSpot {
  double value, first_derivative, second_derivative;  ///< V, dV/dx, d2V/dx2
  double time_derivative;                             ///< dV/dtau, per year
  double boundary;                                    ///< x of the exercise boundary; NaN if there is none
  double interpolation_error;                         ///< estimated error of the interpolated value
  double time_value_step;  ///< increase of the time value over the second interval above the boundary; 0
                           ///< without a boundary
  double time_value_rate;  ///< dV/dtau at the end of that interval, per year; 0 without a boundary
  double standing_error;   ///< `standing_boundary_error`; 0 without a boundary
};

/// Values of one member on the nodes of a pack.
struct MemberValues {
  const double* values;
  int members;
  KOKKOS_INLINE_FUNCTION double operator()(int i) const { return values[i * members]; }
};

/// Last exercised node below the strike, -1 if there is none.
KOKKOS_INLINE_FUNCTION int last_exercised(const MemberValues& value, int strike, double h) {
  int i = strike - 1;
  while (i >= 0 && !is_exercised(value(i), i - strike, h)) --i;
  return i;
}

/// Time value at node i: value minus exercise value.
KOKKOS_INLINE_FUNCTION double time_value(const MemberValues& value, int i, int strike, double h) {
  return value(i) - (1.0 - exponential((i - strike) * h));
}

/// Exercise boundary x from the last exercised node. Above the boundary the time value grows with the square
/// of the distance, so two nodes determine where it starts. NaN if `exercised` is negative.
KOKKOS_INLINE_FUNCTION double boundary_of(const MemberValues& value, int exercised, int strike, double h) {
  const int i = exercised;
  if (i < 0) return device::portable::not_a_number();
  const double first = Kokkos::sqrt(device::maximum(0.0, time_value(value, i + 1, strike, h))),
               second = Kokkos::sqrt(device::maximum(0.0, time_value(value, i + 2, strike, h)));
  const double within = second > first ? 1.0 - first / (second - first) : 0.0;
  return (i - strike + device::maximum(0.0, device::minimum(1.0, within))) * h;
}

/// Increase of the time value from the first to the second node above the last exercised one.
KOKKOS_INLINE_FUNCTION double time_value_step(const MemberValues& value, int exercised, int strike,
                                              double h) {
  if (exercised < 0) return 0.0;
  return device::absolute(time_value(value, exercised + 2, strike, h) -
                          time_value(value, exercised + 1, strike, h));
}

/// Error of exercise at nodes beside a boundary that stands, as a fraction of the strike. The time value is
/// B (x - b)^2/2 there. The nodes solve u_{i+1} - 2 u_i + u_{i-1} = B h^2 above the last exercised one, and
/// u = 0 at that one, so it lies within half a step of b. With u given far above, u is too small by d^2 B/2
/// beside b, where d = b - x of that node. u_2 - 2 u_1 = B h^2 and u_1 = B h (h/2 - d) give both.
KOKKOS_INLINE_FUNCTION double standing_boundary_error(const MemberValues& value, int exercised, int strike,
                                                      double h) {
  if (exercised < 0) return 0.0;
  const double first = time_value(value, exercised + 1, strike, h),
               second_difference = time_value(value, exercised + 2, strike, h) - 2.0 * first;
  if (!(second_difference > 1e-300)) return 0.0;
  const double within = device::minimum(0.5, device::absolute(0.5 - first / second_difference));
  return 0.5 * within * within * second_difference;
}

/// Grid of one member.
struct MemberGrid {
  int mesh, strike;
  int exercised;  ///< last exercised node below the strike; only read for puts with early exercise
  double h;
};

/// Cubic interpolation between four nodes: value and two derivatives with respect to x.
KOKKOS_INLINE_FUNCTION void interpolate(const MemberValues& value, int first, double t, double h,
                                        double* result) {
  const double p = value(first), q = value(first + 1), r = value(first + 2), s = value(first + 3);
  const double d1 = q - p, d2 = r - 2.0 * q + p, d3 = s - 3.0 * r + 3.0 * q - p;  // Newton's form
  result[0] = p + t * (d1 + (t - 1.0) * (0.5 * d2 + (t - 2.0) * (1.0 / 6) * d3));
  result[1] = (d1 + (t - 0.5) * d2 + (0.5 * t * t - t + 1.0 / 3) * d3) / h;
  result[2] = (d2 + (t - 1.0) * d3) / (h * h);
}

/// First of the four nodes from which a value at t, in steps from node 0, is interpolated. All four lie on
/// the same side of the strike and of the boundary as t: the value has kinks there, which are sharp for short
/// maturities.
KOKKOS_INLINE_FUNCTION int first_stencil_node(const NormalizedPut& put, const MemberGrid& nodes, double t,
                                              double boundary) {
  const int mesh = nodes.mesh, strike = nodes.strike, cell = static_cast<int>(t);
  int first = cell - 1;
  if (cell >= strike) {
    first = first < strike ? strike : first;
  } else {
    first = first > strike - 3 ? strike - 3 : first;
  }
  if (!put.split && boundary == boundary) {
    const int exercised = static_cast<int>(boundary / nodes.h + strike);
    first = first < exercised ? exercised : first;
  }
  return first > mesh - 3 ? mesh - 3 : first < 0 ? 0 : first;
}

/// Estimated error of cubic interpolation at t from the nodes `first` .. `first` + 3: the next term of
/// Newton's form, from a fifth node on the same side of the strike and of the boundary. 0 if there is no such
/// node.
KOKKOS_INLINE_FUNCTION double cubic_interpolation_error(const NormalizedPut& put, const MemberValues& value,
                                                        const MemberGrid& nodes, int first, double t,
                                                        double boundary) {
  const int strike = nodes.strike;
  const bool bounded = !put.split && boundary == boundary;
  const bool crosses_above = first + 4 > nodes.mesh || (first < strike && first + 4 > strike);
  const bool crosses_below =
      first == 0 || first == strike || (bounded && (first - 1 - strike) * nodes.h < boundary);
  if (crosses_above && crosses_below) return 0.0;
  const int from = crosses_above ? first - 1 : first;
  const double fourth =
      value(from) - 4.0 * value(from + 1) + 6.0 * value(from + 2) - 4.0 * value(from + 3) + value(from + 4);
  const double u = t - first;
  return device::absolute(fourth * u * (u - 1.0) * (u - 2.0) * (u - 3.0)) * (1.0 / 24);
}

/// Solution at an x below the grid, `asset` = e^x. There exercise or expiry is certain at the best time for x
/// (`domain_of`).
KOKKOS_INLINE_FUNCTION SolutionAtSpot solution_below_grid(const NormalizedPut& put, double asset,
                                                          double boundary) {
  const PutPack<double> pack = pack_puts<double>(&put);
  const DiscountFactors<double> discount =
      boundary_discount(pack, asset, optimal_exercise_time(pack, put.log_spot), put.maturity);
  const double strike = discount.strike, price = discount.asset * asset;
  const bool immediate = put.early && strike == 1.0 && discount.asset == 1.0;
  const double time_derivative = immediate ? 0.0 : put.dividend * price - put.rate * strike;
  return {.value = strike - price,
          .first_derivative = -price,
          .second_derivative = -price,
          .time_derivative = time_derivative,
          .boundary = boundary,
          .interpolation_error = 0.0,
          .time_value_step = 0.0,
          .time_value_rate = 0.0,
          .standing_error = 0.0};
}

/// Interpolates the solution of one member. `time_derivative` holds dV/dtau.
KOKKOS_INLINE_FUNCTION SolutionAtSpot solution_at_spot(const NormalizedPut& put, const MemberValues& value,
                                                       const MemberValues& time_derivative,
                                                       const MemberGrid& nodes) {
  const int mesh = nodes.mesh, strike = nodes.strike;
  const double h = nodes.h;
  const double x = put.log_spot, asset = exponential(x);
  SolutionAtSpot solution{};
  solution.boundary = device::portable::not_a_number();
  if (!(h < 1e30)) {
    solution.value = device::portable::not_a_number();
    return solution;
  }
  if (put.early) {
    solution.boundary = boundary_of(value, nodes.exercised, strike, h);
    solution.time_value_step = time_value_step(value, nodes.exercised, strike, h);
    solution.time_value_rate = nodes.exercised < 0 ? 0.0 : time_derivative(nodes.exercised + 2);
    solution.standing_error = standing_boundary_error(value, nodes.exercised, strike, h);
  }
  const double t = x / h + strike;
  if (!(t == t)) {  // no cell contains NaN
    solution.value = device::portable::not_a_number();
    return solution;
  }
  if (put.early && (x <= solution.boundary) && !(put.split && t < 1.0)) {
    if (!put.split || is_exercised(value(static_cast<int>(t)), static_cast<int>(t) - strike, h))
      return {.value = 1.0 - asset,
              .first_derivative = -asset,
              .second_derivative = -asset,
              .time_derivative = 0.0,
              .boundary = solution.boundary,
              .interpolation_error = 0.0,
              .time_value_step = solution.time_value_step,
              .time_value_rate = solution.time_value_rate,
              .standing_error = solution.standing_error};
  }
  if (t <= 0.0) return solution_below_grid(put, asset, solution.boundary);
  if (t >= mesh) return solution;
  const int first = first_stencil_node(put, nodes, t, solution.boundary);
  double result[3], rate[3];
  interpolate(value, first, t - first, h, result);
  interpolate(time_derivative, first, t - first, h, rate);
  solution.value = put.early && result[0] < 1.0 - asset ? 1.0 - asset : result[0];  // keeps NaN
  solution.first_derivative = result[1];
  solution.second_derivative = result[2];
  solution.time_derivative = rate[0];
  solution.interpolation_error = cubic_interpolation_error(put, value, nodes, first, t, solution.boundary);
  return solution;
}

}  // namespace drogue::options
