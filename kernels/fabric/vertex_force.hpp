#pragma once

#include <concepts>
#include <type_traits>

#include "kernels/fabric/fabric_views.hpp"
#include "kernels/stepping/step_monitor.hpp"

namespace drogue::fabric {

/// State of one vertex in one stage of a step.
struct VertexStage {
  Vector3<double> position;  ///< m
  Vector3<double> velocity;  ///< m/s
  Vector3<double> force;     ///< N, elastic force and loads; neither gravity nor damping
  double inverse_mass;       ///< 1/kg
  int vertex;                ///< number in the mesh
  double time;               ///< s, of the stage
  double dt;                 ///< s, of the whole step
};

/// Default of `FabricSolver`: no force of the caller. The kernels then contain no code for one.
struct NoVertexForce {};

/// Functor, copied into kernels, that returns a force on a vertex, N, in every evaluation of forces. Calls
/// must not write: they have no order within a stage.
///
/// An optional `void end_step(const VertexStage&) const` updates state of its own for the vertex. The solver
/// calls it once per step and vertex with the position, velocity and time at the end of the step and zero
/// `force`. The Runge-Kutta method evaluates the force four times per step. Velocity Verlet evaluates it
/// twice per position: for the kick that ends a step, with the velocity before that kick, and for the kick
/// that begins the next one.
template <class Functor>
concept IsVertexForce = std::copy_constructible<Functor> &&
    requires(const Functor& functor, const VertexStage& at) {
  { functor(at) } -> std::convertible_to<Vector3<double>>;
};

template <class VertexForce>
inline constexpr bool has_vertex_force = !std::is_same_v<VertexForce, NoVertexForce>;

/// A VertexForce as the kernels of steps hold it. Its functions require that there is one.
template <class VertexForce>
struct VertexForceTerm {
  static_assert(!has_vertex_force<VertexForce> || IsVertexForce<VertexForce>,
                "a VertexForce maps a VertexStage to a force");
  static constexpr bool ends_steps = requires(const VertexForce& functor, const VertexStage& at) {
    functor.end_step(at);
  };

  VertexForce functor;
  stepping::TimeState origin;  ///< `step` is ignored: kernels count steps on the device
  int vertices = 0;            ///< of the mesh; padding of the last slice has no force

  /// Force on vertex i and the lanes after it, N, `part` of a step after `steps` steps. `force` holds the
  /// elastic forces and loads, N; the result includes them.
  template <class R>
  KOKKOS_INLINE_FUNCTION Vector3<R> add_to(const Vector3<R>& force, const Vector3<R>& position,
                                           const Vector3<R>& velocity, const double* inverse_mass, int i,
                                           std::int64_t steps, double part) const {
    using Lanes = device::Access<R>;
    double of[3][Lanes::lanes] = {};
    for (int lane = 0; lane < Lanes::lanes && i + lane < vertices; ++lane) {
      const Vector3<double> one =
          functor(of_lane(lane, position, velocity, force, inverse_mass[lane], i + lane, steps, part));
      of[0][lane] = one.x, of[1][lane] = one.y, of[2][lane] = one.z;
    }
    return force + Vector3<R>{Lanes::load(of[0]), Lanes::load(of[1]), Lanes::load(of[2])};
  }

  /// Ends step `steps` of vertex i and the lanes after it.
  template <class R>
  KOKKOS_INLINE_FUNCTION void end_step(const Vector3<R>& position, const Vector3<R>& velocity,
                                       const double* inverse_mass, int i, std::int64_t steps) const {
    if constexpr (ends_steps) {
      const Vector3<R> none{R(0.0), R(0.0), R(0.0)};
      for (int lane = 0; lane < device::Access<R>::lanes && i + lane < vertices; ++lane)
        functor.end_step(of_lane(lane, position, velocity, none, inverse_mass[lane], i + lane, steps, 0.0));
    }
  }

 private:
  template <class R>
  KOKKOS_INLINE_FUNCTION VertexStage of_lane(int lane, const Vector3<R>& position, const Vector3<R>& velocity,
                                             const Vector3<R>& force, double inverse_mass, int vertex,
                                             std::int64_t steps, double part) const {
    const auto one = [lane](const Vector3<R>& v) {
      using Lanes = device::Access<R>;
      return Vector3<double>{Lanes::lane(v.x, lane), Lanes::lane(v.y, lane), Lanes::lane(v.z, lane)};
    };
    return {one(position), one(velocity), one(force),
            inverse_mass,  vertex,        stepping::stage_time(origin, steps, part),
            origin.dt};
  }
};

}  // namespace drogue::fabric
