#pragma once

#include "kernels/device/portable_math.hpp"
#include "kernels/options/contract.hpp"

namespace drogue::options {

/// Greeks of an option that is exercised now: those of its payoff.
KOKKOS_INLINE_FUNCTION void set_exercised_greeks(const Contract& contract, Price& price) {
  price.delta = contract.type == Type::call ? 1.0 : -1.0;
  price.gamma = price.theta = 0.0;
}

/// Largest |delta|. A European price is that of at most e^{-q T} assets. An American put is convex and, for r
/// >= 0, worth no more than the strike, its payoff at the spot 0.
KOKKOS_INLINE_FUNCTION double largest_delta(const Contract& c) {
  const double prepaid = device::portable::exp(-c.dividend * c.maturity);
  if (c.style == Style::european) return prepaid;
  return (c.type == Type::put && c.rate >= 0.0) || prepaid < 1.0 ? 1.0 : prepaid;
}

/// Moves the Greeks into the bounds that hold for every exponential Levy process, which extrapolation and
/// interpolation may miss by their errors: a price is monotonic and convex in the spot (Bergman, Grundy and
/// Wiener 1996), and that of an American option does not decrease with the time to expiry. NaN is kept.
KOKKOS_INLINE_FUNCTION void bound_greeks(const Contract& contract, Price& price) {
  const double most = largest_delta(contract);
  const double low = contract.type == Type::call ? 0.0 : -most,
               high = contract.type == Type::call ? most : 0.0;
  if (price.delta < low) price.delta = low;
  if (price.delta > high) price.delta = high;
  if (price.gamma < 0.0) price.gamma = 0.0;
  if (contract.style == Style::american && price.theta > 0.0) price.theta = 0.0;
}

}  // namespace drogue::options
