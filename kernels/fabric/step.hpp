#pragma once

#include "kernels/fabric/cloth.hpp"

namespace drogue::fabric {

/// One stage of the classical Runge-Kutta method (Kutta 1901) on x' = v, v' = a(x, v): the velocities' sum
/// needs accelerations alone, x_{n+1} = x_n + dt v_n + dt^2/6 (a_1 + a_2 + a_3).
template <class ExecutionSpace, Model model>
struct RungeKuttaFunctor {
  using R = std::conditional_t<device::is_host<ExecutionSpace>, device::HostPack<double>, double>;
  using Points = PointsView<ExecutionSpace>;
  static constexpr int lanes = device::Access<R>::lanes;

  Cloth<ExecutionSpace> cloth;
  Points x, v;          ///< of step n; the last stage replaces them
  Points at, velocity;  ///< of this stage
  Points next;          ///< positions of the next stage
  Points sum_x, sum_v;  ///< a_1 + a_2 + a_3 and a_1 + 2 a_2 + 2 a_3 + a_4
  double dt;
  int stage;

  KOKKOS_FUNCTION void operator()(const int pack) const {
    const int i = pack * lanes;
    const Vector3<R> v_n = load_points<R>(v, i);
    const Vector3<R> v_now = stage == 0 ? v_n : load_points<R>(velocity, i);
    const Vector3<R> a = acceleration<model, R>(cloth, at, v_now, i);
    const Vector3<R> x_n = load_points<R>(x, i);
    if (stage == 3) {
      store_points(x, i, x_n + dt * v_n + (dt * dt / 6.0) * load_points<R>(sum_x, i));
      store_points(v, i, v_n + (dt / 6.0) * (load_points<R>(sum_v, i) + a));
      return;
    }
    const double part = stage == 2 ? dt : 0.5 * dt;
    store_points(next, i, x_n + part * v_now);
    store_points(velocity, i, v_n + part * a);
    store_points(sum_x, i, stage == 0 ? a : load_points<R>(sum_x, i) + a);
    store_points(sum_v, i, stage == 0 ? a : load_points<R>(sum_v, i) + 2.0 * a);
  }
};

/// Leapfrog (Verlet 1967): a kick of the velocity over `kick`, then a drift over `drift`, s. Half a kick
/// before the first drift and after the last makes it velocity Verlet. Damping is taken at the middle of the
/// kick.
template <class ExecutionSpace, Model model>
struct VerletFunctor {
  using R = std::conditional_t<device::is_host<ExecutionSpace>, device::HostPack<double>, double>;
  using Points = PointsView<ExecutionSpace>;
  static constexpr int lanes = device::Access<R>::lanes;

  Cloth<ExecutionSpace> cloth;  ///< its damping is zero
  Points x, v, next;            ///< `next` receives the positions
  double damping, kick, drift;

  KOKKOS_FUNCTION void operator()(const int pack) const {
    const int i = pack * lanes;
    const Vector3<R> before = load_points<R>(v, i), free = load_points<R>(cloth.free, i);
    const Vector3<R> a = acceleration<model, R>(cloth, x, before, i);
    // A pinned axis keeps its velocity.
    const double half = 0.5 * damping * kick, keep = (1.0 - half) / (1.0 + half), gain = kick / (1.0 + half);
    const auto kicked = [&](R now, R along, R is_free) {
      return device::select(is_free > R(0.0), keep * now, now) + gain * along;
    };
    const Vector3<R> after{kicked(before.x, a.x, free.x), kicked(before.y, a.y, free.y),
                           kicked(before.z, a.z, free.z)};
    store_points(v, i, after);
    store_points(next, i, load_points<R>(x, i) + drift * after);
  }
};

}  // namespace drogue::fabric
