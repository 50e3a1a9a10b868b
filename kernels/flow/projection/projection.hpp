#pragma once

#include <cstdint>

#include "kernels/device/launch.hpp"
#include "kernels/device/memory.hpp"
#include "kernels/device/team_maximum.hpp"
#include "kernels/flow/boundary/conditions.hpp"
#include "kernels/flow/launch.hpp"
#include "kernels/flow/views.hpp"

namespace drogue::flow {

/// Data of a projection.
template <class ExecutionSpace>
struct ProjectionSetup {
  MacGrid grid;
  BoundaryConditions<ExecutionSpace> boundary;
  List<ExecutionSpace> predicted;       ///< m/s, with ghost cells
  List<ExecutionSpace> velocity;        ///< result, m/s, with ghost cells
  List<ExecutionSpace> divergence;      ///< right-hand side of the pressure equation at the cells, 1/s^2
  List<ExecutionSpace> pressure;        ///< its solution, kinematic, m^2/s^2: the pressure or an increment
  List<ExecutionSpace> total_pressure;  ///< pressure of the step, m^2/s^2; empty before the end of a step
  bool is_increment;                    ///< whether `pressure` is added to `total_pressure` or replaces it
  ControlView<ExecutionSpace> control;
  double nu;             ///< kinematic viscosity of implicit diffusion, m^2/s
  double step_fraction;  ///< of dt that the projection covers
  bool ends_step;        ///< the result is the state after the step, whose rate determines the next dt
  int rows;              ///< of the tile of a team on a device
  /// Pressure of the layer of cells below the low side along each axis, m^2/s^2; null unless another rank
  /// holds it.
  Kokkos::Array<const double*, 3> pressure_below;

  /// True if the face on a side is an unknown of the projection.
  [[nodiscard]] KOKKOS_FUNCTION bool is_outflow(int side) const {
    return boundary.kind[side] == BoundaryKind::outflow;
  }
  /// True for a side that other ranks continue.
  [[nodiscard]] KOKKOS_FUNCTION bool is_neighbour(int side) const {
    return boundary.kind[side] == BoundaryKind::neighbour;
  }
};

/// Right-hand side of the pressure equation, div u / dt, 1/s^2, and check that all components of the
/// predicted velocity are finite.
template <class ExecutionSpace, bool is_stretched>
struct DivergenceFunctor {
  ProjectionSetup<ExecutionSpace> setup;

  KOKKOS_FUNCTION void operator()(const int i, const int j, const int k) const {
    const MacGrid& g = setup.grid;
    Control& control = setup.control();
    if (control.trial.stop != stepping::Stop::running) return;
    const double* u = setup.predicted.data() + g.offset(i, j, k);
    const int index[3] = {i, j, k};
    double divergence = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
      const double* low = u + axis * g.component;
      if (g.n[axis] == 1) {
        divergence += 0.0 * low[0];  // NaN if the component is not finite
        continue;
      }
      const std::int64_t next = g.periodic[axis] && index[axis] + 1 == g.n[axis]
                                    ? (1 - g.n[axis]) * g.stride[axis]
                                    : g.stride[axis];
      divergence += widths_of<is_stretched>(g).inverse_width(axis, index[axis]) * (low[next] - low[0]);
    }
    const std::int64_t cell = i + g.n[0] * (j + static_cast<std::int64_t>(g.n[1]) * k);
    if (!(Kokkos::fabs(divergence) < 1e100))
      Kokkos::atomic_min(&control.first_failure, static_cast<std::uint64_t>(g.number(i, j, k)));
    setup.divergence(cell) = divergence / (setup.step_fraction * control.trial.dt);
  }
};

/// Subtracts the pressure gradient; reduces the maximum of |u|/hx + |v|/hy + |w|/hz, without axes of one
/// cell. The velocities are those on the low faces of a cell, and on the larger of both faces beside a high
/// side, so that each face counts. The width is the lesser one of the cells on both sides of a face.
template <class ExecutionSpace, bool is_stretched>
struct CorrectionFunctor {
  using Policy = Kokkos::TeamPolicy<ExecutionSpace>;
  using Member = typename Policy::member_type;
  ProjectionSetup<ExecutionSpace> setup;
  int tile_width, tile_height;   ///< columns of a team
  int tiles_x, tiles_y, planes;  ///< planes that a thread treats

  KOKKOS_FUNCTION void operator()(const Member& member) const {
    const MacGrid& g = setup.grid;
    Control& control = setup.control();
    if (control.trial.stop != stepping::Stop::running || control.has_failed()) return;
    const double dt = setup.step_fraction * control.trial.dt;
    const int tile = member.league_rank();
    const int i_begin = tile % tiles_x * tile_width, j_begin = tile / tiles_x % tiles_y * tile_height;
    const int k_begin = tile / (tiles_x * tiles_y) * planes;
    const int k_end = k_begin + planes < g.n[2] ? k_begin + planes : g.n[2];
    double largest = 0.0;
    for (int k = k_begin; k < k_end; ++k)
      for (int column = member.team_rank(); column < tile_width * tile_height; column += member.team_size()) {
        const int i = i_begin + column % tile_width, j = j_begin + column / tile_width;
        if (i >= g.n[0] || j >= g.n[1]) continue;
        const double rate = correct(i, j, k, dt);
        largest = rate > largest || !(rate == rate) ? rate : largest;
      }
    if (setup.ends_step) device::raise_to_team_maximum(member, control.next_rate_bits, largest);
  }

