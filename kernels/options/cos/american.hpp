#pragma once

#include <vector>

#include "kernels/options/contract.hpp"
#include "kernels/options/cos/bermudan.hpp"
#include "kernels/options/cos/characteristic_exponent.hpp"

namespace drogue::options {

/// American option as Bermudan puts of 1, 2, 4 and 8 times a number of dates. A call is a put on the dual
/// process. Unit of money: the strike of the put.
struct AmericanPut {
  static constexpr int levels = 4;

  double x = 0.0;  ///< log(spot / strike) of the put
  double rate = 0.0;
  double dividend = 0.0;
  CharacteristicExponent psi;
  /// Puts of all levels. If the cosine coefficients decay slowly, the finest put again with half the cosines.
  std::vector<BermudanPut> puts;
  std::vector<double> psi_re, psi_im;  ///< psi(pi k / width), 1/year
  double aliasing_error = 0.0;         ///< bound of the probability below the interval of the cosines
  double truncation_error = 0.0;       ///< bound of the value of exercise after the last date
  double date_error =
      0.0;  ///< bound of the gain from exercise between dates, if the levels cannot resolve it

  /// Throws nothing but std::bad_alloc.
  explicit AmericanPut(const Contract& contract);

  /// True if early exercise never pays, so that the price is that of the European option. Exercise of a
  /// put gains rate - dividend spot/strike per year, where the spot is below the strike: at most the larger
  /// one of rate and rate - dividend.
  [[nodiscard]] bool never_exercised() const { return rate <= 0.0 && dividend >= rate; }

  /// Chooses interval and cosines for `dates` to 8 `dates` dates and fills in the puts and the table.
  /// `maturity` in years. The last date is no later than the time after which discounted payoffs are worth
  /// less than a tenth of `tolerance`, in strikes of the put.
  void prepare(double maturity, int dates, double tolerance);
};

/// Price, Greeks and error from the values of the puts of a contract by Richardson extrapolation,
/// (64 v_8 - 56 v_4 + 14 v_2 - v_1) / 21 (Fang and Oosterlee 2009). The option is exercised, and has the
/// Greeks of its payoff, if its value exceeds the payoff by no more than the error of the extrapolation and
/// `tolerance`, in strikes of the put.
Price american_price(const Contract& contract, const AmericanPut& put, const BermudanValue* values,
                     double tolerance);

}  // namespace drogue::options
