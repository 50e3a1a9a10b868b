#pragma once

#include <Kokkos_Core.hpp>

namespace drogue::options {

/// Complex number, or one per option of a pack; of doubles it is aligned for a single load or store.
template <class R>
struct alignas(alignof(R) > 16 ? alignof(R) : 16) ComplexNumber {
  R re, im;

  KOKKOS_INLINE_FUNCTION friend ComplexNumber operator+(const ComplexNumber& a, const ComplexNumber& b) {
    return {a.re + b.re, a.im + b.im};
  }
  KOKKOS_INLINE_FUNCTION friend ComplexNumber operator-(const ComplexNumber& a, const ComplexNumber& b) {
    return {a.re - b.re, a.im - b.im};
  }
};

template <class R, class S>
KOKKOS_INLINE_FUNCTION ComplexNumber<R> product(const ComplexNumber<R>& a, const ComplexNumber<S>& b) {
  return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}

/// a times the complex conjugate of b.
template <class R, class S>
KOKKOS_INLINE_FUNCTION ComplexNumber<R> times_conjugate(const ComplexNumber<R>& a,
                                                        const ComplexNumber<S>& b) {
  return {a.re * b.re + a.im * b.im, a.im * b.re - a.re * b.im};
}

/// sign i a.
template <int sign, class R>
KOKKOS_INLINE_FUNCTION ComplexNumber<R> times_i(const ComplexNumber<R>& a) {
  if constexpr (sign > 0) return {-a.im, a.re};
  return {a.im, -a.re};
}

}  // namespace drogue::options
