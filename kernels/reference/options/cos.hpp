#pragma once

#include <complex>
#include <vector>

namespace drogue::reference {

/// Asset with a Brownian part of `variance` per year and generalized hyperbolic jumps (delta = 0: variance
/// gamma). Rates per year.
struct LevyAsset {
  double rate, dividend, variance;
  double lambda, alpha, beta, delta;
};

/// e^z K_nu(z), Re z > 0: the integral of exp(-z (cosh t - 1)) cosh(nu t) over t > 0 by the trapezoidal rule
/// (Watson 1944, section 6.22).
[[nodiscard]] std::complex<long double> scaled_bessel_k(long double nu, std::complex<long double> z);

/// Characteristic exponent log E exp(i u (X_1 - X_0)), 1/year, of the logarithm X of the asset price, from
/// the characteristic function of the generalized hyperbolic distribution (Barndorff-Nielsen 1977).
[[nodiscard]] std::complex<long double> characteristic_exponent(const LevyAsset& asset,
                                                                std::complex<long double> u);

/// Continuation values now of a Bermudan put, in strikes, at the points x = log(spot / strike). `dates` are
/// its exercise dates, years from now, ascending, the last at maturity; one date is the European put.
///
/// Direct form of the COS method (Fang and Oosterlee 2009): at each date max(payoff, continuation value) is
/// projected on `terms` cosines of [low, low + width] by the midpoint rule on `nodes` points. Slow, without
/// transforms or closed-form coefficients.
[[nodiscard]] std::vector<double> bermudan_put(const LevyAsset& asset, const std::vector<double>& dates,
                                               double low, double width, int terms, int nodes,
                                               const std::vector<double>& x);

}  // namespace drogue::reference
