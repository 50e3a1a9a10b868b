#pragma once

#include <vector>

#include "kernels/options/contract.hpp"
#include "kernels/options/cos/bermudan.hpp"
#include "kernels/options/cos/exponent.hpp"
#include "kernels/options/normalized_put.hpp"

namespace drogue::options {

/// An American option as Bermudan puts of 1, 2, 4 and 8 times a number of dates: a call is a put on the dual
/// process. Strikes are the unit of money.
struct AmericanPut {
  static constexpr int levels = 4;

  double x = 0.0;  ///< log(spot / strike) of the put
  double rate = 0.0;
  double dividend = 0.0;
  Exponent psi;
  std::vector<BermudanPut> puts;       ///< those of the levels; the finest again with half the cosines, where
                                       ///< they fall slowly
  std::vector<double> psi_re, psi_im;  ///< at pi k / width
  double folded = 0.0;                 ///< what part of the law may lie below the interval
  double beyond = 0.0;                 ///< what dates later than those of the puts are worth at most
  double between = 0.0;  ///< what exercise between dates gains at most, if they are too few to tell

  explicit AmericanPut(const Contract& contract);

  /// Whether to wait is always right: the price is that of the European option.
  [[nodiscard]] bool never_exercised() const { return !early_may_pay(rate, dividend); }

  /// Chooses interval and cosines for `dates` to 8 `dates` dates and fills `puts` and the table. There are no
  /// dates where all money is worth less than a tenth of `tolerance`, of the put's strike.
  void prepare(double maturity, int dates, double tolerance);
};

/// Price, Greeks and error from the values of the puts of a contract: (64 v_8 - 56 v_4 + 14 v_2 - v_1) / 21
/// (Fang and Oosterlee 2009), at least what exercise gives.
Price american_price(const Contract& contract, const AmericanPut& put, const BermudanValue* values);

}  // namespace drogue::options
