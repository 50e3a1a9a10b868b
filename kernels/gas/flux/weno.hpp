#pragma once

#include <type_traits>

#include "kernels/device/pack.hpp"
#include "kernels/gas/parameters.hpp"
#include "kernels/reconstruction/weno_weights.hpp"

namespace drogue::gas {

using reconstruction::Indicators;
using reconstruction::Reconstruction;

/// Scale of the characteristic differences passed to the reconstruction, relative to l.d(F +- alpha U)/2 with
/// the normalised left eigenvector l. The splitting omits its 1/2, and the acoustic eigenvectors carry a
/// factor 2.
inline constexpr int acoustic_scale = 4, entropy_scale = 2;

/// Factor by which `correction` exceeds the true correction. It saves all divisions but the one of the
/// weights.
inline constexpr int correction_scale = 3;

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
  constexpr double indicator_scale = 0.75 * scale * scale;  // see `reconstruction::smoothness`
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
  Indicators<R> q =
      reconstruction::weight_ratios<scheme>(reconstruction::smoothness(ka, kb, kc, kd, epsilon));
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
