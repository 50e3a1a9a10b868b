#pragma once

#include <type_traits>

#include "kernels/device/pack.hpp"

// Nonlinear weights of fifth-order weighted essentially non-oscillatory (WENO) reconstructions, for all
// solvers.

namespace drogue::reconstruction {

/// Reconstruction scheme as a compile-time constant. The Z weights of power 2 are a scheme of their own.
enum class Reconstruction { js, z1, z2, m, teno5 };

template <class R>
struct Indicators {
  R b0, b1, b2;
};

/// Smoothness indicators b_k + epsilon of Jiang and Shu 1996, eq. (3.2)-(3.4), times 3/4, from the four
/// differences of the five stencil values; in the square of the unit of those. Completing the squares, 13 (a
/// - b)^2 + 3 (a - 3 b)^2 = 16 ((a - 11/8 b)^2 + 39/64 b^2) and so on, takes ten operations instead of
/// eighteen.
template <class R>
KOKKOS_INLINE_FUNCTION Indicators<R> smoothness(R a, R b, R c, R d, R epsilon) {
  using S = typename device::Access<R>::Element;
  const R left = a - S(1.375) * b, middle = b - S(0.625) * c, right = d - S(1.375) * c;
  const R b_part = S(0.609375) * (b * b) + epsilon, c_part = S(0.609375) * (c * c) + epsilon;
  return {left * left + b_part, middle * middle + c_part, right * right + c_part};
}

/// Ratios q_k of the weights w_k = d_k q_k / (q_0 + 6 q_1 + 3 q_2) with the linear weights d = (1, 6, 3),
/// multiplied by a common denominator to avoid divisions.
template <Reconstruction scheme, class R>
KOKKOS_INLINE_FUNCTION Indicators<R> weight_ratios(Indicators<R> indicators) {
  using S = typename device::Access<R>::Element;
  const auto [b0, b1, b2] = indicators;
  const R b12 = b1 * b2, b02 = b0 * b2, b01 = b0 * b1;
  if constexpr (scheme == Reconstruction::js || scheme == Reconstruction::m) {
    return {b12 * b12, b02 * b02, b01 * b01};  // 1 / (eps + b_k)^2
  } else if constexpr (scheme == Reconstruction::z1) {
    // Borges et al. 2008, eq. (28): 1 + tau / (b_k + eps)
    const R tau = device::absolute(b0 - b2);
    return {(b0 + tau) * b12, (b1 + tau) * b02, (b2 + tau) * b01};
  } else if constexpr (scheme == Reconstruction::z2) {
    // 1 + (tau / (b_k + eps))^2. Products of six indicators leave the range of a double where a cold gas
    // meets a hot one (Sedov: differences of 1e25). Hence the ratios are scaled below two before squaring. In
    // single precision `correction` has scaled them already.
    const R tau = device::absolute(b0 - b2);
    R all = b0 * b12, q0 = tau * b12, q1 = tau * b02, q2 = tau * b01;
    if constexpr (!std::is_same_v<S, float>) {
      const R inverse = device::binary_reciprocal((all + q0) + (q1 + q2));
      all = all * inverse, q0 = q0 * inverse, q1 = q1 * inverse, q2 = q2 * inverse;
    }
    const R all2 = all * all;
    return {all2 + q0 * q0, all2 + q1 * q1, all2 + q2 * q2};
  } else {
    // Fu, Hu and Adams 2016, eq. (14)-(17). The sixth power of the ratio overflows for smooth data because
    // eps is tiny, so the ratios are first scaled below two. The cut-off compares g_k with their sum. This
    // decision needs only six digits; double precision took a seventh of the run time.
    using Single = typename device::SingleOf<R>::Type;
    using F = typename device::Access<Single>::Element;
    const R tau = device::absolute(b0 - b2);
    const R q0 = (b0 + tau) * b12, q1 = (b1 + tau) * b02, q2 = (b2 + tau) * b01;
    const R inverse = device::binary_reciprocal(q0 + (q1 + q2));
    const auto sixth = [](R ratio) {
      const Single r = device::Convert<Single>::from(ratio), cube = r * r * r;
      return cube * cube;
    };
    const Single g0 = sixth(q0 * inverse), g1 = sixth(q1 * inverse), g2 = sixth(q2 * inverse);
    const Single cut = F(1e-5) * (g0 + g1 + g2);
    const auto kept = [&](Single g) {
      return device::Convert<R>::from(device::select(g < cut, Single(F(0)), Single(F(1))));
    };
    return {kept(g0), kept(g1), kept(g2)};
  }
}

}  // namespace drogue::reconstruction
