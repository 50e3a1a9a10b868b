#pragma once

#include "kernels/fabric/watch.hpp"

namespace drogue::fabric {

/// The share of dt that leads from the beginning of a step to the stage after this one.
KOKKOS_INLINE_FUNCTION double share_after(int stage) { return stage == 2 ? 1.0 : 0.5; }

/// The position at the end of a step of the classical Runge-Kutta method (Kutta 1901) on x' = v, v' = a(x,
/// v), from the velocities of its stages, which lie in memory anyway: sums of accelerations would be read and
/// written in every stage.
template <class R>
KOKKOS_INLINE_FUNCTION Vector3<R> end_position(double dt, const Vector3<R>& x, const Vector3<R>& v,
                                               const Vector3<R>& v2, const Vector3<R>& v3,
                                               const Vector3<R>& v4) {
  return x + (dt / 6.0) * (v + 2.0 * (v2 + v3) + v4);
}

/// The velocity, from the last acceleration too.
template <class R>
KOKKOS_INLINE_FUNCTION Vector3<R> end_velocity(double dt, const Vector3<R>& v, const Vector3<R>& v2,
                                               const Vector3<R>& v3, const Vector3<R>& v4,
                                               const Vector3<R>& a4) {
  // Differences first: what a third lacks must not slow a vertex that nothing pulls.
  const Vector3<R> gained = (v2 - v) + 2.0 * (v3 - v) + (v4 - v);
  return v + ((1.0 / 3.0) * gained + (dt / 6.0) * a4);
}

/// One stage of it.
template <class ExecutionSpace, Law law>
struct RungeKuttaFunctor {
  using R = std::conditional_t<device::is_host<ExecutionSpace>, device::HostPack<double>, double>;
  using Points = PointsView<ExecutionSpace>;
  static constexpr int lanes = device::Access<R>::lanes;

  Cloth<ExecutionSpace> cloth;
  Points x, v;         ///< of step n; the last stage replaces them
  Points at, next;     ///< positions of this stage and of the next one
  Points velocity[3];  ///< of the stages after the first
  Watch<ExecutionSpace> watch;
  double dt;
  int stage;

  KOKKOS_FUNCTION void operator()(const int pack) const {
    const int i = pack * lanes;
    // What the sum over neighbours does not need is read behind it: its registers are what limits the
    // threads.
    const Vector3<R> pull = force<law, R>(cloth, at, i), v_n = load_points<R>(v, i);
    const Vector3<R> v_now = stage == 0 ? v_n : load_points<R>(velocity[stage - 1], i);
    const Vector3<R> a = acceleration(cloth, pull, v_now, i), x_n = load_points<R>(x, i);
    if (stage == 3) {
      const Vector3<R> v2 = load_points<R>(velocity[0], i), v3 = load_points<R>(velocity[1], i),
                       end_x = end_position(dt, x_n, v_n, v2, v3, v_now),
                       end_v = end_velocity(dt, v_n, v2, v3, v_now, a);
      store_points(x, i, end_x);
      store_points(v, i, end_v);
      const std::int64_t step = watch.steps(1) + 1;
      watch.look(step, i, end_x, end_v);
      if (pack == 0) watch.steps(0) = step;
      return;
    }
    if (stage == 1 && pack == 0) watch.steps(1) = watch.steps(0);
    const double part = share_after(stage) * dt;
    store_points(next, i, x_n + part * v_now);
    store_points(velocity[stage], i, v_n + part * a);
  }
};

/// Velocity Verlet (Swope et al. 1982) with one force a step: half a kick that ends the step before, half a
/// kick that begins the next, and its drift. Damping is taken at the middle of half a kick. However steps are
/// cut into launches, the same operations follow one another.
template <class ExecutionSpace, Law law>
struct VerletFunctor {
  using R = std::conditional_t<device::is_host<ExecutionSpace>, device::HostPack<double>, double>;
  using Points = PointsView<ExecutionSpace>;
  static constexpr int lanes = device::Access<R>::lanes;

  Cloth<ExecutionSpace> cloth;  ///< its damping is zero
  Points x, v, next;            ///< `next` receives the positions
  Watch<ExecutionSpace> watch;
  double damping, dt;
  int hand;           ///< of the watch, that tells the steps taken
  bool ends, begins;  ///< a step
  bool drifts;        ///< or another kernel does it

  KOKKOS_FUNCTION void operator()(const int pack) const {
    const int i = pack * lanes;
    Vector3<R> velocity = load_points<R>(v, i);
    const Vector3<R> a = acceleration(cloth, force<law, R>(cloth, x, i), velocity, i),
                     free = free_axes<R>(cloth, i);
    const Vector3<R> position = load_points<R>(x, i);
    const std::int64_t step = watch.steps(hand);
    if (ends) {
      velocity = kicked(velocity, a, free);
      watch.look(step, i, position, velocity);
    }
    if (begins) {
      velocity = kicked(velocity, a, free);
      if (drifts) store_points(next, i, position + dt * velocity);
      if (pack == 0) watch.steps(1 - hand) = step + 1;
    }
    store_points(v, i, velocity);
  }

  /// Half a kick later; a pinned axis keeps its velocity.
  KOKKOS_FUNCTION Vector3<R> kicked(const Vector3<R>& now, const Vector3<R>& a,
                                    const Vector3<R>& free) const {
    const double kick = 0.5 * dt, half = 0.5 * damping * kick;
    const double keep = (1.0 - half) / (1.0 + half), gain = kick / (1.0 + half);
    const auto along = [&](R velocity, R acceleration, R is_free) {
      return device::select(is_free > R(0.0), keep * velocity, velocity) + gain * acceleration;
    };
    return {along(now.x, a.x, free.x), along(now.y, a.y, free.y), along(now.z, a.z, free.z)};
  }
};

}  // namespace drogue::fabric
