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

/// True if a functor gives a force on a vertex, N.
template <class Functor>
concept GivesForce = requires(const Functor& functor, const VertexStage& at) {
  { functor(at) } -> std::convertible_to<Vector3<double>>;
};

/// True if a functor relaxes the velocity of a vertex, m/s, at the end of the kick of a step.
template <class Functor>
concept RelaxesVelocity = requires(const Functor& functor, const VertexStage& at) {
  { functor.relaxed_velocity(at) } -> std::convertible_to<Vector3<double>>;
};

/// Functor, copied into kernels, that returns a force on a vertex, N, in every evaluation of forces. Calls
/// must not write, because they have no order within a stage. They may read the `VertexStage` and data that
/// nothing changes during the steps: not the Views of `State`, which a persistent kernel updates at its end.
/// The Runge-Kutta method evaluates the force four times per step. Velocity Verlet evaluates it twice per
/// position: for the kick that ends a step, with the velocity before that kick, and for the kick that begins
/// the next one.
///
/// An optional `Vector3<double> relaxed_velocity(const VertexStage&) const`, with or without a force, returns
/// the velocity in which dissipation ends that is too stiff for a force, such as the drag on light cloth. The
/// symplectic Euler method calls it once per step and vertex, between kick and drift, with the position at
/// the beginning of the step, the velocity after the kick, m/s, and zero `force`. It may update state of its
/// own for the vertex. Pinned axes keep their velocity.
template <class Functor>
concept IsVertexForce = std::copy_constructible<Functor> &&(GivesForce<Functor> || RelaxesVelocity<Functor>);

template <class VertexForce>
inline constexpr bool has_vertex_force = !std::is_same_v<VertexForce, NoVertexForce>;

/// A VertexForce as the kernels of steps hold it. Its functions require that there is one.
template <class VertexForce>
struct VertexForceTerm {
  static_assert(!has_vertex_force<VertexForce> || IsVertexForce<VertexForce>,
                "a VertexForce maps a VertexStage to a force or a relaxed velocity");

  VertexForce functor;
  stepping::TimeState origin;  ///< `step` is ignored: kernels count steps on the device
  int vertices = 0;            ///< of the mesh; padding of the last slice has no force

  /// Force on vertex i and the lanes after it, N, `part` of a step after `steps` steps. `force` holds the
  /// elastic forces and loads, N; the result includes them.
  template <class R>
  KOKKOS_INLINE_FUNCTION Vector3<R> add_to(const Vector3<R>& force, const Vector3<R>& position,
                                           const Vector3<R>& velocity, const double* inverse_mass, int i,
                                           std::int64_t steps, double part) const {
    if constexpr (GivesForce<VertexForce>)
      return force + of_lanes<R>(i, [&](int lane) {
               return functor(
                   of_lane(lane, position, velocity, force, inverse_mass[lane], i + lane, steps, part));
             });
    else
      return force;
  }

  /// Velocity of vertex i and the lanes after it, m/s, after the relaxation of `velocity` at the end of the
  /// kick of the step after `steps` steps, which began at `position`, m. Pinned axes keep theirs.
  template <class R>
  KOKKOS_INLINE_FUNCTION Vector3<R> relaxed(const Vector3<R>& position, const Vector3<R>& velocity,
                                            const Vector3<R>& free, const double* inverse_mass, int i,
                                            std::int64_t steps) const {
    if constexpr (RelaxesVelocity<VertexForce>) {
      const Vector3<R> none{R(0.0), R(0.0), R(0.0)},
          result = of_lanes<R>(i, [&](int lane) {
            return functor.relaxed_velocity(
                of_lane(lane, position, velocity, none, inverse_mass[lane], i + lane, steps, 0.0));
          });
      const auto along = [](R is_free, R new_velocity, R old_velocity) {
        return device::select(is_free > R(0.0), new_velocity, old_velocity);
      };
      return {along(free.x, result.x, velocity.x), along(free.y, result.y, velocity.y),
              along(free.z, result.z, velocity.z)};
    } else {
      return velocity;
    }
  }

 private:
  /// Vectors `of(lane)` of vertex i and the lanes after it; zero beyond the last vertex.
  template <class R, class Of>
  KOKKOS_INLINE_FUNCTION Vector3<R> of_lanes(int i, const Of& of) const {
    using Lanes = device::Access<R>;
    double each[3][Lanes::lanes] = {};
    for (int lane = 0; lane < Lanes::lanes && i + lane < vertices; ++lane) {
      const Vector3<double> one = of(lane);
      each[0][lane] = one.x, each[1][lane] = one.y, each[2][lane] = one.z;
    }
    return {Lanes::load(each[0]), Lanes::load(each[1]), Lanes::load(each[2])};
  }

  template <class R>
  KOKKOS_INLINE_FUNCTION VertexStage of_lane(int lane, const Vector3<R>& position, const Vector3<R>& velocity,
                                             const Vector3<R>& force, double inverse_mass, int vertex,
                                             std::int64_t steps, double part) const {
    const auto one = [lane](const Vector3<R>& v) {
      using Lanes = device::Access<R>;
      return Vector3<double>{Lanes::lane(v.x, lane), Lanes::lane(v.y, lane), Lanes::lane(v.z, lane)};
    };
    return {.position = one(position),
            .velocity = one(velocity),
            .force = one(force),
            .inverse_mass = inverse_mass,
            .vertex = vertex,
            .time = stepping::stage_time(origin, steps, part),
            .dt = origin.dt};
  }
};

}  // namespace drogue::fabric
