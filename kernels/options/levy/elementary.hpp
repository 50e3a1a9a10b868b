#pragma once

#include "kernels/device/pack.hpp"

/// Elementary and special functions of scalars and packs. The arithmetic is the same for both, so that a lane
/// of a pack has the bits of the scalar result on every backend. Arguments and values are dimensionless.
namespace drogue::options {

/// 1.5 x 2^52. Its sum with a small number x holds x, rounded to an integer, in the lowest bits.
inline constexpr double rounding_shift = 6755399441055744.0;

/// 2^n, given n + rounding_shift.
KOKKOS_INLINE_FUNCTION double power_of_two(double shifted) {
  return Kokkos::bit_cast<double>((Kokkos::bit_cast<std::uint64_t>(shifted) + 1023U) << 52U);
}
/// Significand of x, in [1, 2).
KOKKOS_INLINE_FUNCTION double fraction_of(double x) {
  return Kokkos::bit_cast<double>((Kokkos::bit_cast<std::uint64_t>(x) & 0xF'FFFF'FFFF'FFFFU) |
                                  0x3FF0'0000'0000'0000U);
}
/// Binary exponent of a positive normal number.
KOKKOS_INLINE_FUNCTION double exponent_of(double x) {
  return Kokkos::bit_cast<double>((Kokkos::bit_cast<std::uint64_t>(x) >> 52U) | 0x4330'0000'0000'0000U) -
         (4503599627370496.0 + 1023.0);
}

#if DROGUE_HOST_VECTORS
template <int L>
struct PackBits {
  typedef std::uint64_t Vector __attribute__((vector_size(L * sizeof(double))));  // NOLINT
  using Number = device::Pack<double, L>;
  static Vector of(Number x) { return (Vector)x.v; }
  static Number number(Vector bits) { return Number::of((typename Number::Vector)bits); }
};
template <int L>
device::Pack<double, L> power_of_two(device::Pack<double, L> shifted) {
  return PackBits<L>::number((PackBits<L>::of(shifted) + 1023U) << 52U);
}
template <int L>
device::Pack<double, L> fraction_of(device::Pack<double, L> x) {
  return PackBits<L>::number((PackBits<L>::of(x) & 0xF'FFFF'FFFF'FFFFU) | 0x3FF0'0000'0000'0000U);
}
template <int L>
device::Pack<double, L> exponent_of(device::Pack<double, L> x) {
  return PackBits<L>::number((PackBits<L>::of(x) >> 52U) | 0x4330'0000'0000'0000U) -
         (4503599627370496.0 + 1023.0);
}
#endif

/// e^x for x clamped to [-700, 700]: 2^n e^r with |r| <= ln 2 / 2, by the Taylor polynomial of degree 13
/// (remainder 4e-18).
template <class R>
KOKKOS_INLINE_FUNCTION R exponential(R x) {
  constexpr double inverse_factorial[] = {1.0 / 6227020800, 1.0 / 479001600, 1.0 / 39916800, 1.0 / 3628800,
                                          1.0 / 362880,     1.0 / 40320,     1.0 / 5040,     1.0 / 720,
                                          1.0 / 120,        1.0 / 24,        1.0 / 6,        0.5};
  x = device::maximum(R(-700.0), device::minimum(R(700.0), x));
  const R shifted = x * 1.4426950408889634 + rounding_shift;
  const R n = shifted - rounding_shift;
  const R r = (x - n * 6.93147180369123816490e-01) - n * 1.90821492927058770002e-10;
  R sum = inverse_factorial[0];
  for (int k = 1; k < 12; ++k) sum = sum * r + inverse_factorial[k];
  return (sum * r * r + (r + 1.0)) * power_of_two(shifted);
}

/// log x of positive normal numbers: e ln 2 + 2 artanh((m - 1)/(m + 1)), m in [sqrt(1/2), sqrt(2)], with
/// `terms` terms of the series of artanh.
template <int terms, class R>
KOKKOS_INLINE_FUNCTION R logarithm_by(R x) {
  const R m = fraction_of(x), e = exponent_of(x);
  const auto large = m > R(1.4142135623730951);
  const R factor = device::select(large, R(0.5), R(1.0)), up = device::select(large, R(1.0), R(0.0));
  const R y = m * factor;
  const R s = (y - 1.0) * device::reciprocal(y + 1.0), s2 = s * s;
  R sum = 1.0 / (2 * terms - 1);
  for (int k = 2 * terms - 3; k >= 1; k -= 2) sum = sum * s2 + 1.0 / k;
  const R n = e + up;
  return n * 6.93147180369123816490e-01 + (n * 1.90821492927058770002e-10 + 2.0 * s * sum);
}

/// log x of positive normal numbers, to rounding.
template <class R>
KOKKOS_INLINE_FUNCTION R logarithm(R x) {
  return logarithm_by<12>(x);
}
/// log x with a relative error of 4e-9, for bounds.
template <class R>
KOKKOS_INLINE_FUNCTION R rough_logarithm(R x) {
  return logarithm_by<5>(x);
}

/// Exponential integrals E1(x) of `n` numbers x > 0; relative error 1e-8, absolute error 1e-10; 0 for x > 40.
/// The series of Abramowitz and Stegun, eq. (5.1.11), below 1, and their continued fraction, eq. (5.1.22),
/// above. The recurrence for numerator and denominator needs one division. The n independent chains hide
/// latency. `decay` holds e^{-x}.
template <int n, class R>
KOKKOS_INLINE_FUNCTION void exponential_integrals(const R (&x)[n], const R (&decay)[n], R (&result)[n]) {
  bool all_zero = true, no_series = true;
  for (int i = 0; i < n; ++i) {
    result[i] = 0.0;
    all_zero = all_zero && device::all(x[i] > R(40.0));
    no_series = no_series && device::all(x[i] >= R(1.0));
  }
  if (all_zero) return;
  R denominator[n], numerator[n];
  for (int i = 0; i < n; ++i) denominator[i] = x[i] + 61.0, numerator[i] = 1.0;
  for (int k = 30; k >= 1; --k)
    for (int i = 0; i < n; ++i) {
      const R next = (x[i] + (2.0 * k - 1.0)) * denominator[i] - (double(k) * k) * numerator[i];
      numerator[i] = denominator[i];
      denominator[i] = next;
    }
  for (int i = 0; i < n; ++i)
    result[i] =
        device::select(x[i] > R(40.0), R(0.0), decay[i] * numerator[i] * device::reciprocal(denominator[i]));
  if (no_series) return;
  R term[n], series[n];
  for (int i = 0; i < n; ++i) term[i] = series[i] = x[i];
  for (int k = 2; k <= 14; ++k)
    for (int i = 0; i < n; ++i) {
      term[i] = term[i] * x[i] * (-1.0 / k);
      series[i] += term[i] * (1.0 / k);
    }
  for (int i = 0; i < n; ++i)
    result[i] = device::select(x[i] < R(1.0), series[i] - 0.57721566490153286 - logarithm(x[i]), result[i]);
}

/// Exponential integral E1(x), x > 0, with the errors of `exponential_integrals`.
template <class R>
KOKKOS_INLINE_FUNCTION R exponential_integral(R x) {
  const R one[1] = {x}, decay[1] = {exponential(-x)};
  R result[1];
  exponential_integrals(one, decay, result);
  return result[0];
}

/// Upper tail probability of the standard normal distribution, P(Z > z): a series for |z| < 3, else a
/// continued fraction (Abramowitz and Stegun, eqs. (26.2.11) and (26.2.14)).
template <class R>
KOKKOS_INLINE_FUNCTION R normal_upper_tail(R z) {
  const R size = device::minimum(device::absolute(z), R(40.0));
  const R density = 0.3989422804014327 * exponential(-0.5 * size * size);
  R term = size, series = size;
  for (int k = 1; k <= 32; ++k) {
    term = term * size * size * (1.0 / (2 * k + 1));
    series += term;
  }
  R fraction = size;
  for (int k = 40; k >= 1; --k) fraction = size + double(k) / fraction;
  const R above = device::select(size < R(3.0), 0.5 - density * series, density / fraction);
  return device::select(z < R(0.0), 1.0 - above, above);
}

}  // namespace drogue::options
