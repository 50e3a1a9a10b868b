#pragma once

#include "kernels/fabric/fabric_forces.hpp"

namespace drogue::fabric {

/// Fraction of dt from the beginning of a step to the stage after this one.
KOKKOS_INLINE_FUNCTION double fraction_after_stage(int stage) { return stage == 2 ? 1.0 : 0.5; }

/// Fraction of dt from the beginning of a step to this stage.
KOKKOS_INLINE_FUNCTION double fraction_before_stage(int stage) {
  return stage == 0 ? 0.0 : stage == 3 ? 1.0 : 0.5;
}

/// Position at the end of a step, m, of the classical Runge-Kutta method (Kutta 1901) for x' = v, v' = a(x,
/// v). Computed from the velocities of the stages, which are in memory anyway; running sums of accelerations
/// would be read and written in every stage.
template <class R>
KOKKOS_INLINE_FUNCTION Vector3<R> end_position(double dt, const Vector3<R>& x, const Vector3<R>& v,
                                               const Vector3<R>& v2, const Vector3<R>& v3,
                                               const Vector3<R>& v4) {
  return x + (dt / 6.0) * (v + 2.0 * (v2 + v3) + v4);
}

/// Velocity at the end of the step, m/s, from the velocities of the stages and the last acceleration.
template <class R>
KOKKOS_INLINE_FUNCTION Vector3<R> end_velocity(double dt, const Vector3<R>& v, const Vector3<R>& v2,
                                               const Vector3<R>& v3, const Vector3<R>& v4,
                                               const Vector3<R>& a4) {
  // Differences first: the rounding of 1/3 must not slow a vertex without forces.
  const Vector3<R> gained = (v2 - v) + 2.0 * (v3 - v) + (v4 - v);
  return v + ((1.0 / 3.0) * gained + (dt / 6.0) * a4);
}

/// Stores the state of vertex i and the lanes after it, m and m/s, at the end of a step and counts the step.
template <class ExecutionSpace, class R>
KOKKOS_INLINE_FUNCTION void store_end(const StepMonitor<ExecutionSpace>& monitor,
                                      const PointsView<ExecutionSpace>& x,
                                      const PointsView<ExecutionSpace>& v, int i, const Vector3<R>& end_x,
                                      const Vector3<R>& end_v) {
  store_points(x, i, end_x);
  store_points(v, i, end_v);
  const std::int64_t step = monitor.steps(1) + 1;
  record_divergence(monitor, step, i, end_x, end_v);
  if (i == 0) monitor.steps(0) = step;
}

/// One stage of a step of the classical Runge-Kutta method.
template <class ExecutionSpace, ConstitutiveModel model, class VertexForce = NoVertexForce>
struct RungeKuttaFunctor {
  using R = PackedReal<ExecutionSpace>;
  using Points = PointsView<ExecutionSpace>;
  using Bounds = Kokkos::LaunchBounds<128, 7>;
  static constexpr int lanes = device::Access<R>::lanes;

  FabricViews<ExecutionSpace> fabric;
  Points x, v;         ///< of step n; overwritten by the last stage
  Points at, next;     ///< positions of this and the next stage
  Points velocity[3];  ///< of the stages after the first
  StepMonitor<ExecutionSpace> monitor;
  double dt;
  int stage;
  VertexForceTerm<VertexForce> vertex_force;

  KOKKOS_FUNCTION void operator()(const int pack) const {
    const int i = pack * lanes;
    // Registers limit the number of threads: values that the sum over neighbours does not need are read
    // later.
    Vector3<R> total_force = force<model, R>(fabric, at, i);
    const Vector3<R> v_n = load_points<R>(v, i);
    const Vector3<R> v_now = stage == 0 ? v_n : load_points<R>(velocity[stage - 1], i);
    if constexpr (has_vertex_force<VertexForce>) total_force = with_vertex_force(total_force, v_now, i);
    const Vector3<R> a = acceleration(fabric, total_force, v_now, i), x_n = load_points<R>(x, i);
    if (stage == 3) {
      const Vector3<R> v2 = load_points<R>(velocity[0], i), v3 = load_points<R>(velocity[1], i);
      const Vector3<R> end_x = end_position(dt, x_n, v_n, v2, v3, v_now),
                       end_v = end_velocity(dt, v_n, v2, v3, v_now, a);
      store_end(monitor, x, v, i, end_x, end_v);
      return;
    }
    if (stage == 1 && pack == 0) monitor.steps(1) = monitor.steps(0);
    const double part = fraction_after_stage(stage) * dt;
    store_points(next, i, x_n + part * v_now);
    store_points(velocity[stage], i, v_n + part * a);
  }

