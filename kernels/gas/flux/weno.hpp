#pragma once

#include <type_traits>

#include "kernels/device/pack.hpp"
#include "kernels/gas/parameters.hpp"

namespace drogue::gas {

/// Reconstruction scheme as a compile-time constant. The Z weights of power 2 are a scheme of their own.
enum class Reconstruction { js, z1, z2, m, teno5 };

/// Scale of the characteristic differences passed to the reconstruction, relative to l.d(F +- alpha U)/2 with
/// the normalised left eigenvector l. The splitting omits its 1/2, and the acoustic eigenvectors carry a
/// factor 2.
inline constexpr int acoustic_scale = 4, entropy_scale = 2;

/// Factor by which `correction` exceeds the true correction. It saves all divisions but the one of the
/// weights.
inline constexpr int correction_scale = 3;

template <class R>
struct Indicators {
  R b0, b1, b2;
};

/// Smoothness indicators b_k + epsilon of Jiang and Shu 1996, eq. (3.2)-(3.4), times 3/4, from the four
/// differences of the five stencil values. Completing the squares, 13 (a - b)^2 + 3 (a - 3 b)^2 = 16 ((a -
/// 11/8 b)^2 + 39/64 b^2) and so on, takes ten operations instead of eighteen.
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

/// Mapped weight of Henrick, Aslam and Powers 2005, eq. (24), for the linear weight `d`; dimensionless. Does
/// not throw.
template <class R, class S>
KOKKOS_INLINE_FUNCTION R mapped(R w, S d) {
  return w * (S(d + d * d) + w * (w - S(3) * d)) / (S(d * d) + w * S(S(1) - S(2) * d));
}

/// Fifth-order correction phi to the fourth-order central flux from one side, times `correction_scale`: w_0/3
/// (a - 2b + c) + (w_2 - 1/2)/6 (b - 2c + d). The four characteristic differences are in units of `scale`
/// times `unit`, and epsilon is scaled likewise. Jiang and Shu 1996, eq. (2.17) in difference form.
template <Reconstruction scheme, int scale, class R>
KOKKOS_INLINE_FUNCTION R correction(R a, R b, R c, R d, R unit) {
  using S = typename device::Access<R>::Element;
  constexpr bool single = std::is_same_v<S, float>;
  constexpr double indicator_scale = 0.75 * scale * scale;  // see `smoothness`
  // The floor keeps the fourth power of epsilon (JS, M), or its third power, a normal number in the coldest
  // gas. It underflows in single precision, where later code does not need it.
  constexpr bool fourth = scheme == Reconstruction::js || scheme == Reconstruction::m;
  constexpr double floor_of_epsilon = single ? 0.0 : fourth ? 1e-75 : 1e-100;
  R epsilon = S((scheme == Reconstruction::js ? 1e-6 : 1e-40) * indicator_scale) * (unit * unit) +
              S(floor_of_epsilon);
  R ka = a, kb = b, kc = c, kd = d;
  if constexpr (single) {
    // The products of indicators leave the range of a float, so the largest difference is first scaled to [2,
    // 4). The floor keeps a constant stencil finite; it is 1e-6 for JS, whose absolute eps is far larger than
    // such a stencil. The smallest product of powers of eps (Z, p = 2: the sixth) must stay a normal number.
    const R largest = device::maximum(device::maximum(device::absolute(a), device::absolute(b)),
                                      device::maximum(device::absolute(c), device::absolute(d)));
    const R floor = scheme == Reconstruction::js ? 1e-6F * unit : R(1e-30F);
    const R inverse = S(2) * device::binary_reciprocal(device::maximum(largest, floor));
    ka = a * inverse, kb = b * inverse, kc = c * inverse, kd = d * inverse;
    if constexpr (scheme == Reconstruction::js)
      epsilon = epsilon * inverse * inverse + S(1e-9);
    else
      epsilon = R(scheme == Reconstruction::z2 ? 2e-6F : 2e-7F);
  }
  Indicators<R> q = weight_ratios<scheme>(smoothness(ka, kb, kc, kd, epsilon));
  R sum = q.b0 + (S(6) * q.b1 + S(3) * q.b2);
  if constexpr (scheme == Reconstruction::m) {
    const R inverse = device::reciprocal(sum);
    q = {mapped(q.b0 * inverse, S(0.1)), mapped(S(6) * q.b1 * inverse, S(0.6)),
         mapped(S(3) * q.b2 * inverse, S(0.3))};
    sum = q.b0 + q.b1 + q.b2;
    q.b2 = S(1.0 / 3.0) * q.b2;
  }
  // w_0 (a - 2b + c) + (2 w_2 - 1) / 4 (b - 2c + d). In double precision the division comes last, so that few
  // operations depend on it; the products of JS are of ninth degree and allow differences up to 1e33. In
  // single precision the weights are normalised first, because q may be close to the largest float.
  const R inverse = device::reciprocal(sum);
  const R first = a - S(2) * b + c, last = b - S(2) * c + d;
  if constexpr (single)
    return (q.b0 * inverse) * first + (S(1.5) * (q.b2 * inverse) - S(0.25)) * last;
  else
    return inverse * (q.b0 * first + S(1.5) * (q.b2 * last)) - S(0.25) * last;
}

}  // namespace drogue::gas
