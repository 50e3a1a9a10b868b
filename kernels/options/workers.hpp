#pragma once

#include "kernels/device/pack.hpp"

/// The threads that price one option, and what they do together. All arithmetic is cut into 32 lanes, so that
/// a warp and a host thread, which takes the lanes in turn, round alike.
namespace drogue::options {

inline constexpr int lanes = 32;

/// One host thread, which prices a pack of options, `R`.
template <class R>
struct SerialWorkers {
  template <class F>
  KOKKOS_INLINE_FUNCTION void each(const F& f) const {
    for (int lane = 0; lane < lanes; ++lane) f(lane);
  }
  KOKKOS_INLINE_FUNCTION void meet() const {}
};

/// A warp that is a team of its own.
template <class Member>
struct WarpWorkers {
  const Member& member;

  /// Runs f(lane) on every lane; what they wrote is seen by all after it.
  template <class F>
  KOKKOS_INLINE_FUNCTION void each(const F& f) const {
    f(static_cast<int>(member.team_rank()));
    meet();
  }
  /// What all have read before it may be written after it.
  KOKKOS_INLINE_FUNCTION void meet() const { member.team_barrier(); }
};

/// The sum of slot[0 .. lanes-1], in order; every lane gets it.
template <class R>
KOKKOS_INLINE_FUNCTION R total(const R* slot) {
  R sum = slot[0];
  for (int k = 1; k < lanes; ++k) sum += slot[k];
  return sum;
}

/// y_i = a_i + g y_{i+1} for i = first .. first + lanes block - 1 in place, from 0 beyond: each lane runs
/// through its block, then blocks are joined by doubling (Kogge and Stone). `slot` holds 2 lanes values.
template <class Workers, class R>
KOKKOS_INLINE_FUNCTION void recur_backward(const Workers& workers, R* y, int first, int block, R g, R* slot) {
  R joined = 1.0;
  for (int m = 0; m < block; ++m) joined = joined * g;
  workers.each([=](int lane) {
    R* own = y + first + lane * block;
    R value = 0.0;
    for (int m = block - 1; m >= 0; --m) {
      value = own[m] + g * value;
      own[m] = value;
    }
    slot[lane] = value;
  });
  R *from = slot, *to = slot + lanes;
  for (int reach = 1; reach < lanes; reach *= 2) {
    workers.each([=](int lane) {
      to[lane] = lane + reach < lanes ? from[lane] + joined * from[lane + reach] : from[lane];
    });
    joined = joined * joined;
    R* const other = from;
    from = to;
    to = other;
  }
  workers.each([=](int lane) {
    if (lane + 1 == lanes) return;
    R* own = y + first + lane * block;
    R inflow = from[lane + 1];
    for (int m = block - 1; m >= 0; --m) {
      inflow = g * inflow;
      own[m] = own[m] + inflow;
    }
  });
}

/// x -> min(hi, max(lo, a x + b)), a known to all. Such maps compose to maps of their kind, whatever a's
/// sign.
template <class R>
struct ClampedMap {
  R b, lo, hi;
};

/// `second` after `first`; a2 is the slope of `second`.
template <class R>
KOKKOS_INLINE_FUNCTION ClampedMap<R> after(const ClampedMap<R>& second, R a2, const ClampedMap<R>& first) {
  const R low = device::maximum(second.lo, device::minimum(second.hi, a2 * first.lo + second.b));
  const R high = device::maximum(second.lo, device::minimum(second.hi, a2 * first.hi + second.b));
  return {a2 * first.b + second.b, device::minimum(low, high), device::maximum(low, high)};
}

/// Stands for no bound; its products with a slope stay finite.
inline constexpr double unbounded = 1e200;

/// x_i = max(floor_i, a x_{i-1} + y_i) for the nodes of all blocks, x_{first-1} = inflow given; 0 from node
/// `end` on. `slot` holds 2 lanes maps.
template <class Workers, class R>
KOKKOS_INLINE_FUNCTION void recur_forward(const Workers& workers, R* x, const R* y, const R* floor, int first,
                                          int block, int end, R a, R inflow, ClampedMap<R>* slot) {
  R joined = 1.0;
  for (int m = 0; m < block; ++m) joined = joined * a;
  workers.each([=](int lane) {
    const int begin = first + lane * block;
    ClampedMap<R> map{y[begin], floor[begin], R(unbounded)};
    for (int m = 1; m < block; ++m)
      map = after(ClampedMap<R>{y[begin + m], floor[begin + m], R(unbounded)}, a, map);
    slot[lane] = map;
  });
  ClampedMap<R>*from = slot, *to = slot + lanes;
  for (int reach = 1; reach < lanes; reach *= 2) {
    workers.each([=](int lane) {
      to[lane] = lane >= reach ? after(from[lane], joined, from[lane - reach]) : from[lane];
    });
    joined = joined * joined;
    ClampedMap<R>* const other = from;
    from = to;
    to = other;
  }
  R across = 1.0;
  for (int m = 0; m < block; ++m) across = across * a;
  workers.each([=](int lane) {
    const int begin = first + lane * block;
    R value = inflow;
    if (lane > 0) {
      R slope = 1.0, power = across;  // of the maps of all lanes before: across^lane
      for (int bits = lane; bits != 0; bits /= 2) {
        if (bits % 2 == 1) slope = slope * power;
        power = power * power;
      }
      const ClampedMap<R> map = from[lane - 1];
      value = device::maximum(map.lo, device::minimum(map.hi, slope * inflow + map.b));
    }
    for (int m = 0; m < block; ++m) {
      value = device::maximum(floor[begin + m], a * value + y[begin + m]);
      x[begin + m] = begin + m < end ? value : R(0.0);
    }
  });
}

}  // namespace drogue::options
