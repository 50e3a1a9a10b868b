#pragma once

#include <complex>
#include <vector>

namespace drogue::reference {

/// An asset under a Brownian motion and generalized hyperbolic jumps (delta = 0: variance gamma).
struct LevyAsset {
  double rate, dividend, variance;
  double lambda, alpha, beta, delta;
};

/// e^z K_nu(z), Re z > 0, by the trapezoid rule on integral exp(-z (cosh t - 1)) cosh(nu t) dt (Watson 1944,
/// 6.22).
[[nodiscard]] std::complex<long double> scaled_bessel_k(long double nu, std::complex<long double> z);

/// log E exp(i u (X_1 - X_0)) of the logarithm of the asset's price.
[[nodiscard]] std::complex<long double> characteristic_exponent(const LevyAsset& asset,
                                                                std::complex<long double> u);

/// Values at x = log(spot / strike), counted in strikes, of a put that may be exercised at `dates` equal
/// times, the last its maturity; now it may not. Each date's value max(payoff, waiting) is projected on
/// `terms` cosines of [low, low + width] by the midpoint rule on `nodes`: slow, plain, and of no structure
/// that could be got wrong. One date is the European put.
[[nodiscard]] std::vector<double> bermudan_put(const LevyAsset& asset, double maturity, int dates, double low,
                                               double width, int terms, int nodes,
                                               const std::vector<double>& x);

}  // namespace drogue::reference
