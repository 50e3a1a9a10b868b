#pragma once

namespace drogue::reference {

/// Parameters of generalized hyperbolic jumps; delta = 0 is variance gamma, with lambda > 0.
struct Hyperbolic {
  double lambda, alpha, beta, delta;
};

/// The Levy density g(x), x != 0, a year, as printed in the dissertation (section 4.6.1; Prause 1999,
/// equation 2.34): its integral is done adaptively, with the Bessel functions of Boost.
[[nodiscard]] double levy_density(const Hyperbolic& law, double x);

/// Variance of the jumps of a year, from modified Bessel functions (Prause 1999, lemma 1.14), and for delta =
/// 0 its limit.
[[nodiscard]] double levy_variance(const Hyperbolic& law);

/// The integral of e^{k y} g(y) over |y| > length, y of the sign of `side`.
[[nodiscard]] double levy_tail(const Hyperbolic& law, double length, int side, int k);

/// The integral of y^2 g(y) over |y| > length.
[[nodiscard]] double levy_tail_variance(const Hyperbolic& law, double length);

}  // namespace drogue::reference
