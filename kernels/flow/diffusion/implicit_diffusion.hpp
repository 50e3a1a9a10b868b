#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "kernels/flow/axis_lines.hpp"
#include "kernels/flow/boundary/conditions.hpp"
#include "kernels/flow/launch.hpp"
#include "kernels/flow/prefers_transforms.hpp"
#include "kernels/flow/views.hpp"
#include "kernels/linear/device_communicator.hpp"
#include "kernels/linear/poisson/diagonalization.hpp"
#include "kernels/linear/poisson/fourier.hpp"
#include "kernels/linear/poisson/pencil_solver.hpp"
#include "kernels/linear/poisson/slab_solver.hpp"

namespace drogue::flow {

/// Laplacian of the change of a velocity component in a step, at the faces inside the domain. The change is
/// zero on sides with a prescribed velocity, after known changes have moved to the right-hand side; its
/// normal derivative is zero on slip sides and outflows. Throws std::bad_alloc.
inline linear::PoissonProblem diffusion_problem(const Parameters& parameters, std::size_t component) {
  linear::PoissonProblem problem;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const bool periodic = parameters.boundary[2 * axis].kind == BoundaryKind::periodic;
    const bool on_faces = axis == component && !periodic && parameters.cells[axis] > 1;
    const auto end = [&](std::size_t side) {
      const BoundaryKind kind = parameters.boundary[side].kind;
      return kind == BoundaryKind::wall || kind == BoundaryKind::inflow ? linear::EndCondition::dirichlet
                                                                        : linear::EndCondition::neumann;
    };
    problem.cells[axis] = parameters.cells[axis] - (on_faces ? 1 : 0);
    problem.spacing[axis] = (parameters.high[axis] - parameters.low[axis]) / parameters.cells[axis];
    problem.widths[axis] = widths(parameters, axis);
    // Without widths, unknowns on periodic faces have the equation of those at centres.
    const bool on_periodic_faces = axis == component && periodic && is_stretched(parameters, axis);
    problem.axes[axis] = {periodic, end(2 * axis), end(2 * axis + 1), on_faces || on_periodic_faces};
  }
  return problem;
}

/// Data of an implicit step of diffusion.
template <class ExecutionSpace>
struct DiffusionSetup {
  MacGrid grid;
  BoundaryConditions<ExecutionSpace> boundary;  ///< at the end of the step
  List<ExecutionSpace> velocity;                ///< at the beginning of the step, m/s, ghost cells filled
  List<ExecutionSpace> predicted;               ///< m/s
  List<ExecutionSpace> pressure;                ///< kinematic, of the previous step, m^2/s^2
  ControlView<ExecutionSpace> control;
  double nu;  ///< kinematic viscosity, m^2/s
  /// As in `ProjectionSetup`, of the pressure.
  Kokkos::Array<const double*, 3> pressure_below;

  /// True on a rank at a side of the domain. Does not throw.
  [[nodiscard]] KOKKOS_FUNCTION bool is_side(int side) const {
    return !grid.whole_periodic[side / 2] && boundary.kind[side] != BoundaryKind::neighbour;
  }
  /// First face along the axis of a component that is an unknown: not that on a low side of the domain. Does
  /// not throw.
  [[nodiscard]] KOKKOS_FUNCTION int first_unknown(int axis) const {
    return grid.n[axis] > 1 && is_side(2 * axis) ? 1 : 0;
  }
};

/// Unknowns of one velocity component. On a device a thread visits several of them along z, and raises the
/// maxima of the step once: beside the same few words, the loads of all threads wait for each other.
struct DiffusionMarch {
  int extent[3];  ///< unknowns per axis
  int planes;     ///< of a thread

  /// First unknown along z of part `part`, and the end. Do not throw.
  [[nodiscard]] KOKKOS_FUNCTION int begin(int part) const { return part * planes; }
  [[nodiscard]] KOKKOS_FUNCTION int end(int part) const {
    return Kokkos::min((part + 1) * planes, extent[2]);
  }
  /// Place of an unknown in an array of them. Does not throw.
  [[nodiscard]] KOKKOS_FUNCTION std::int64_t offset(int i, int j, int k) const {
    return i + extent[0] * (j + static_cast<std::int64_t>(extent[1]) * k);
  }
};

