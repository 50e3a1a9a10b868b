#pragma once

namespace drogue::reference {

/// Parameters of generalized hyperbolic jumps. delta = 0 with lambda > 0 is the variance gamma process.
struct GeneralizedHyperbolic {
  double lambda, alpha, beta, delta;
};

/// Levy density g(x), x != 0, 1/year, as printed in [Shi], section 4.6.1 (Prause 1999, eq. (2.34)), by
/// adaptive quadrature and the Bessel functions of Boost.
[[nodiscard]] double levy_density(const GeneralizedHyperbolic& jumps, double x);

/// Variance of the jumps of a year from modified Bessel functions (Prause 1999, lemma 1.14), or its limit for
/// delta = 0.
[[nodiscard]] double levy_variance(const GeneralizedHyperbolic& jumps);

/// Integral of e^{k y} g(y), 1/year, over |y| > length with the sign of y equal to `side`.
[[nodiscard]] double levy_tail(const GeneralizedHyperbolic& jumps, double length, int side, int k);

/// Integral of y^2 g(y), 1/year, over |y| > length.
[[nodiscard]] double levy_tail_variance(const GeneralizedHyperbolic& jumps, double length);

}  // namespace drogue::reference
