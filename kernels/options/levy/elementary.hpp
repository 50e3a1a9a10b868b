#pragma once

#include "kernels/device/pack.hpp"

/// The exponential and the logarithm of numbers and of packs of them: one arithmetic for both and without a
/// branch, so that a lane has the bits that the number alone would have, on every backend.
namespace drogue::options {

/// 1.5 x 2^52: added to a small number it leaves that number, rounded, in the lowest bits.
inline constexpr double rounder = 6755399441055744.0;

/// 2^n from n + rounder.
KOKKOS_INLINE_FUNCTION double power_of_two(double shifted) {
  return Kokkos::bit_cast<double>((Kokkos::bit_cast<std::uint64_t>(shifted) + 1023U) << 52U);
}
/// The number in [1, 2) with the fraction of x.
KOKKOS_INLINE_FUNCTION double fraction_of(double x) {
  return Kokkos::bit_cast<double>((Kokkos::bit_cast<std::uint64_t>(x) & 0xF'FFFF'FFFF'FFFFU) |
                                  0x3FF0'0000'0000'0000U);
}
/// The binary exponent of a positive normal number.
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

/// e^x for x cut to [-700, 700]: e^r 2^n with |r| <= ln 2 / 2, Taylor's series to r^13 (remainder 4e-18).
template <class R>
KOKKOS_INLINE_FUNCTION R exponential(R x) {
  constexpr double inverse_factorial[] = {1.0 / 6227020800, 1.0 / 479001600, 1.0 / 39916800, 1.0 / 3628800,
                                          1.0 / 362880,     1.0 / 40320,     1.0 / 5040,     1.0 / 720,
                                          1.0 / 120,        1.0 / 24,        1.0 / 6,        0.5};
  x = device::maximum(R(-700.0), device::minimum(R(700.0), x));
  const R shifted = x * 1.4426950408889634 + rounder;
  const R n = shifted - rounder;
  const R r = (x - n * 6.93147180369123816490e-01) - n * 1.90821492927058770002e-10;
  R sum = inverse_factorial[0];
  for (int k = 1; k < 12; ++k) sum = sum * r + inverse_factorial[k];
  return (sum * r * r + (r + 1.0)) * power_of_two(shifted);
}

/// log x of positive normal numbers: e ln 2 + 2 artanh((m - 1)/(m + 1)), m in [sqrt(1/2), sqrt(2)], by so
/// many terms of its series.
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

template <class R>
KOKKOS_INLINE_FUNCTION R logarithm(R x) {
  return logarithm_by<12>(x);
}
/// To 4e-9 of itself, for bounds.
template <class R>
KOKKOS_INLINE_FUNCTION R rough_logarithm(R x) {
  return logarithm_by<5>(x);
}

/// The exponential integrals E1(x) of x > 0, to 1e-8 of themselves and to 1e-10 absolutely; 0 beyond 40.
/// Below 1 the series (Abramowitz and Stegun 5.1.11), above the continued fraction (5.1.22), as the quotient
/// of two numbers, so that one division is enough. Several at a time do not wait for one another. `decay`
/// holds e^{-x}.
template <int n, class R>
KOKKOS_INLINE_FUNCTION void exponential_integrals(const R (&x)[n], const R (&decay)[n], R (&result)[n]) {
  bool beyond = true, far = true;
  for (int i = 0; i < n; ++i) {
    result[i] = 0.0;
    beyond = beyond && device::all(x[i] > R(40.0));
    far = far && device::all(x[i] >= R(1.0));
  }
  if (beyond) return;
  R above[n], below[n];
  for (int i = 0; i < n; ++i) above[i] = x[i] + 61.0, below[i] = 1.0;
  for (int k = 30; k >= 1; --k)
    for (int i = 0; i < n; ++i) {
      const R next = (x[i] + (2.0 * k - 1.0)) * above[i] - (double(k) * k) * below[i];
      below[i] = above[i];
      above[i] = next;
    }
  for (int i = 0; i < n; ++i)
    result[i] = device::select(x[i] > R(40.0), R(0.0), decay[i] * below[i] * device::reciprocal(above[i]));
  if (far) return;
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

template <class R>
KOKKOS_INLINE_FUNCTION R exponential_integral(R x) {
  const R one[1] = {x}, decay[1] = {exponential(-x)};
  R result[1];
  exponential_integrals(one, decay, result);
  return result[0];
}

/// The chance of a standard normal number above z: for |z| < 3 from the series of its other part, else from
/// a continued fraction (Abramowitz and Stegun 26.2.11, 26.2.14).
template <class R>
KOKKOS_INLINE_FUNCTION R normal_above(R z) {
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
