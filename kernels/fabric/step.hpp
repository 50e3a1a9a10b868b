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

/// Leaves vertex i, and the lanes after it, where a step ends.
template <class ExecutionSpace, class R>
KOKKOS_INLINE_FUNCTION void store_end(const Watch<ExecutionSpace>& watch, const PointsView<ExecutionSpace>& x,
                                      const PointsView<ExecutionSpace>& v, int i, const Vector3<R>& end_x,
                                      const Vector3<R>& end_v) {
  store_points(x, i, end_x);
  store_points(v, i, end_v);
  const std::int64_t step = watch.steps(1) + 1;
  watch.look(step, i, end_x, end_v);
  if (i == 0) watch.steps(0) = step;
}

/// One stage of it.
template <class ExecutionSpace, ConstitutiveModel law>
struct RungeKuttaFunctor {
  using R = std::conditional_t<device::is_host<ExecutionSpace>, device::HostPack<double>, double>;
  using Points = PointsView<ExecutionSpace>;
  using Bounds = Kokkos::LaunchBounds<128, 7>;
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
      const Vector3<R> v2 = load_points<R>(velocity[0], i), v3 = load_points<R>(velocity[1], i);
      store_end(watch, x, v, i, end_position(dt, x_n, v_n, v2, v3, v_now),
                end_velocity(dt, v_n, v2, v3, v_now, a));
      return;
    }
    if (stage == 1 && pack == 0) watch.steps(1) = watch.steps(0);
    const double part = share_after(stage) * dt;
    store_points(next, i, x_n + part * v_now);
    store_points(velocity[stage], i, v_n + part * a);
  }
};

/// Two stages of it at once on a device, the first or the last two, where nothing but a vertex' own velocity
/// changes its force from stage to stage: positions of a stage follow from the velocities of the one before,
/// so those of both are known before either force is. What both read of the neighbours is read once.
template <class ExecutionSpace, ConstitutiveModel law, bool last>
struct RungeKuttaHalfFunctor {
  using Points = PointsView<ExecutionSpace>;
  using Vector = Vector3<double>;
  using Bounds = Kokkos::LaunchBounds<128, 4>;  // two states need their registers

  Cloth<ExecutionSpace> cloth;
  Points x, v;           ///< of step n; the last half replaces them
  Points third, fourth;  ///< positions of these stages
  Points velocity[2];    ///< of the second and the third
  Watch<ExecutionSpace> watch;
  double dt;

  KOKKOS_FUNCTION void operator()(const int i) const {
    if constexpr (last)
      end(i);
    else
      begin(i);
  }

  /// Of stage `stage`, in which vertex i has velocity `now`, to that of the next one; v_n begins the step.
  KOKKOS_FUNCTION Vector next_velocity(int stage, const Vector& v_n, const Vector& elastic, const Vector& now,
                                       int i) const {
    return v_n + (share_after(stage) * dt) * acceleration(cloth, with_load(cloth, elastic, i), now, i);
  }

  KOKKOS_FUNCTION void begin(int i) const {
    const Twice<Vector> pull =
        elastic_forces<law, double>(cloth, x, Ahead<Points>{x, v, share_after(0) * dt}, i);
    const Vector v_n = load_points<double>(v, i), v2 = next_velocity(0, v_n, pull.first, v_n, i),
                 v3 = next_velocity(1, v_n, pull.second, v2, i), x_n = load_points<double>(x, i);
    store_points(third, i, x_n + (share_after(1) * dt) * v2);
    store_points(fourth, i, x_n + (share_after(2) * dt) * v3);
    store_points(velocity[0], i, v2);
    store_points(velocity[1], i, v3);
    if (i == 0) watch.steps(1) = watch.steps(0);
  }

  KOKKOS_FUNCTION void end(int i) const {
    const Twice<Vector> pull = elastic_forces<law, double>(cloth, third, fourth, i);
    const Vector v_n = load_points<double>(v, i), v2 = load_points<double>(velocity[0], i),
                 v3 = load_points<double>(velocity[1], i), v4 = next_velocity(2, v_n, pull.first, v3, i),
                 a4 = acceleration(cloth, with_load(cloth, pull.second, i), v4, i);
    store_end(watch, x, v, i, end_position(dt, load_points<double>(x, i), v_n, v2, v3, v4),
              end_velocity(dt, v_n, v2, v3, v4, a4));
  }
};

/// Velocity Verlet (Swope et al. 1982) with one force a step: half a kick that ends the step before, half a
/// kick that begins the next, and its drift. Damping is taken at the middle of half a kick. However steps are
/// cut into launches, the same operations follow one another.
template <class ExecutionSpace, ConstitutiveModel law>
struct VerletFunctor {
  using R = std::conditional_t<device::is_host<ExecutionSpace>, device::HostPack<double>, double>;
  using Points = PointsView<ExecutionSpace>;
  using Bounds = Kokkos::LaunchBounds<128, 6>;
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
