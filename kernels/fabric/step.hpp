#pragma once

#include "kernels/fabric/watch.hpp"

namespace drogue::fabric {

/// One stage of the classical Runge-Kutta method (Kutta 1901) on x' = v, v' = a(x, v): the velocities' sum
/// needs accelerations alone, x_{n+1} = x_n + dt v_n + dt^2/6 (a_1 + a_2 + a_3).
template <class ExecutionSpace, Law law>
struct RungeKuttaFunctor {
  using R = std::conditional_t<device::is_host<ExecutionSpace>, device::HostPack<double>, double>;
  using Points = PointsView<ExecutionSpace>;
  static constexpr int lanes = device::Access<R>::lanes;

  Cloth<ExecutionSpace> cloth;
  Points x, v;          ///< of step n; the last stage replaces them
  Points at, velocity;  ///< of this stage
  Points next;          ///< positions of the next stage
  Points sum_x, sum_v;  ///< a_1 + a_2 + a_3 and a_1 + 2 a_2 + 2 a_3 + a_4
  Watch<ExecutionSpace> watch;
  double dt;
  int stage;

  KOKKOS_FUNCTION void operator()(const int pack) const {
    const int i = pack * lanes;
    const Vector3<R> v_n = load_points<R>(v, i);
    const Vector3<R> v_now = stage == 0 ? v_n : load_points<R>(velocity, i);
    const Vector3<R> a = acceleration<law, R>(cloth, at, v_now, i);
    const Vector3<R> x_n = load_points<R>(x, i);
    if (stage == 3) {
      const Vector3<R> x_end = x_n + dt * v_n + (dt * dt / 6.0) * load_points<R>(sum_x, i);
      const Vector3<R> v_end = v_n + (dt / 6.0) * (load_points<R>(sum_v, i) + a);
      store_points(x, i, x_end);
      store_points(v, i, v_end);
      const std::int64_t step = watch.steps(1) + 1;
      watch.look(step, i, x_end, v_end);
      if (pack == 0) watch.steps(0) = step;
      return;
    }
    if (stage == 1 && pack == 0) watch.steps(1) = watch.steps(0);
    const double part = stage == 2 ? dt : 0.5 * dt;
    store_points(next, i, x_n + part * v_now);
    store_points(velocity, i, v_n + part * a);
    store_points(sum_x, i, stage == 0 ? a : load_points<R>(sum_x, i) + a);
    store_points(sum_v, i, stage == 0 ? a : load_points<R>(sum_v, i) + 2.0 * a);
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
    const Vector3<R> a = acceleration<law, R>(cloth, x, velocity, i), free = load_points<R>(cloth.free, i);
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