  /// `total_force` plus the force of the VertexForce on vertex i and the lanes after it, N. Does not throw.
  KOKKOS_FUNCTION Vector3<R> with_vertex_force(const Vector3<R>& total_force, const Vector3<R>& now,
                                               int i) const {
    // The last stage writes one entry of the counter, the second stage the other.
    return vertex_force.add_to(total_force, load_points<R>(at, i), now, &fabric.inverse_mass(i), i,
                               monitor.steps(stage == 3 ? 1 : 0), fraction_before_stage(stage));
  }
};

/// The first or the last two stages of a step at once, on a device. It applies where forces depend on the
/// positions of the stage and the vertex' own velocity: positions of a stage follow from the velocities of
/// the stage before, so both positions are known before either force. Both stages share the reads of
/// neighbour numbers and triangles at rest.
template <class ExecutionSpace, ConstitutiveModel model, bool last, class VertexForce = NoVertexForce>
struct RungeKuttaHalfFunctor {
  using Points = PointsView<ExecutionSpace>;
  using Vector = Vector3<double>;
  using Bounds = Kokkos::LaunchBounds<128, 4>;  // for the registers of two states

  FabricViews<ExecutionSpace> fabric;
  Points x, v;           ///< of step n; overwritten by the last half
  Points third, fourth;  ///< positions of these stages
  Points velocity[2];    ///< of the second and the third
  StepMonitor<ExecutionSpace> monitor;
  double dt;
  VertexForceTerm<VertexForce> vertex_force;

  KOKKOS_FUNCTION void operator()(const int i) const {
    if constexpr (last)
      end(i);
    else
      begin(i);
  }

  /// Acceleration of vertex i in stage `stage` with velocity `now`, m/s^2.
  template <class Positions>
  KOKKOS_FUNCTION Vector acceleration_in(int stage, const Vector& elastic, const Positions& at,
                                         const Vector& now, int i) const {
    Vector total_force = with_load(fabric, elastic, i);
    if constexpr (has_vertex_force<VertexForce>)
      total_force = vertex_force.add_to(total_force, load_points<double>(at, i), now, &fabric.inverse_mass(i),
                                        i, monitor.steps(last ? 1 : 0), fraction_before_stage(stage));
    return acceleration(fabric, total_force, now, i);
  }

  /// Velocity of the stage after `stage`, m/s; v_n is the velocity at the beginning of the step.
  template <class Positions>
  KOKKOS_FUNCTION Vector next_velocity(int stage, const Vector& v_n, const Vector& elastic,
                                       const Positions& at, const Vector& now, int i) const {
    return v_n + (fraction_after_stage(stage) * dt) * acceleration_in(stage, elastic, at, now, i);
  }

  /// First two stages of vertex i. Does not throw.
  KOKKOS_FUNCTION void begin(int i) const {
    const ExtrapolatedPoints<Points> second{x, v, fraction_after_stage(0) * dt};
    const StatePair<Vector> elastic = elastic_forces<model, double>(fabric, x, second, i);
    const Vector v_n = load_points<double>(v, i), v2 = next_velocity(0, v_n, elastic.first, x, v_n, i),
                 v3 = next_velocity(1, v_n, elastic.second, second, v2, i), x_n = load_points<double>(x, i);
    store_points(third, i, x_n + (fraction_after_stage(1) * dt) * v2);
    store_points(fourth, i, x_n + (fraction_after_stage(2) * dt) * v3);
    store_points(velocity[0], i, v2);
    store_points(velocity[1], i, v3);
    if (i == 0) monitor.steps(1) = monitor.steps(0);
  }

  /// Last two stages of vertex i, and its state after the step. Does not throw.
  KOKKOS_FUNCTION void end(int i) const {
    const StatePair<Vector> elastic = elastic_forces<model, double>(fabric, third, fourth, i);
    const Vector v_n = load_points<double>(v, i), v2 = load_points<double>(velocity[0], i),
                 v3 = load_points<double>(velocity[1], i),
                 v4 = next_velocity(2, v_n, elastic.first, third, v3, i),
                 a4 = acceleration_in(3, elastic.second, fourth, v4, i),
                 end_x = end_position(dt, load_points<double>(x, i), v_n, v2, v3, v4),
                 end_v = end_velocity(dt, v_n, v2, v3, v4, a4);
    store_end(monitor, x, v, i, end_x, end_v);
  }
};

/// Steps of the classical Runge-Kutta method (Kutta 1901) for x' = v, v' = a(x, v, t), and their buffers:
///     x2 = x + dt/2 v,     v2 = v + dt/2 a(x, v, t)
///     x3 = x + dt/2 v2,    v3 = v + dt/2 a(x2, v2, t + dt/2)
///     x4 = x + dt v3,      v4 = v + dt a(x3, v3, t + dt/2)
///     x += dt/6 (v + 2 v2 + 2 v3 + v4),   v by the same sum of the accelerations (`end_velocity`)
template <class ExecutionSpace>
class RungeKutta {
 public:
  using Points = PointsView<ExecutionSpace>;

