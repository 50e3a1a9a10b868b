#pragma once

#include <array>
#include <vector>

#include "kernels/device/launch.hpp"
#include "kernels/device/memory.hpp"
#include "kernels/flow/boundary/conditions.hpp"
#include "kernels/flow/views.hpp"

namespace drogue::flow {

/// True if the velocity through a side is an expression of t. Does not throw.
inline bool inflow_changes(const std::array<Boundary, 6>& sides) {
  for (std::size_t side = 0; side < 6; ++side) {
    const std::vector<device::ExpressionProgram>& components = sides[side].velocity_expressions;
    if (components.empty()) continue;
    if (changes_in_time(components[side / 2])) return true;
  }
  return false;
}

/// Net flow rate through the prescribed sides of a rank into its cells, and the sum of the magnitudes of its
/// parts, m^3/s, for a pressure equation that is solvable only without one. One team. On several ranks
/// `Halo::agree` checks the sum.
template <class ExecutionSpace>
struct NetInflowFunctor {
  using Policy = Kokkos::TeamPolicy<ExecutionSpace>;
  using Member = typename Policy::member_type;
  MacGrid grid;
  BoundaryConditions<ExecutionSpace> boundary;
  ControlView<ExecutionSpace> control;
  bool checks;  ///< false on several ranks

  KOKKOS_FUNCTION void operator()(const Member& member) const {
    Control& c = control();
    if (c.trial.stop != stepping::Stop::running || c.has_failed()) return;
    double net = 0.0, magnitude = 0.0;
    for (int side = 0; side < 6; ++side) {
      const int axis = side / 2;
      const bool is_prescribed =
          boundary.kind[side] == BoundaryKind::wall || boundary.kind[side] == BoundaryKind::inflow;
      if (!is_prescribed || grid.n[axis] == 1) continue;
      const int a = boundary.first_axis(axis), b = boundary.second_axis(axis), row = grid.n[a];
      const auto flow = [&](int entry) {
        int index[3] = {0, 0, 0};
        index[a] = entry % row;
        index[b] = entry / row;
        return boundary.value(grid, side, axis, index) *
               (grid.relative_width(a, index[a]) * grid.relative_width(b, index[b]));
      };
      double sum = 0.0, sum_of_magnitudes = 0.0;
      const auto faces = Kokkos::TeamThreadRange(member, row * grid.n[b]);
      Kokkos::parallel_reduce(
          faces, [&](const int entry, double& part) { part += flow(entry); }, sum);
      Kokkos::parallel_reduce(
          faces, [&](const int entry, double& part) { part += Kokkos::fabs(flow(entry)); },
          sum_of_magnitudes);
      const double area = grid.h[a] * grid.h[b];
      net += (side % 2 == 0 ? area : -area) * sum;
      magnitude += area * sum_of_magnitudes;
    }
    if (member.team_rank() != 0) return;
    c.net_inflow = net;
    c.inflow_magnitude = magnitude;
    if (checks) c.is_unbalanced = is_unbalanced(net, magnitude);
  }
};

/// Enqueues the net inflow. Asynchronous.
template <class ExecutionSpace>
void launch_net_inflow(const ExecutionSpace& space, const NetInflowFunctor<ExecutionSpace>& functor) {
  constexpr int threads = device::is_host<ExecutionSpace> ? 1 : 256;
  device::launch_teams("drogue::flow::net_inflow",
                       typename NetInflowFunctor<ExecutionSpace>::Policy(space, 1, threads), functor);
}

}  // namespace drogue::flow
