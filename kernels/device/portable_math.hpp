#pragma once

#include <Kokkos_BitManipulation.hpp>
#include <Kokkos_Core.hpp>
#include <cstdint>

/// Elementary functions with bitwise equal results on every backend: IEEE operations and square roots in a
/// fixed order, compiled without fused multiply-add. The error is below 1e-13 max(1, |value|), tested against
/// <cmath>.
namespace drogue::device::portable {

constexpr double pi = 3.141592653589793;
constexpr double ln2 = 0.6931471805599453;
constexpr double ln10 = 2.302585092994046;

/// Quiet NaN.
KOKKOS_INLINE_FUNCTION double not_a_number() { return Kokkos::Experimental::quiet_NaN_v<double>; }

/// Positive infinity.
KOKKOS_INLINE_FUNCTION double infinity() { return Kokkos::Experimental::infinity_v<double>; }

/// Absolute value; keeps the sign of -0.
KOKKOS_INLINE_FUNCTION double magnitude(double x) { return x < 0.0 ? -x : x; }

/// 2^n for a normal result, -1022 <= n <= 1023.
KOKKOS_INLINE_FUNCTION double power_of_two(int n) {
  return Kokkos::bit_cast<double>(static_cast<std::uint64_t>(n + 1023) << 52U);
}

/// Exponential: x = n ln 2 + r with |r| <= ln 2 / 2, and the Taylor series of e^r to r^13 (remainder 4e-18).
KOKKOS_INLINE_FUNCTION double exp(double x) {
  if (!(x == x)) return x;
  if (x > 709.8) return infinity();
  if (x < -745.2) return 0.0;
  constexpr double ln2_high = 6.93147180369123816490e-01;  // 21 low bits are 0: n ln2_high is exact
  constexpr double ln2_low = 1.90821492927058770002e-10;
  const double n = Kokkos::floor(x / ln2 + 0.5);
  const double r = (x - n * ln2_high) - n * ln2_low;
  double sum = 1.0;
  for (int k = 13; k > 0; --k) sum = 1.0 + r / k * sum;
  const int half = static_cast<int>(n) / 2;  // two factors, for results that overflow or are subnormal
  return sum * power_of_two(half) * power_of_two(static_cast<int>(n) - half);
}

/// Natural logarithm: x = m 2^e with m in [sqrt(1/2), sqrt(2)), and log m = 2 artanh s with s = (m-1)/(m+1).
KOKKOS_INLINE_FUNCTION double log(double x) {
  if (!(x > 0.0)) return x == 0.0 ? -infinity() : not_a_number();
  if (x == infinity()) return x;
  int e = 0;
  if (x < 2.3e-308) {  // subnormal
    x *= 18014398509481984.0;
    e = -54;
  }
  const auto bits = Kokkos::bit_cast<std::uint64_t>(x);
  e += static_cast<int>(bits >> 52U) - 1023;
  double m = Kokkos::bit_cast<double>((bits & 0xFFFFFFFFFFFFFULL) | 0x3FF0000000000000ULL);
  if (m > 1.4142135623730951) {
    m *= 0.5;
    ++e;
  }
  const double s = (m - 1.0) / (m + 1.0);
  const double s2 = s * s;
  double sum = 0.0;
  for (int k = 23; k >= 1; k -= 2) sum = sum * s2 + 1.0 / k;
  return e * 6.93147180369123816490e-01 + (e * 1.90821492927058770002e-10 + 2.0 * s * sum);
}

/// Argument reduction (Cody and Waite): x minus the nearest multiple of pi/2, in [-pi/4, pi/4], with pi/2 in
/// three parts of 33 bits. `quadrant` is the multiple modulo 4. NaN for |x| > 1e6, where products are not
/// exact.
KOKKOS_INLINE_FUNCTION double reduced_angle(double x, int& quadrant) {
  quadrant = 0;
  if (!(magnitude(x) <= 1e6)) return not_a_number();
  const double q = Kokkos::floor(x * (2.0 / pi) + 0.5);
  quadrant = static_cast<int>(q) & 3;
  const double r = (x - q * 1.57079632673412561417e+00) - q * 6.07710050630396597660e-11;
  return r - q * 2.02226624879595063154e-21;
}

/// Taylor series of sin r for |r| <= pi/4.
KOKKOS_INLINE_FUNCTION double sine_series(double r) {
  const double r2 = r * r;
  double sum = 1.0;
  for (int k = 18; k > 0; k -= 2) sum = 1.0 - r2 / (k * (k + 1)) * sum;
  return r * sum;
}

/// Taylor series of cos r for |r| <= pi/4.
KOKKOS_INLINE_FUNCTION double cosine_series(double r) {
  const double r2 = r * r;
  double sum = 1.0;
  for (int k = 17; k > 0; k -= 2) sum = 1.0 - r2 / (k * (k + 1)) * sum;
  return sum;
}

/// Sine of x (radians); NaN for |x| > 1e6.
KOKKOS_INLINE_FUNCTION double sin(double x) {
  int quadrant = 0;
  const double r = reduced_angle(x, quadrant);
  const double value = (quadrant & 1) != 0 ? cosine_series(r) : sine_series(r);
  return (quadrant & 2) != 0 ? -value : value;
}

/// Cosine of x (radians); NaN for |x| > 1e6.
KOKKOS_INLINE_FUNCTION double cos(double x) {
  int quadrant = 0;
  const double r = reduced_angle(x, quadrant);
  const double value = (quadrant & 1) != 0 ? sine_series(r) : cosine_series(r);
  return quadrant == 1 || quadrant == 2 ? -value : value;
}

/// Arc tangent, radians. Two half-angle steps reduce |x| <= 1 below tan(pi/16), where the series converges in
/// 12 terms.
KOKKOS_INLINE_FUNCTION double atan(double x) {
  const double size = magnitude(x);
  double a = size > 1.0 ? 1.0 / size : size;
  a = a / (1.0 + Kokkos::sqrt(1.0 + a * a));
  a = a / (1.0 + Kokkos::sqrt(1.0 + a * a));
  double sum = 0.0;
  for (int k = 25; k >= 1; k -= 2) sum = 1.0 / k - a * a * sum;
  const double angle = 4.0 * a * sum;
  const double value = size > 1.0 ? pi / 2.0 - angle : angle;
  return x < 0.0 ? -value : value;
}

/// Angle of the point (x, y), radians, in [-pi, pi].
KOKKOS_INLINE_FUNCTION double atan2(double y, double x) {
  if (x == 0.0) return y > 0.0 ? pi / 2.0 : y < 0.0 ? -pi / 2.0 : y;
  const double angle = atan(y / x);
  if (x > 0.0) return angle;
  return y < 0.0 ? angle - pi : angle + pi;
}

/// Arc sine and arc cosine, radians; NaN for |x| > 1.
KOKKOS_INLINE_FUNCTION double asin(double x) { return atan2(x, Kokkos::sqrt((1.0 - x) * (1.0 + x))); }
KOKKOS_INLINE_FUNCTION double acos(double x) { return atan2(Kokkos::sqrt((1.0 - x) * (1.0 + x)), x); }

/// Hyperbolic sine; near 0 a series, because the difference of exponentials cancels.
KOKKOS_INLINE_FUNCTION double sinh(double x) {
  if (magnitude(x) < 0.5) {
    double sum = 1.0;
    for (int k = 12; k > 0; k -= 2) sum = 1.0 + x * x / (k * (k + 1)) * sum;
    return x * sum;
  }
  const double half = 0.5 * exp(0.5 * magnitude(x));  // e^|x| / 2 without early overflow
  const double value = 2.0 * half * half - 0.125 / (half * half);
  return x < 0.0 ? -value : value;
}

/// Hyperbolic cosine.
KOKKOS_INLINE_FUNCTION double cosh(double x) {
  const double half = 0.5 * exp(0.5 * magnitude(x));
  return 2.0 * half * half + 0.125 / (half * half);
}

/// Hyperbolic tangent.
KOKKOS_INLINE_FUNCTION double tanh(double x) {
  if (magnitude(x) > 20.0) return x < 0.0 ? -1.0 : 1.0;
  return sinh(x) / cosh(x);
}

/// Inverse hyperbolic sine.
KOKKOS_INLINE_FUNCTION double asinh(double x) {
  const double a = magnitude(x);
  const double value = a > 1e8 ? log(a) + ln2 : log(a + Kokkos::sqrt(a * a + 1.0));
  return x < 0.0 ? -value : value;
}

/// Inverse hyperbolic cosine; NaN for x < 1.
KOKKOS_INLINE_FUNCTION double acosh(double x) {
  return x > 1e8 ? log(x) + ln2 : log(x + Kokkos::sqrt((x - 1.0) * (x + 1.0)));
}

/// Inverse hyperbolic tangent; NaN for |x| > 1.
KOKKOS_INLINE_FUNCTION double atanh(double x) { return 0.5 * log((1.0 + x) / (1.0 - x)); }

/// x^y: repeated squaring for integers |y| <= 1024, else exp(y log x) with a relative error of 1e-13 |y log
/// x|.
KOKKOS_INLINE_FUNCTION double pow(double x, double y) {
  if (y == Kokkos::floor(y) && magnitude(y) <= 1024.0) {
    double result = 1.0;
    double factor = x;
    for (int n = static_cast<int>(magnitude(y)); n > 0; n /= 2) {
      if (n % 2 == 1) result *= factor;
      factor *= factor;
    }
    return y < 0.0 ? 1.0 / result : result;
  }
  if (x == 0.0) return y > 0.0 ? 0.0 : infinity();
  if (x < 0.0 && y == Kokkos::floor(y)) {
    const bool odd = y - 2.0 * Kokkos::floor(0.5 * y) == 1.0;
    return odd ? -exp(y * log(-x)) : exp(y * log(-x));
  }
  return exp(y * log(x));
}

}  // namespace drogue::device::portable
