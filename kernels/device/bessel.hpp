#pragma once

#include "kernels/device/portable_math.hpp"

namespace drogue::device::portable {

/// J_0 (order 0) or J_1 (order 1) for x >= 30 by Hankel's asymptotic expansion (Abramowitz and
/// Stegun, 9.2.5), truncated at terms below 1e-18.
KOKKOS_INLINE_FUNCTION double bessel_far(int order, double x) {
  const double mu = 4.0 * order * order;
  double p = 1.0;
  double q = 0.0;
  double term = 1.0;
  for (int k = 1; k <= 20 && magnitude(term) > 1e-18; ++k) {
    const double odd = 2.0 * k - 1.0;
    term *= (mu - odd * odd) / (8.0 * k * x);
    if (k % 2 == 1) {
      q += k % 4 == 1 ? term : -term;
    } else {
      p += k % 4 == 0 ? term : -term;
    }
  }
  // cos and sin of x - pi/4 (- pi/2) by the addition theorems: computing the difference would round it.
  const double root = Kokkos::sqrt(0.5);
  const double c = (wide_cos(x) + wide_sin(x)) * root;
  const double s = (wide_sin(x) - wide_cos(x)) * root;
  const double cosine = order == 0 ? c : s;
  const double sine = order == 0 ? s : -c;
  return Kokkos::sqrt(2.0 / (pi * x)) * (p * cosine - q * sine);
}

/// J_n for 0 <= x below about n + 30 by Miller's backward recurrence, normalised by J_0 + 2 sum J_2k = 1.
KOKKOS_INLINE_FUNCTION double bessel_backward(int n, double x) {
  if (x == 0.0) return n == 0 ? 1.0 : 0.0;
  const int above = n > static_cast<int>(x) ? n : static_cast<int>(x);
  int k = 2 * ((above + 40 + static_cast<int>(4.0 * Kokkos::sqrt(static_cast<double>(above)))) / 2);
  double next = 0.0;
  double value = 1e-300;  // J_k up to a factor
  double sum = 0.0;
  double unnormalized = 0.0;
  for (; k > 0; --k) {
    const double previous = 2.0 * k / x * value - next;
    if (k == n) unnormalized = value;
    if (k % 2 == 0) sum += 2.0 * value;
    next = value;
    value = previous;
    if (magnitude(value) > 1e200) {
      constexpr double scale = 1e-200;
      value *= scale;
      next *= scale;
      sum *= scale;
      unnormalized *= scale;
    }
  }
  if (n == 0) unnormalized = value;
  return unnormalized / (sum + value);
}

/// J_n(x) for integer orders |n| <= 1000 and finite x; NaN otherwise.
KOKKOS_INLINE_FUNCTION double besselj(double order, double x) {
  if (order != Kokkos::floor(order) || !(magnitude(order) <= 1000.0)) return not_a_number();
  const int n = static_cast<int>(magnitude(order));
  const bool flips = n % 2 == 1 && (order < 0.0) != (x < 0.0);  // J_-n(x) = J_n(-x) = (-1)^n J_n(x)
  const double a = magnitude(x);
  if (!(a < infinity())) return not_a_number();
  double value = 0.0;
  if (a < 30.0 || n > a) {
    value = bessel_backward(n, a);
  } else {
    double below = bessel_far(0, a);
    value = n == 0 ? below : bessel_far(1, a);
    for (int k = 1; k < n; ++k) {  // forward recurrence is stable while k < x
      const double above = 2.0 * k / a * value - below;
      below = value;
      value = above;
    }
  }
  return flips ? -value : value;
}

}  // namespace drogue::device::portable
