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

/// Sine of x (radians); NaN for |x| > 1e6, which spares kernels of known arguments the code of `wide_sin`.
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

/// Argument reduction (Payne and Hanek) in integers, as `reduced_angle`, for 2^19 <= |x| < infinity: of x
/// 2/pi only the bits of the fraction and of the quadrant are computed, to 2^-64.
KOKKOS_INLINE_FUNCTION double reduced_large_angle(double x, int& quadrant) {
  constexpr int used = 5;  // words of 2/pi beyond those that contribute multiples of four quadrants
  constexpr std::uint32_t two_over_pi[] = {
      0xA2F9836EU, 0x4E441529U, 0xFC2757D1U, 0xF534DDC0U, 0xDB629599U, 0x3C439041U, 0xFE5163ABU,
      0xDEBBC561U, 0xB7246E3AU, 0x424DD2E0U, 0x06492EEAU, 0x09D1921CU, 0xFE1DEB1CU, 0xB129A73EU,
      0xE88235F5U, 0x2EBB4484U, 0xE99C7026U, 0xB45F7E41U, 0x3991D639U, 0x835339F4U, 0x9C845F8BU,
      0xBDF9283BU, 0x1FF897FFU, 0xDE05980FU, 0xEF2F118BU, 0x5A0A6D1FU, 0x6D367ECFU, 0x27CB09B7U,
      0x4F463F66U, 0x9E5FEA2DU, 0x7527BAC7U, 0xEBE5F17BU, 0x3D0739F7U, 0x8A5292EAU, 0x6BFB5FB1U};
  const auto bits = Kokkos::bit_cast<std::uint64_t>(x);
  const std::uint64_t mantissa = (bits & 0xFFFFFFFFFFFFFULL) | 0x10000000000000ULL;
  const int exponent = static_cast<int>(bits >> 52U & 0x7FFU) - 1075;  // |x| = mantissa 2^exponent
  const int first = exponent < 2 ? 0 : (exponent - 2) / 32;
  std::uint64_t product[used + 3] = {};  // words of 32 bits, the least one first
  for (int i = 0; i < used; ++i) {
    const std::uint64_t word = two_over_pi[first + used - 1 - i];
    const std::uint64_t low = word * (mantissa & 0xFFFFFFFFU) + product[i];
    const std::uint64_t high = word * (mantissa >> 32U) + product[i + 1] + (low >> 32U);
    product[i] = low & 0xFFFFFFFFU;
    product[i + 1] = high & 0xFFFFFFFFU;
    product[i + 2] = high >> 32U;
  }
  const int point = 32 * (first + used) - exponent;  // bits after the binary point: 127 to 193
  const auto bits_from = [&product](int at) {
    const int word = at / 32, shift = at % 32;
    const std::uint64_t low = (product[word] | product[word + 1] << 32U) >> shift;
    return shift == 0 ? low : low | product[word + 2] << (64 - shift);
  };
  const std::uint64_t fraction = bits_from(point - 64);
  // The nearest multiple is the next one where the fraction is a half or more, which then is negative.
  const auto nearest = static_cast<int>((bits_from(point - 1) + 1U) >> 1U & 3U);
  const double r = static_cast<double>(static_cast<std::int64_t>(fraction)) * 0x1p-64 * (0.5 * pi);
  quadrant = x < 0.0 ? (4 - nearest) & 3 : nearest;
  return x < 0.0 ? -r : r;
}

/// Argument reduction as `reduced_angle`; NaN unless x is finite.
KOKKOS_INLINE_FUNCTION double reduced_wide_angle(double x, int& quadrant) {
  const bool is_large = magnitude(x) > 1e6 && magnitude(x) < infinity();
  return is_large ? reduced_large_angle(x, quadrant) : reduced_angle(x, quadrant);
}

// Written out as `sin` and `cos` are: with a function in common, the compiler fused those otherwise from one
// instance of a backend to the next, and options had other bits.
/// Sine of any finite x (radians), the same as `sin` as far as that goes.
KOKKOS_INLINE_FUNCTION double wide_sin(double x) {
  int quadrant = 0;
  const double r = reduced_wide_angle(x, quadrant);
  const double value = (quadrant & 1) != 0 ? cosine_series(r) : sine_series(r);
  return (quadrant & 2) != 0 ? -value : value;
}

/// Cosine of any finite x (radians), the same as `cos` as far as that goes.
KOKKOS_INLINE_FUNCTION double wide_cos(double x) {
  int quadrant = 0;
  const double r = reduced_wide_angle(x, quadrant);
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
