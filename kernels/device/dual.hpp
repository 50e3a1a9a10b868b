#pragma once

#include "kernels/device/pack.hpp"

namespace drogue::device {

/// A number and its derivative in one direction (forward differentiation, Wengert 1964): a point function of
/// it gives what the direction does to its value, exactly.
struct Dual {
  double value = 0.0, derivative = 0.0;

  Dual() = default;
  KOKKOS_INLINE_FUNCTION Dual(double v) : value(v) {}  // NOLINT: numbers mix with duals as with numbers
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

/// At zero its derivative is taken as zero, so that what is multiplied by it stays finite.
KOKKOS_INLINE_FUNCTION Dual square_root(const Dual& a) {
  const double root = square_root(a.value);
  return {root, root > 0.0 ? 0.5 * a.derivative / root : 0.0};
}

}  // namespace drogue::device
