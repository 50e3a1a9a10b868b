#pragma once

#include "kernels/device/memory.hpp"
#include "kernels/device/pack.hpp"
#include "kernels/flow/schemes.hpp"
#include "kernels/reconstruction/weno_weights.hpp"

namespace drogue::flow {

/// Value or pack of consecutive values of a field that the kernel does not write.
template <class R>
KOKKOS_INLINE_FUNCTION R load_field(const double* pointer) {
  if constexpr (std::is_same_v<R, double>)
    return device::load_constant(pointer);
  else
    return device::Access<R>::load(pointer);
}

/// Value at the face between q0 and p1 from the cells m2, m1, q0 on the upwind side and p1, p2 on the other,
/// fifth order in smooth flow. Jiang and Shu 1996, eq. (2.17), in difference form with one division:
/// (2 m2 - 13 m1 + 47 q0 + 27 p1 - 3 p2) / 60 for the linear weights (1, 6, 3) / 10. `epsilon` is in units of
/// q^2.
template <Advection scheme, class R>
KOKKOS_INLINE_FUNCTION R upwind_face_value(R m2, R m1, R q0, R p1, R p2, R epsilon) {
  static_assert(scheme == Advection::weno_js || scheme == Advection::weno_z, "no weights of this scheme");
  const R a = m1 - m2, b = q0 - m1, c = p1 - q0, d = p2 - p1;
  constexpr reconstruction::Reconstruction weights =
      scheme == Advection::weno_js ? reconstruction::Reconstruction::js : reconstruction::Reconstruction::z1;
  const reconstruction::Indicators<R> r =
      reconstruction::weight_ratios<weights>(reconstruction::smoothness(a, b, c, d, epsilon));
  // Candidates minus q0, times 6: -2a+5b, b+2c, 4c-d.
  const R w1 = 6.0 * r.b1, w2 = 3.0 * r.b2;
  const R sum = r.b0 + (w1 + w2);
  const R increment = r.b0 * (5.0 * b - 2.0 * a) + (w1 * (b + 2.0 * c) + w2 * (4.0 * c - d));
  return q0 + increment * device::reciprocal(6.0 * sum);
}

/// Advective flux `speed` q through a face, from the six cells q[-3] .. q[2] around it (`q` points at the
/// first cell behind the face, `stride` numbers apart), m^2/s^2 if q is a velocity.
template <Advection scheme, class R>
KOKKOS_INLINE_FUNCTION R advective_flux(R speed, const double* q, std::int64_t stride, R epsilon) {
  const R q_m1 = load_field<R>(q - stride), q_0 = load_field<R>(q);
  if constexpr (scheme == Advection::central) {
    return speed * (0.5 * (q_m1 + q_0));
  } else {
    const R q_m3 = load_field<R>(q - 3 * stride), q_m2 = load_field<R>(q - 2 * stride),
            q_1 = load_field<R>(q + stride), q_2 = load_field<R>(q + 2 * stride);
    const auto forward = speed > R(0.0);
    return speed *
           upwind_face_value<scheme>(device::select(forward, q_m3, q_2), device::select(forward, q_m2, q_1),
                                     device::select(forward, q_m1, q_0), device::select(forward, q_0, q_m1),
                                     device::select(forward, q_1, q_m2), epsilon);
  }
}

}  // namespace drogue::flow
