#pragma once

#include <cstdint>

#include "kernels/device/memory.hpp"
#include "kernels/device/team_maximum.hpp"
#include "kernels/flow/boundary/conditions.hpp"
#include "kernels/flow/views.hpp"

namespace drogue::flow {

/// Data of a projection.
template <class ExecutionSpace>
struct ProjectionSetup {
  MacGrid grid;
  BoundaryConditions<ExecutionSpace> boundary;
  List<ExecutionSpace> predicted;  ///< m/s, with ghost cells
  List<ExecutionSpace> velocity;   ///< result, m/s, with ghost cells
  List<ExecutionSpace> divergence;  ///< right-hand side of the pressure equation at the cells, 1/s^2
  List<ExecutionSpace> pressure;    ///< kinematic, at the cells, m^2/s^2
  ControlView<ExecutionSpace> control;
  double step_fraction;  ///< of dt that the projection covers
  bool has_outflow;

  /// True if the face on a side is an unknown of the projection.
  [[nodiscard]] KOKKOS_FUNCTION bool is_outflow(int side) const {
    return boundary.kind[side] == BoundaryKind::outflow;
  }
};

/// Kinematic pressure on the face of an outflow, m^2/s^2, for the outward velocity: zero, and minus the dynamic pressure
/// where fluid flows back, which so enters with a total pressure of zero and cannot gain energy. Does not throw.
KOKKOS_INLINE_FUNCTION double outflow_pressure(double outward) {
  return outward < 0.0 ? -0.5 * outward * outward : 0.0;
}

/// Cells of a team of the projection's kernels.
inline constexpr int projection_team = 128;

/// Right-hand side of the pressure equation, div u / dt, 1/s^2, and check that the predicted velocity is finite.
template <class ExecutionSpace>
struct DivergenceFunctor {
  ProjectionSetup<ExecutionSpace> setup;

  KOKKOS_FUNCTION void operator()(const int i, const int j, const int k) const {
    const MacGrid& g = setup.grid;
    Control& control = setup.control();
    if (control.trial.stop != stepping::Stop::running) return;
    const double* u = setup.predicted.data() + g.offset(i, j, k);
    const int index[3] = {i, j, k};
    double divergence = 0.0, outside = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
      if (g.n[axis] == 1) continue;
      const double* low = u + axis * g.component;
      const std::int64_t next =
          g.periodic[axis] && index[axis] + 1 == g.n[axis] ? (1 - g.n[axis]) * g.stride[axis] : g.stride[axis];
      divergence += g.inverse_h[axis] * (low[next] - low[0]);
      if (setup.has_outflow) {
        const double twice_inverse = 2.0 * g.inverse_h[axis] * g.inverse_h[axis];
        if (index[axis] == 0 && setup.is_outflow(2 * axis))
          outside += twice_inverse * outflow_pressure(-low[0]);
        if (index[axis] + 1 == g.n[axis] && setup.is_outflow(2 * axis + 1))
          outside += twice_inverse * outflow_pressure(low[next]);
      }
    }
    const std::int64_t cell = i + g.n[0] * (j + static_cast<std::int64_t>(g.n[1]) * k);
    if (!(Kokkos::fabs(divergence) < 1e100))
      Kokkos::atomic_min(&control.first_failure, static_cast<std::uint64_t>(cell));
    setup.divergence(cell) = divergence / (setup.step_fraction * control.trial.dt) - outside;
  }
};

/// Subtracts the pressure gradient; reduces the maximum of |u|/hx + |v|/hy + |w|/hz.
template <class ExecutionSpace>
struct CorrectionFunctor {
  using Policy = Kokkos::TeamPolicy<ExecutionSpace>;
  using Member = typename Policy::member_type;
  ProjectionSetup<ExecutionSpace> setup;
  int segments;     ///< teams of a row
  int team_cells;   ///< cells of a team

  KOKKOS_FUNCTION void operator()(const Member& member) const {
    const MacGrid& g = setup.grid;
    Control& control = setup.control();
    if (control.trial.stop != stepping::Stop::running || control.first_failure != no_failure) return;
    const double dt = setup.step_fraction * control.trial.dt;
    const int row = member.league_rank() / segments;
    const int j = row % g.n[1], k = row / g.n[1];
    const int begin = member.league_rank() % segments * team_cells;
    const int end = begin + team_cells < g.n[0] ? begin + team_cells : g.n[0];
    double largest = 0.0;
    for (int i = begin + member.team_rank(); i < end; i += member.team_size()) {
      const double rate = correct(i, j, k, dt);
      largest = rate > largest || !(rate == rate) ? rate : largest;
    }
    device::raise_to_team_maximum(member, control.next_rate, largest);
  }

 private:
  KOKKOS_FUNCTION double correct(int i, int j, int k, double dt) const {
    const MacGrid& g = setup.grid;
    const int index[3] = {i, j, k};
    const std::int64_t at = g.offset(i, j, k);
    std::int64_t stride = 1;
    const std::int64_t cell = i + g.n[0] * (j + static_cast<std::int64_t>(g.n[1]) * k);
    const double p = setup.pressure(cell);
    double rate = 0.0;
    for (int axis = 0; axis < 3; stride *= g.n[axis], ++axis) {
      const std::int64_t place = axis * g.component + at;
      double value = setup.predicted(place);
      if (g.n[axis] > 1) {
        double below = p;  // no gradient across a boundary with a prescribed velocity
        if (index[axis] > 0)
          below = setup.pressure(cell - stride);
        else if (g.periodic[axis])
          below = setup.pressure(cell + (g.n[axis] - 1) * stride);
        else if (setup.is_outflow(2 * axis))
          below = 2.0 * outflow_pressure(-value) - p;
        value -= dt * g.inverse_h[axis] * (p - below);
        if (index[axis] + 1 == g.n[axis] && !g.periodic[axis]) {
          const std::int64_t high = place + g.stride[axis];
          double last = setup.predicted(high);
          if (setup.is_outflow(2 * axis + 1)) last += 2.0 * dt * g.inverse_h[axis] * (p - outflow_pressure(last));
          setup.velocity(high) = last;
        }
      }
      setup.velocity(place) = value;
      rate += g.inverse_h[axis] * Kokkos::fabs(value);
    }
    return rate;
  }
};

/// Enqueues the right-hand side of the pressure equation. Asynchronous.
template <class ExecutionSpace>
void launch_divergence(const ExecutionSpace& space, const ProjectionSetup<ExecutionSpace>& setup) {
  using Policy = Kokkos::MDRangePolicy<ExecutionSpace, Kokkos::Rank<3, Kokkos::Iterate::Left, Kokkos::Iterate::Left>>;
  const int* n = setup.grid.n;
  Kokkos::parallel_for("drogue::flow::divergence", Policy(space, {0, 0, 0}, {n[0], n[1], n[2]}),
                       DivergenceFunctor<ExecutionSpace>{setup});
}

/// Enqueues the subtraction of the pressure gradient. Asynchronous.
template <class ExecutionSpace>
void launch_correction(const ExecutionSpace& space, const ProjectionSetup<ExecutionSpace>& setup) {
  using Functor = CorrectionFunctor<ExecutionSpace>;
  const int* n = setup.grid.n;
  const bool on_host = device::is_host<ExecutionSpace>;
  const int cells = on_host ? n[0] : projection_team;
  const int segments = (n[0] + cells - 1) / cells;
  typename Functor::Policy policy(space, segments * n[1] * n[2], on_host ? 1 : projection_team);
  Kokkos::parallel_for("drogue::flow::correction", policy, Functor{setup, segments, cells});
}

}  // namespace drogue::flow
