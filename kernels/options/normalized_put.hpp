#pragma once

#include "kernels/device/portable_math.hpp"
#include "kernels/options/contract.hpp"

namespace drogue::options {

/// Put of strike 1 as a function of the logarithm of the asset price. Every contract is solved in this form.
///
/// A call equals the put with spot and strike, and rate and dividend, exchanged under the dual measure, whose
/// jumps have the density e^{-y} g(-y) (Peskir and Shiryaev 2002; Fajardo and Mordecki 2006).
struct NormalizedPut {
  JumpModel model = JumpModel::generalized_hyperbolic;
  bool early = true;      ///< early exercise is allowed and may pay
  bool split = false;     ///< early exercise is imposed by operator splitting, as two boundaries require
  double log_spot = 0.0;  ///< ln(spot/strike)
  double rate = 0.0, dividend = 0.0;  ///< per year
  double maturity = 0.0;              ///< years
  double variance = 0.0;              ///< of the Brownian part, per year
  double jump[4] = {0.0, 0.0, 0.0, 0.0};
};

/// Replaces the parameters of a jump density g(y) by those of the dual density e^{-y} g(-y).
KOKKOS_INLINE_FUNCTION void to_dual_measure(JumpModel model, double* jump) {
  if (model == JumpModel::generalized_hyperbolic) {
    jump[2] = -jump[2] - 1.0;
  } else if (model == JumpModel::merton) {
    const double variance = jump[2] * jump[2];
    jump[0] *= device::portable::exp(jump[1] + 0.5 * variance);
    jump[1] = -jump[1] - variance;
  } else if (model == JumpModel::kou) {
    const double up = jump[1] * jump[2] / (jump[2] - 1.0), down = (1.0 - jump[1]) * jump[3] / (jump[3] + 1.0);
    const double rate_up = jump[2];
    jump[0] *= up + down;
    jump[1] = down / (up + down);
    jump[2] = jump[3] + 1.0;
    jump[3] = rate_up - 1.0;
  }
}

/// True if early exercise of a put may pay. Exercise at x < 0 gains r - q e^x per year, which must be
/// positive for some x.
KOKKOS_INLINE_FUNCTION bool early_may_pay(double rate, double dividend) {
  return rate > 0.0 || dividend < rate;
}

/// The normalized put of a contract. For r < 0 the exercise region, if any, is bounded below, so exercise is
/// imposed by operator splitting.
KOKKOS_INLINE_FUNCTION NormalizedPut normalize(const Contract& contract) {
  const bool call = contract.type == Type::call;
  NormalizedPut put;
  put.model = contract.model;
  put.rate = call ? contract.dividend : contract.rate;
  put.dividend = call ? contract.rate : contract.dividend;
  put.maturity = contract.maturity;
  put.variance = contract.variance;
  const double ratio = contract.spot / contract.strike;
  put.log_spot = device::portable::log(call ? 1.0 / ratio : ratio);
  for (int k = 0; k < 4; ++k) put.jump[k] = contract.jump[k];
  if (call) to_dual_measure(put.model, put.jump);
  put.early = contract.style == Style::american && early_may_pay(put.rate, put.dividend);
  put.split = put.early && put.rate < 0.0;
  return put;
}

}  // namespace drogue::options