/// Calls `functor(i, j, part)` for all unknowns along x and y, and all parts of the march.
template <class ExecutionSpace, class Functor>
void launch_march(const ExecutionSpace& space, const char* label, const Functor& functor) {
  const auto& [extent, planes] = functor.march;
  const int threads[3] = {extent[0], extent[1], (extent[2] + planes - 1) / planes};
  launch_cells(space, label, threads, functor);
}

/// Right-hand side of the equation for the change of one velocity component, m/s: the explicit terms,
/// viscosity and pressure gradient at the beginning of the step, and the known changes on the sides. Adds the
/// pressure gradient to the predicted velocity on outflows. The component is known to the compiler, so that
/// indices of the axes stay in registers.
template <class ExecutionSpace, int component, bool is_stretched>
struct DiffusionSourceFunctor {
  DiffusionSetup<ExecutionSpace> setup;
  DiffusionMarch march;
  double* source;

  /// Maxima over the unknowns of a thread, as in `StepMaxima`.
  struct Maxima {
    std::uint64_t viscous_acceleration = 0, highest = 0, lowest = 0;
  };

  KOKKOS_FUNCTION void operator()(const int i, const int j, const int part) const {
    Control& control = setup.control();
    if (control.trial.stop != stepping::Stop::running) return;
    Maxima maxima;
    for (int k = march.begin(part); k < march.end(part); ++k)
      source[march.offset(i, j, k)] =
          source_at(widths_of<is_stretched>(setup.grid), {i, j, k}, control.trial.dt, maxima);
    raise(control.viscous_acceleration, maxima.viscous_acceleration);
    raise(control.highest[component], maxima.highest);
    raise(control.lowest[component], maxima.lowest);
  }

 private:
  template <class Widths>
  [[nodiscard]] KOKKOS_FUNCTION double source_at(const Widths& widths, const int (&unknown)[3], double dt,
                                                 Maxima& maxima) const {
    const MacGrid& g = setup.grid;
    int index[3] = {unknown[0], unknown[1], unknown[2]};
    index[component] += setup.first_unknown(component);
    const std::int64_t place = component * g.component + g.offset(index[0], index[1], index[2]);
    const double* u = setup.velocity.data() + place;
    double laplacian = 0.0, change = 0.0, highest = u[0], lowest = u[0];
    for (int axis = 0; axis < 3; ++axis) {
      if (g.n[axis] == 1) continue;
      const std::int64_t stride = g.stride[axis];
      const int i = index[axis];
      const double extent = widths.inverse_extent(component, axis, i),
                   step_low = widths.inverse_step(component, axis, i),
                   step_high = widths.inverse_step(component, axis, i + 1);
      const double w_low = extent * step_low, w_high = extent * step_high;
      const double below = u[-stride], above = u[stride];
      if constexpr (Widths::are_equal)
        laplacian += w_low * ((above - u[0]) - (u[0] - below));
      else
        laplacian += extent * (step_high * (above - u[0]) - step_low * (u[0] - below));
      // Half of these differences lead to the values on sides.
      const double sides[2] = {u[0] + 0.5 * (below - u[0]), u[0] + 0.5 * (above - u[0])};
      for (const double value : sides) {
        highest = value > highest ? value : highest;
        lowest = value < lowest ? value : lowest;
      }
      if (g.periodic[axis]) continue;
      if (axis == component) {
        if (i == 1 && setup.is_side(2 * axis))
          change += w_low * normal_change(2 * axis, index, place - stride, dt);
        if (i + 1 == g.n[axis] && setup.is_side(2 * axis + 1))
          change += w_high * normal_change(2 * axis + 1, index, place + stride, dt);
      } else {
        if (i == 0) change += 2.0 * w_low * tangential_change(2 * axis, index, place, -stride);
        if (i + 1 == g.n[axis])
          change += 2.0 * w_high * tangential_change(2 * axis + 1, index, place, stride);
      }
    }
    // Bits, which let NaN prevail.
    maxima.viscous_acceleration = Kokkos::max(
        maxima.viscous_acceleration, Kokkos::bit_cast<std::uint64_t>(Kokkos::fabs(setup.nu * laplacian)));
    maxima.highest = Kokkos::max(maxima.highest, ordered_bits(highest));
    maxima.lowest = Kokkos::max(maxima.lowest, ordered_bits(-lowest));
    return setup.predicted(place) - u[0] + dt * (setup.nu * laplacian - pressure_gradient(index)) +
           0.5 * setup.nu * dt * change;
  }
  [[nodiscard]] KOKKOS_FUNCTION double pressure_at(int i, int j, int k) const {
    const MacGrid& g = setup.grid;
    return setup.pressure(static_cast<std::size_t>(i + g.n[0] * (j + static_cast<std::int64_t>(g.n[1]) * k)));
  }
  [[nodiscard]] KOKKOS_FUNCTION double pressure_gradient(const int index[3]) const {
    const MacGrid& g = setup.grid;
    if (g.n[component] == 1) return 0.0;
    const double here = pressure_at(index[0], index[1], index[2]);
    const double* other_rank = setup.pressure_below[component];
    if (index[component] == 0 && other_rank != nullptr)
      return g.inverse_gap(component, 0) *
             (here - other_rank[index[0] + g.n[0] * (component == 1 ? index[2] : index[1])]);
    int below[3] = {index[0], index[1], index[2]};
    below[component] = (index[component] == 0 ? g.n[component] : index[component]) - 1;
    return g.inverse_gap(component, index[component]) * (here - pressure_at(below[0], below[1], below[2]));
  }
  /// Change of the normal velocity on a side in this step, m/s, next to the unknown `index`.
  [[nodiscard]] KOKKOS_FUNCTION double normal_change(int side, const int index[3], std::int64_t face,
                                                     double dt) const {
    if (setup.boundary.kind[side] == BoundaryKind::outflow) {
      int cell[3] = {index[0], index[1], index[2]};
      if (side % 2 == 0) --cell[component];
      // The pressure on the side is zero until the projection.
      const double gradient =
          2.0 * setup.grid.inverse_width(component, cell[component]) * pressure_at(cell[0], cell[1], cell[2]);
      setup.predicted(face) -= dt * (side % 2 == 0 ? gradient : -gradient);
    }
    return setup.predicted(face) - setup.velocity(face);
  }
  /// Change of a velocity prescribed by an expression in this step, m/s. The old one follows from the ghost
  /// value.
  [[nodiscard]] KOKKOS_FUNCTION double tangential_change(int side, const int index[3], std::int64_t place,
                                                         std::int64_t outward) const {
    if (setup.boundary.first[side] < 0) return 0.0;
    return setup.boundary.value(setup.grid, side, component, index) -
           0.5 * (setup.velocity(place) + setup.velocity(place + outward));
  }
};

