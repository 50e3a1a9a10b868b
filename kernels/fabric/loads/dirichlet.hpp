#pragma once

#include "kernels/fabric/loads/make_loads.hpp"
#include "kernels/fabric/parameters.hpp"
#include "kernels/fabric/stepping/divergence.hpp"

namespace drogue::fabric {

/// Prescribed displacements of single axes of vertices, one row per axis and vertex.
template <class ExecutionSpace>
struct DirichletConditions {
  PointsView<ExecutionSpace> rest;
  ProgramsView<ExecutionSpace> displacement;
  ListView<ExecutionSpace, int> vertex, axis, program;
};

/// Motions of `Parameters`, which may not be empty. Blocks.
template <class ExecutionSpace>
[[nodiscard]] DirichletConditions<ExecutionSpace> make_dirichlet(const ExecutionSpace& space,
                                                                 const std::vector<Motion>& motions,
                                                                 const PointsView<ExecutionSpace>& rest) {
  std::vector<device::ExpressionProgram> displacement;
  std::vector<int> vertex, axis, program;
  for (const Motion& motion : motions) {
    for (const int i : motion.vertices) {
      vertex.push_back(i);
      axis.push_back(motion.axis);
      program.push_back(static_cast<int>(displacement.size()));
    }
    displacement.push_back(motion.displacement);
  }
  return {.rest = rest,
          .displacement = make_programs(space, displacement),
          .vertex = list_view(space, "drogue::fabric::dirichlet_vertices", vertex),
          .axis = list_view(space, "drogue::fabric::dirichlet_axes", axis),
          .program = list_view(space, "drogue::fabric::dirichlet_programs", program)};
}

/// Applies Dirichlet conditions: sets positions and their velocities, from central differences of fourth
/// order over a step. Within the first step the differences are one-sided and of second order, since an
/// expression need not be defined before time 0.
template <class ExecutionSpace>
struct DirichletFunctor {
  DirichletConditions<ExecutionSpace> prescribed;
  PointsView<ExecutionSpace> x, v;
  stepping::StageTime<ExecutionSpace> stage_time;
  bool checks_divergence;  ///< at the end of a step

  KOKKOS_FUNCTION void operator()(const int k) const {
    const int i = prescribed.vertex(k), axis = prescribed.axis(k);
    const Vector3<double> rest = load_points<double>(prescribed.rest, i);
    const auto displacement_at = [&](double t) {
      return device::evaluate(prescribed.displacement(prescribed.program(k)), rest.x, rest.y, rest.z, t);
    };
    const double t = stage_time.time(), dt = stage_time.origin.dt, half = 0.5 * dt, now = displacement_at(t);
    const double position = prescribed.rest(i, axis) + now;
    const double velocity = t < dt
                                ? (4.0 * displacement_at(t + half) - 3.0 * now - displacement_at(t + dt)) / dt
                                : (8.0 * (displacement_at(t + half) - displacement_at(t - half)) -
                                   (displacement_at(t + dt) - displacement_at(t - dt))) /
                                      (6.0 * dt);
    x(i, axis) = position;
    v(i, axis) = velocity;
    if (checks_divergence && !(Kokkos::fabs(position) + Kokkos::fabs(velocity) < divergence_limit))
      stage_time.monitor.record_failure(stage_time.monitor.steps(stage_time.parity), i);
  }
};

}  // namespace drogue::fabric