 private:
  [[nodiscard]] KOKKOS_FUNCTION bool is_beside_outflow(const int index[3]) const {
    bool result = false;
    for (int axis = 0; axis < 3; ++axis)
      if (setup.grid.n[axis] > 1)
        result = result || (index[axis] == 0 && setup.is_outflow(2 * axis)) ||
                 (index[axis] + 1 == setup.grid.n[axis] && setup.is_outflow(2 * axis + 1));
    return result;
  }

  KOKKOS_FUNCTION double correct(int i, int j, int k, double dt) const {
    const MacGrid& g = setup.grid;
    const int index[3] = {i, j, k};
    const std::int64_t at = g.offset(i, j, k);
    std::int64_t stride = 1;
    const std::int64_t cell = i + g.n[0] * (j + static_cast<std::int64_t>(g.n[1]) * k);
    const double p = setup.pressure(cell);
    double rate = 0.0, value[3], last[3] = {0.0, 0.0, 0.0};
    for (int axis = 0; axis < 3; stride *= g.n[axis], ++axis) {
      const std::int64_t place = axis * g.component + at;
      double beyond = 0.0;
      value[axis] = setup.predicted(place);
      if (g.n[axis] > 1) {
        double below = p;  // no gradient across a boundary with a prescribed velocity
        if (index[axis] > 0)
          below = setup.pressure(cell - stride);
        else if (g.periodic[axis])
          below = setup.pressure(cell + (g.n[axis] - 1) * stride);
        else if (setup.pressure_below[axis] != nullptr)
          below = setup.pressure_below[axis][axis == 1 ? i + g.n[0] * k : i + g.n[0] * j];
        else if (setup.is_outflow(2 * axis))
          below = -p;
        value[axis] -= dt * widths_of<is_stretched>(g).inverse_gap(axis, index[axis]) * (p - below);
        if (is_last(axis, index[axis])) {
          last[axis] = setup.predicted(place + g.stride[axis]);
          if (setup.is_outflow(2 * axis + 1))
            last[axis] += 2.0 * dt * widths_of<is_stretched>(g).inverse_gap(axis, g.n[axis]) * p;
          if (!setup.is_neighbour(2 * axis + 1)) beyond = Kokkos::fabs(last[axis]);
        }
      }
      const double speed = Kokkos::fabs(value[axis]);
      // A factor of zero keeps a NaN.
      if (is_stretched && g.is_stretched(axis))
        rate += g.inverse_least_width(axis, index[axis]) * (beyond > speed ? beyond : speed);
      else
        rate += (g.n[axis] > 1 ? g.inverse_h[axis] : 0.0) * (beyond > speed ? beyond : speed);
    }
    // Stored last: a store between the loads would hold back those behind it.
    for (int axis = 0; axis < 3; ++axis) {
      const std::int64_t place = axis * g.component + at;
      setup.velocity(place) = value[axis];
      if (is_last(axis, index[axis])) setup.velocity(place + g.stride[axis]) = last[axis];
    }
    if (setup.total_pressure.data() != nullptr) {
      double& total = setup.total_pressure(cell);
      // The viscous term makes the pressure of second order up to the sides: Brown, Cortez and Minion 2001,
      // eq. (10). The velocity on outflows is explicit: beside them the term would amplify it by about nu dt
      // / h^2.
      const double nu = is_beside_outflow(index) ? 0.0 : setup.nu;
      total = setup.is_increment ? total + p - 0.5 * nu * dt * setup.divergence(cell) : p;
    }
    return rate;
  }

  /// True for the last cell of an axis that ends at a side.
  [[nodiscard]] KOKKOS_FUNCTION bool is_last(int axis, int i) const {
    const MacGrid& g = setup.grid;
    return g.n[axis] > 1 && i + 1 == g.n[axis] && !g.periodic[axis];
  }
};

/// Enqueues the right-hand side of the pressure equation. Asynchronous.
template <class ExecutionSpace>
void launch_divergence(const ExecutionSpace& space, const ProjectionSetup<ExecutionSpace>& setup) {
  launch_for_widths(setup.grid, [&]<bool is_stretched>() {
    launch_cells(space, "drogue::flow::divergence", setup.grid.n,
                 DivergenceFunctor<ExecutionSpace, is_stretched>{setup});
  });
}

/// Enqueues the subtraction of the pressure gradient. Asynchronous.
template <class ExecutionSpace>
void launch_correction(const ExecutionSpace& space, const ProjectionSetup<ExecutionSpace>& setup) {
  const int* n = setup.grid.n;
  const auto parts = [](int count, int size) { return (count + size - 1) / size; };
  const bool on_host = device::is_host<ExecutionSpace>;
  // A team of a host treats rows. A tile of a device marches along z, so that few teams update the maximum.
  const int width = on_host ? n[0] : tile_x, height = on_host ? 1 : setup.rows;
  const int tiles_x = parts(n[0], width), tiles_y = parts(n[1], height);
  const int planes = on_host ? 1 : march_planes(tiles_x * tiles_y, n[2], 16);
  launch_for_widths(setup.grid, [&]<bool is_stretched>() {
    using Functor = CorrectionFunctor<ExecutionSpace, is_stretched>;
    const typename Functor::Policy policy(space, tiles_x * tiles_y * parts(n[2], planes),
                                          on_host ? 1 : width * height);
    device::launch_teams("drogue::flow::correction", policy,
                         Functor{.setup = setup,
                                 .tile_width = width,
                                 .tile_height = height,
                                 .tiles_x = tiles_x,
                                 .tiles_y = tiles_y,
                                 .planes = planes});
  });
}

}  // namespace drogue::flow