/// Adds the change of a component to the velocity at the beginning of the step.
template <class ExecutionSpace, int component>
struct DiffusionUpdateFunctor {
  DiffusionSetup<ExecutionSpace> setup;
  DiffusionMarch march;
  const double* change;  ///< m/s

  KOKKOS_FUNCTION void operator()(const int i, const int j, const int part) const {
    if (setup.control().trial.stop != stepping::Stop::running) return;
    std::uint64_t largest = 0;
    for (int k = march.begin(part); k < march.end(part); ++k) {
      int index[3] = {i, j, k};
      index[component] += setup.first_unknown(component);
      const std::int64_t place =
          component * setup.grid.component + setup.grid.offset(index[0], index[1], index[2]);
      const double here = change[march.offset(i, j, k)];
      setup.predicted(place) = setup.velocity(place) + here;
      largest = Kokkos::max(largest, Kokkos::bit_cast<std::uint64_t>(Kokkos::fabs(here)));
    }
    raise(setup.control().change, largest);
  }
};

/// Crank-Nicolson diffusion: (1 - nu dt/2 lap) (u* - u) = dt (explicit terms + nu lap u - grad p), solved
/// directly for each component by transforms or matrix products, without a splitting error. p is the pressure
/// of the previous step (incremental projection, Van Kan 1986), so that u* satisfies the conditions of the
/// sides to second order.
template <class ExecutionSpace>
class ImplicitDiffusion {
 public:
  using Values = List<ExecutionSpace>;

