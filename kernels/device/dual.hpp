#pragma once

#include "kernels/device/pack.hpp"

namespace drogue::device {

/// Dual number: a value and its derivative along one direction (forward-mode differentiation, Wengert 1964).
/// A point function of duals yields the exact directional derivative of its value.
struct Dual {
  double value = 0.0, derivative = 0.0;

  Dual() = default;
  /// Constant: the derivative is zero.
  KOKKOS_INLINE_FUNCTION Dual(double v) : value(v) {}  // NOLINT: numbers mix with duals as with numbers
  /// Value and derivative.
  KOKKOS_INLINE_FUNCTION Dual(double v, double d) : value(v), derivative(d) {}

  friend KOKKOS_INLINE_FUNCTION Dual operator+(const Dual& a, const Dual& b) {
    return {a.value + b.value, a.derivative + b.derivative};
  }
  friend KOKKOS_INLINE_FUNCTION Dual operator-(const Dual& a, const Dual& b) {
    return {a.value - b.value, a.derivative - b.derivative};
  }
  friend KOKKOS_INLINE_FUNCTION Dual operator*(const Dual& a, const Dual& b) {
    return {a.value * b.value, a.derivative * b.value + a.value * b.derivative};
  }
  friend KOKKOS_INLINE_FUNCTION Dual operator/(const Dual& a, const Dual& b) {
    const double quotient = a.value / b.value;
    return {quotient, (a.derivative - quotient * b.derivative) / b.value};
  }
  friend KOKKOS_INLINE_FUNCTION bool operator>(const Dual& a, const Dual& b) { return a.value > b.value; }
  friend KOKKOS_INLINE_FUNCTION bool operator>=(const Dual& a, const Dual& b) { return a.value >= b.value; }
};

/// Square root; its derivative at zero is defined as zero, to keep products with it finite.
KOKKOS_INLINE_FUNCTION Dual square_root(const Dual& a) {
  const double root = square_root(a.value);
  return {root, root > 0.0 ? 0.5 * a.derivative / root : 0.0};
}

}  // namespace drogue::device