  /// Without buffers, for solvers with another integrator. Does not throw.
  RungeKutta() = default;

  /// Allocates the buffers. Every stage is a kernel on request and where other kernels need its state, and on
  /// a host, whose registers do not hold two stages at once; else a kernel takes two.
  RungeKutta(const FabricForces<ExecutionSpace>& forces, bool by_stages)
      : _by_stages(device::is_host<ExecutionSpace> || forces.has_load_kernel || forces.dirichlet ||
                   by_stages) {
    const auto n = static_cast<std::size_t>(forces.vertices);
    _fourth = make_points<ExecutionSpace>("drogue::fabric::stage_positions", n);
    for (int stage = 0; stage < (_by_stages ? 3 : 2); ++stage)
      _velocity[stage] = make_points<ExecutionSpace>("drogue::fabric::stage_velocities", n);
  }

  /// Enqueues a step.
  template <ConstitutiveModel model, class VertexForce>
  void enqueue_step(const StepInputs<ExecutionSpace, VertexForce>& in,
                    const StepState<ExecutionSpace>& state) const {
    if constexpr (!device::is_host<ExecutionSpace>)
      if (!_by_stages) {
        enqueue_half<model, false>("drogue::fabric::rk4_begin", in, state);
        return enqueue_half<model, true>("drogue::fabric::rk4_end", in, state);
      }
    for (int stage = 0; stage < 4; ++stage) enqueue_stage<model>(stage, in, state);
  }

 private:
  template <ConstitutiveModel model, class VertexForce>
  void enqueue_stage(int stage, const StepInputs<ExecutionSpace, VertexForce>& in,
                     const StepState<ExecutionSpace>& state) const {
    const Points at[] = {state.x, state.spare_x, _fourth, state.spare_x},
                 next = stage == 3 ? state.x : at[stage + 1],
                 v_now = stage == 0 ? state.v : _velocity[stage - 1],
                 v_next = stage == 3 ? state.v : _velocity[stage];
    in.forces.evaluate_loads(at[stage], v_now, state.at(fraction_before_stage(stage)),
                             in.forces.has_dashpots);
    launch_packs(in.forces.space, "drogue::fabric::rk4_stage", in.forces.padded,
                 RungeKuttaFunctor<ExecutionSpace, model, VertexForce>{
                     .fabric = in.forces.fabric,
                     .x = state.x,
                     .v = state.v,
                     .at = at[stage],
                     .next = next,
                     .velocity = {_velocity[0], _velocity[1], _velocity[2]},
                     .monitor = state.monitor,
                     .dt = state.time.dt,
                     .stage = stage,
                     .vertex_force = in.vertex_force});
    // The last stage has counted the step.
    in.forces.apply_dirichlet(next, v_next, state.at(stage == 3 ? 0.0 : fraction_after_stage(stage)),
                              stage == 3);
  }

  template <ConstitutiveModel model, bool last, class VertexForce>
  void enqueue_half(const char* label, const StepInputs<ExecutionSpace, VertexForce>& in,
                    const StepState<ExecutionSpace>& state) const {
    launch_packs(in.forces.space, label, in.forces.padded,
                 RungeKuttaHalfFunctor<ExecutionSpace, model, last, VertexForce>{
                     .fabric = in.forces.fabric,
                     .x = state.x,
                     .v = state.v,
                     .third = state.spare_x,
                     .fourth = _fourth,
                     .velocity = {_velocity[0], _velocity[1]},
                     .monitor = state.monitor,
                     .dt = state.time.dt,
                     .vertex_force = in.vertex_force});
  }

  bool _by_stages = true;
  /// Positions of a stage; velocities of the stages after the first, of the last one only with a kernel per
  /// stage.
  Points _fourth, _velocity[3];
};

}  // namespace drogue::fabric