  /// Allocates; blocks. Collective on `group`, which `ranks` divides. Throws std::runtime_error if memory
  /// runs out.
  ImplicitDiffusion(const ExecutionSpace& space, const Parameters& parameters,
                    const linear::DeviceCommunicator<ExecutionSpace>& communicator,
                    const linear::PencilRanks& ranks) {
    const linear::RankGroup& group = communicator.group();
    for (std::size_t c = 0; c < 3; ++c) {
      const linear::PoissonProblem problem = diffusion_problem(parameters, c);
      _unknowns[c] = linear::unknowns_of(ranks, problem);
      std::size_t same = 0;
      while (same < _problems.size() && !(_problems[same] == problem)) ++same;
      _solver_of[c] = same;
      if (same < _problems.size()) continue;
      _problems.push_back(problem);
      const bool slabs = ranks.are_slabs();
      const bool can =
          slabs ? linear::SlabSolver<ExecutionSpace>::supports(problem, linear::AxisMethod::fourier)
                : linear::FourierSolver<ExecutionSpace>::supports(problem);
      const bool transforms = can && prefers_transforms(parameters.pressure_solver);
      const auto method = transforms ? linear::AxisMethod::fourier : linear::AxisMethod::diagonalization;
      if (slabs)
        _solvers.emplace_back(std::in_place_type<linear::SlabSolver<ExecutionSpace>>, space, problem,
                              communicator, ranks, method);
      else if (group.size() > 1)
        _solvers.emplace_back(std::in_place_type<linear::PencilSolver<ExecutionSpace>>, space, problem, group,
                              ranks, method);
      else if (transforms)
        _solvers.emplace_back(std::in_place_type<linear::FourierSolver<ExecutionSpace>>, space, problem);
      else
        _solvers.emplace_back(std::in_place_type<linear::DiagonalizationSolver<ExecutionSpace>>, space,
                              problem);
    }
  }

  /// True if solves neither block nor allocate. Does not throw.
  [[nodiscard]] bool is_asynchronous() const {
    return std::ranges::all_of(_solvers, [](const Solver& each) {
      return std::visit([](const auto& solver) { return linear::is_asynchronous(solver); }, each);
    });
  }

  /// Enqueues the implicit part of a step: replaces the predicted velocity, which holds the explicit part.
  /// The work arrays hold at least one number per cell. Collective, and asynchronous if
  /// `is_asynchronous`.
  void enqueue(const ExecutionSpace& space, const DiffusionSetup<ExecutionSpace>& setup, const Values& source,
               const Values& change) {
    enqueue_component<0>(space, setup, source, change);
    enqueue_component<1>(space, setup, source, change);
    enqueue_component<2>(space, setup, source, change);
  }

 private:
  template <int component>
  void enqueue_component(const ExecutionSpace& space, const DiffusionSetup<ExecutionSpace>& setup,
                         const Values& source, const Values& change) {
    // The step size is read on the device, where it changes from step to step.
    const double* dt = &setup.control.data()->trial.dt;
    const linear::CellBox& unknowns = _unknowns[component];
    const auto [nx, ny, nz] = unknowns.cells;
    const int tiles = ((nx + tile_x - 1) / tile_x) * ((ny + tile_y - 1) / tile_y);
    const DiffusionMarch march{
        .extent = {nx, ny, nz},
        .planes = device::is_host<ExecutionSpace> ? 1 : march_planes(tiles, nz, 16, 4096)};
    const Values from(source.data(), unknowns.size()), to(change.data(), unknowns.size());
    launch_for_widths(setup.grid, [&]<bool is_stretched>() {
      launch_march(
          space, "drogue::flow::diffusion_source",
          DiffusionSourceFunctor<ExecutionSpace, component, is_stretched>{setup, march, from.data()});
    });
    std::visit(
        [&](auto& solver) {
          solver.enqueue_solve(from, to, {dt, 0.5 * setup.nu});
        },
        _solvers[_solver_of[component]]);
    launch_march(space, "drogue::flow::diffusion_update",
                 DiffusionUpdateFunctor<ExecutionSpace, component>{setup, march, to.data()});
  }

  using Solver =
      std::variant<linear::FourierSolver<ExecutionSpace>, linear::DiagonalizationSolver<ExecutionSpace>,
                   linear::PencilSolver<ExecutionSpace>, linear::SlabSolver<ExecutionSpace>>;
  std::vector<linear::PoissonProblem> _problems;  ///< without repetitions
  std::vector<Solver> _solvers;                   ///< of each problem
  std::array<std::size_t, 3> _solver_of{};        ///< by component
  std::array<linear::CellBox, 3> _unknowns{};     ///< of this rank, by component
};

}  // namespace drogue::flow
