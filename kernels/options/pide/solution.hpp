#pragma once

#include "kernels/options/pide/march.hpp"

namespace drogue::options {

/// What a solve says of a put of strike 1, at x = ln(spot/strike) and maturity.
struct SolutionAtSpot {
  double value, slope, bend;  ///< V, dV/dx, d2V/dx2
  double decay;               ///< dV/dtau, a year
  double boundary;            ///< x up to which exercise is right; not a number where there is none
  double missed;              ///< how much of the value interpolation may miss
  double contact;             ///< what the second step above the boundary adds to the time value; 0: no such
  double parting;             ///< dV/dtau at that step's end, a year; 0: no such
};

/// One member's values on the nodes of a pack.
struct Column {
  const double* values;
  int members;
  KOKKOS_INLINE_FUNCTION double operator()(int i) const { return values[i * members]; }
};

/// The last node below the strike that is exercised, -1 if none is.
KOKKOS_INLINE_FUNCTION int last_exercised(const Column& value, int strike, double h) {
  int i = strike - 1;
  while (i >= 0 && !is_exercised(value(i), i - strike, h)) --i;
  return i;
}

/// What a put is worth at a node beyond exercise.
KOKKOS_INLINE_FUNCTION double time_value(const Column& value, int i, int strike, double h) {
  return value(i) - (1.0 - exponential((i - strike) * h));
}

/// Where exercise ends, from the last node where it is right. Above it the time value grows with the square
/// of the distance, so two nodes tell where it begins.
KOKKOS_INLINE_FUNCTION double boundary_of(const Column& value, int exercised, int strike, double h) {
  const int i = exercised;
  if (i < 0) return device::portable::not_a_number();
  const double first = Kokkos::sqrt(device::maximum(0.0, time_value(value, i + 1, strike, h))),
               second = Kokkos::sqrt(device::maximum(0.0, time_value(value, i + 2, strike, h)));
  const double within = second > first ? 1.0 - first / (second - first) : 0.0;
  return (i - strike + device::maximum(0.0, device::minimum(1.0, within))) * h;
}

/// What the second node above the last exercised one has of time value beyond the first.
KOKKOS_INLINE_FUNCTION double contact_of(const Column& value, int exercised, int strike, double h) {
  if (exercised < 0) return 0.0;
  return device::absolute(time_value(value, exercised + 2, strike, h) -
                          time_value(value, exercised + 1, strike, h));
}

/// The nodes of one member.
struct Nodes {
  int mesh, strike;
  int exercised;  ///< last node below the strike that is; only read for puts that may be
  double h;
};

/// Cubic interpolation between four nodes, value and two derivatives.
KOKKOS_INLINE_FUNCTION void interpolate(const Column& value, int first, double t, double h, double* result) {
  const double p = value(first), q = value(first + 1), r = value(first + 2), s = value(first + 3);
  const double d1 = q - p, d2 = r - 2.0 * q + p, d3 = s - 3.0 * r + 3.0 * q - p;  // Newton's form
  result[0] = p + t * (d1 + (t - 1.0) * (0.5 * d2 + (t - 2.0) * (1.0 / 6) * d3));
  result[1] = (d1 + (t - 0.5) * d2 + (0.5 * t * t - t + 1.0 / 3) * d3) / h;
  result[2] = (d2 + (t - 1.0) * d3) / (h * h);
}

/// The first of the four nodes that a value at t, in steps from node 0, is read from. They are taken from the
/// side of the strike and of the boundary that it is on: there the value has kinks that short maturities
/// leave sharp.
KOKKOS_INLINE_FUNCTION int stencil_of(const NormalizedPut& put, const Nodes& nodes, double t,
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

/// How much cubic interpolation at t from the nodes `first` to `first` + 3 may miss: the next term of
/// Newton's form, from a fifth node on the same side of the strike and of the boundary; 0 where there is
/// none.
KOKKOS_INLINE_FUNCTION double missed_by_cubic(const NormalizedPut& put, const Column& value,
                                              const Nodes& nodes, int first, double t, double boundary) {
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

/// The answer at an x below the grid, `asset` = e^x, where exercise or expiry is certain at the time that is
/// best there (`Domain` says why).
KOKKOS_INLINE_FUNCTION SolutionAtSpot answer_below(const NormalizedPut& put, double asset, double boundary) {
  const PutPack<double> pack = pack_puts<double>(&put);
  const Certain<double> sure = certain(pack, asset, best_time(pack, put.log_spot), put.maturity);
  const double strike = sure.strike, price = sure.asset * asset;
  const bool at_once = put.early && strike == 1.0 && sure.asset == 1.0;
  const double decay = at_once ? 0.0 : put.dividend * price - put.rate * strike;
  return {strike - price, -price, -price, decay, boundary, 0.0, 0.0, 0.0};
}

/// Reads the answer for one member. `change` holds dV/dtau.
KOKKOS_INLINE_FUNCTION SolutionAtSpot answer_of(const NormalizedPut& put, const Column& value,
                                                const Column& change, const Nodes& nodes) {
  const int mesh = nodes.mesh, strike = nodes.strike;
  const double h = nodes.h;
  const double x = put.log_spot, asset = exponential(x);
  SolutionAtSpot answer{0.0, 0.0, 0.0, 0.0, device::portable::not_a_number(), 0.0, 0.0, 0.0};
  if (!(h < 1e30)) {
    answer.value = device::portable::not_a_number();
    return answer;
  }
  if (put.early) {
    answer.boundary = boundary_of(value, nodes.exercised, strike, h);
    answer.contact = contact_of(value, nodes.exercised, strike, h);
    answer.parting = nodes.exercised < 0 ? 0.0 : change(nodes.exercised + 2);
  }
  const double t = x / h + strike;
  if (!(t == t)) {  // no cell has such a number
    answer.value = device::portable::not_a_number();
    return answer;
  }
  if (put.early && (x <= answer.boundary) && !(put.split && t < 1.0)) {
    if (!put.split || is_exercised(value(static_cast<int>(t)), static_cast<int>(t) - strike, h))
      return {1.0 - asset, -asset, -asset, 0.0, answer.boundary, 0.0, answer.contact, answer.parting};
  }
  if (t <= 0.0) return answer_below(put, asset, answer.boundary);
  if (t >= mesh) return answer;
  const int first = stencil_of(put, nodes, t, answer.boundary);
  double result[3], rate[3];
  interpolate(value, first, t - first, h, result);
  interpolate(change, first, t - first, h, rate);
  answer.value = put.early && result[0] < 1.0 - asset ? 1.0 - asset : result[0];  // a NaN stays one
  answer.slope = result[1];
  answer.bend = result[2];
  answer.decay = rate[0];
  answer.missed = missed_by_cubic(put, value, nodes, first, t, answer.boundary);
  return answer;
}

}  // namespace drogue::options
