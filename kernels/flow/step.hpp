#pragma once

#include <array>
#include <optional>
#include <vector>

#include "kernels/device/copy.hpp"
#include "kernels/flow/advection/momentum.hpp"
#include "kernels/flow/axis_tables.hpp"
#include "kernels/flow/boundary/faces.hpp"
#include "kernels/flow/boundary/ghosts.hpp"
#include "kernels/flow/boundary/side_motion.hpp"
#include "kernels/flow/diffusion/implicit_diffusion.hpp"
#include "kernels/flow/fields.hpp"
#include "kernels/flow/halo/halo.hpp"
#include "kernels/flow/make_grid.hpp"
#include "kernels/flow/projection/net_inflow.hpp"
#include "kernels/flow/projection/pressure_equation.hpp"
#include "kernels/flow/projection/projection.hpp"
#include "kernels/flow/solver.hpp"
#include "kernels/flow/step_constants.hpp"
#include "kernels/flow/step_control.hpp"

namespace drogue::flow {

/// Step of an incompressible flow by projection on a staggered grid (Chorin 1968; Kim and Moin 1985):
///
///     u* = u + dt L(u)        `predict`: advection, viscosity and forces
///     lap p = div u* / dt     `project`: pressure equation
///     u = u* - dt grad p               and correction
///
/// The projection is exact to round-off, so that with explicit diffusion a pressure increment would give the
/// same velocity; Crank-Nicolson diffusion needs one. `space` is that of the constructor, which blocks. The
/// other functions are collective, and asynchronous if `is_asynchronous`.
template <class ExecutionSpace>
struct Step {
  using Values = List<ExecutionSpace>;
  using StatusView = typename stepping::StepLoop<ExecutionSpace>::StatusView;

  /// Enqueues a step and the choice of the next dt. A step that fails leaves the state as it is.
  void enqueue(const ExecutionSpace& space, const StatusView& status) {
    set_guess();
    last_solution_is_pressure = true;
    // A captured step begins as it ends.
    if (outdates_ghosts()) halo.outdate_velocity();
    if (parameters.time_scheme == TimeScheme::ab2)
      enqueue_ab2(space);
    else
      enqueue_rk3(space);
    evaluate_eddy_viscosity(space, fields.velocity);  // here, because it limits the next dt
    halo.agree(space, control, checks_inflow);
    Kokkos::parallel_for("drogue::flow::finish_step", Kokkos::RangePolicy<ExecutionSpace>(space, 0, 1),
                         FinishStepFunctor<ExecutionSpace>{control, status, constants});
  }

  /// Adams-Bashforth of second order, as Kim and Moin 1985, for a variable dt:
  /// u = P(u + dt ((1 + r/2) L(u) - r/2 L(u of the step before))), r = dt / dt of the step before.
  void enqueue_ab2(const ExecutionSpace& space) {
    predict(space, fields.velocity, {.state = 0.0, .rate = 1.0, .adams_bashforth = true}, 1.0);
    project(space, fields.velocity, 1.0);
  }

  /// Runge-Kutta of third order, Shu and Osher 1988, eq. (2.18), with a projection P in each stage:
  /// u1 = P(u + dt L(u)), u2 = P(3/4 u + 1/4 (u1 + dt L(u1))), u = P(1/3 u + 2/3 (u2 + dt L(u2))).
  void enqueue_rk3(const ExecutionSpace& space) {
    predict(space, fields.velocity, {.state = 0.0, .rate = 1.0}, 1.0);
    project(space, fields.stage, 1.0);
    predict(space, fields.stage, {.state = 0.75, .rate = 0.25}, 0.5);
    project(space, fields.stage, 0.25);
    predict(space, fields.stage, {.state = 1.0 / 3.0, .rate = 2.0 / 3.0}, 1.0);
    project(space, fields.velocity, 2.0 / 3.0);
  }

  /// Predicted velocity of a stage from the velocity `from`. `time_fraction`: of dt at which the result of
  /// the stage approximates the velocity.
  void predict(const ExecutionSpace& space, const Values& from, const StageWeights& weights,
               double time_fraction) {
    if (from.data() != fields.velocity.data()) evaluate_eddy_viscosity(space, from);
    predict_explicitly(space, momentum_setup(from, weights), time_fraction);
    if (diffusion) diffuse(space);
  }

  /// Predicted velocity without implicit diffusion.
  void predict_explicitly(const ExecutionSpace& space, const MomentumSetup<ExecutionSpace>& setup,
                          double time_fraction) {
    enqueue_eddy_stress(space, setup.stage);
    enqueue_momentum(space, setup);
    if (boundary.changes()) boundary.enqueue_evaluation(space, control, constants, {time_fraction, false});
    enqueue_net_inflow(space);
    launch_boundary_faces(space, setup, boundary.conditions(), parameters.advection);
  }

  /// Velocity without divergence: the predicted one less the gradient of a pressure that acts for a
  /// `fraction` of dt.
  void project(const ExecutionSpace& space, const Values& result, double fraction) {
    const ProjectionSetup<ExecutionSpace> setup = projection_setup(result, fraction);
    solve_pressure(space, setup);
    // No rank may overwrite the state if another one has failed.
    halo.exchange_pressure_and_agree(space, fields.solution, control, checks_inflow);
    launch_correction(space, setup);
    begin_ghosts(space, result);
  }

  /// Solution of the pressure equation for the predicted velocity.
  void solve_pressure(const ExecutionSpace& space, const ProjectionSetup<ExecutionSpace>& setup) {
    halo.exchange_high_faces(space, fields.predicted);
    launch_divergence(space, setup);
    if (!pressure_equation->enqueue_solve(fields.divergence, fields.solution))
      device::launch_each(
          space, "drogue::flow::pressure_failure", 1,
          PressureFailureFunctor<ExecutionSpace>{control, pressure_equation->last_solve()->residual});
  }

  /// Fills the ghost cells of a velocity field; with ghost cells towards other ranks, `finish_ghosts` does.
  void begin_ghosts(const ExecutionSpace& space, const Values& velocity) {
    if (!halo.outdate_velocity()) enqueue_side_ghosts(space, velocity);
  }
  /// Completes what `begin_ghosts` left for the same field.
  void finish_ghosts(const ExecutionSpace& space, const Values& velocity) {
    if (halo.finish_velocity(space, velocity)) enqueue_side_ghosts(space, velocity);
  }
  /// True if the ghost cells towards other ranks are outdated after a step. Does not throw.
  [[nodiscard]] bool outdates_ghosts() const {
    return parameters.turbulence == Turbulence::none && !parameters.watches_extremes;
  }
  /// Ghost cells at the sides of the domain; only those in layers of ghost cells along `first_axis` or a
  /// later axis.
  void enqueue_side_ghosts(const ExecutionSpace& space, const Values& velocity, int first_axis = 0) const {
    launch_ghosts(space, grid, boundary.conditions(), velocity, control, first_axis);
  }

  /// Eddy viscosity of a velocity field, if there is a model.
  void evaluate_eddy_viscosity(const ExecutionSpace& space, const Values& velocity) {
    if (parameters.turbulence == Turbulence::none) return;
    finish_ghosts(space, velocity);
    launch_for_widths(grid, [&]<bool is_stretched>() {
      launch_cells(space, "drogue::flow::eddy_viscosity", eddy_cells.extent,
                   EddyViscosityFunctor<ExecutionSpace, is_stretched>{.grid = grid,
                                                                      .model = eddy_model,
                                                                      .velocity = velocity,
                                                                      .cells = eddy_cells,
                                                                      .viscosity = fields.eddy_viscosity,
                                                                      .control = control});
    });
  }

  /// Acceleration of a velocity field by the eddy viscosity, if there is a model.
  void enqueue_eddy_stress(const ExecutionSpace& space, const Values& velocity) const {
    if (parameters.turbulence == Turbulence::none) return;
    launch_for_widths(grid, [&]<bool is_stretched>() {
      launch_cells(space, "drogue::flow::eddy_stress", grid.n,
                   EddyStressFunctor<ExecutionSpace, is_stretched>{.grid = grid,
                                                                   .velocity = velocity,
                                                                   .cells = eddy_cells,
                                                                   .viscosity = fields.eddy_viscosity,
                                                                   .acceleration = fields.eddy_acceleration,
                                                                   .control = control});
    });
  }

  /// Advection, viscosity and forces. Cells that need no other rank come first, while the messages are under
  /// way.
  void enqueue_momentum(const ExecutionSpace& space, MomentumSetup<ExecutionSpace> setup) {
    const std::vector<MacGrid>& parts = halo.parts();
    halo.begin_velocity(space, setup.stage);
    for (std::size_t i = 0; i < parts.size(); ++i) {
      // The cells inside need the ghost cells at the sides of the domain.
      if (i == 0 && parts.size() > 1) enqueue_side_ghosts(space, setup.stage);
      if (parts.size() == 1) finish_ghosts(space, setup.stage);
      if (i == 1 && halo.finish_velocity(space, setup.stage))
        enqueue_side_ghosts(space, setup.stage, halo.first_divided_axis());
      setup.grid = parts[i];
      if (grid.is_stretched())
        dispatch_stretched_momentum(space, setup, parameters.advection);
      else
        dispatch_momentum(space, setup, parameters.advection);
    }
  }

  /// Net inflow of the present values of the sides, if it may change and must be zero.
  void enqueue_net_inflow(const ExecutionSpace& space) const {
    if (!checks_inflow) return;
    launch_net_inflow(
        space,
        NetInflowFunctor<ExecutionSpace>{
            .grid = grid, .boundary = boundary.conditions(), .control = control, .checks = halo.is_alone()});
  }

  /// Implicit part of the predicted velocity, Crank-Nicolson.
  void diffuse(const ExecutionSpace& space) {
    halo.exchange_pressure(space, fields.pressure);
    const DiffusionSetup<ExecutionSpace> setup{.grid = grid,
                                               .boundary = boundary.conditions(),
                                               .velocity = fields.velocity,
                                               .predicted = fields.predicted,
                                               .pressure = fields.pressure,
                                               .control = control,
                                               .nu = kinematic_viscosity(),
                                               .pressure_below = halo.pressure_below()};
    diffusion->enqueue(space, setup, fields.divergence, fields.solution);
  }

  /// Lets an iterative solver begin with the pressure of the last step, so that a restart continues bit for
  /// bit; with zero if its unknown is an increment.
  void set_guess() {
    if (diffusion)
      pressure_equation->set_guess(Values());
    else if (!last_solution_is_pressure)
      pressure_equation->set_guess(fields.pressure);
  }

  [[nodiscard]] MomentumSetup<ExecutionSpace> momentum_setup(const Values& from,
                                                             const StageWeights& weights) const {
    // m^2/s^2: above zero, so that a uniform velocity is kept, and below the square of any difference that
    // round-off leaves of a velocity above 1e-19 m/s, so that results do not depend on the unit of velocity.
    // Its fourth power, a product of the weights, is a number.
    constexpr double smoothness_floor = 1e-72;
    return {.grid = grid,
            .state = fields.velocity,
            .stage = from,
            .out = fields.predicted,
            .old_rate = fields.rate,
            .force = fields.force,
            .eddy = fields.eddy_acceleration,
            .control = control,
            .nu = diffusion ? 0.0 : kinematic_viscosity(),
            .acceleration = {acceleration[0], acceleration[1], acceleration[2]},
            .specific_volume = 1.0 / parameters.density,
            .epsilon = smoothness_floor,
            .rows = tile_rows(parameters.block),
            .weights = weights};
  }

  [[nodiscard]] ProjectionSetup<ExecutionSpace> projection_setup(const Values& result,
                                                                 double fraction) const {
    const bool ends_step = result.data() == fields.velocity.data();
    return {.grid = grid,
            .boundary = boundary.conditions(),
            .predicted = fields.predicted,
            .velocity = result,
            .divergence = fields.divergence,
            .pressure = fields.solution,
            .total_pressure = ends_step ? fields.pressure : Values(),
            .is_increment = diffusion.has_value(),
            .control = control,
            .nu = kinematic_viscosity(),
            .step_fraction = fraction,
            .ends_step = ends_step,
            .rows = tile_rows(parameters.block),
            .pressure_below = halo.pressure_below()};
  }

  /// True if steps neither block nor allocate, so that a graph can hold one. Does not throw.
  [[nodiscard]] bool is_asynchronous() const {
    return halo.communicator().is_asynchronous() && pressure_equation->is_asynchronous() &&
           (!diffusion || diffusion->is_asynchronous());
  }

  [[nodiscard]] double kinematic_viscosity() const { return parameters.viscosity / parameters.density; }

  /// Throws std::invalid_argument as `check_parameters` and `uses_transforms` do, and std::runtime_error if
  /// memory runs out.
  Step(const ExecutionSpace& space, const Parameters& p, const linear::RankGroup& group);

  Parameters parameters;
  linear::PencilRanks ranks;
  AxisTables<ExecutionSpace> axis_tables;
  MacGrid grid;
  Halo<ExecutionSpace> halo;
  BoundaryTables<ExecutionSpace> boundary;
  bool checks_inflow;  ///< inflows change in time, and the pressure equation has no solution with a net one
  std::array<double, 3> acceleration{};  ///< m/s^2, by body force and pressure drop
  EddyModel eddy_model{};
  EddyCells eddy_cells;
  Fields<ExecutionSpace> fields;
  ControlView<ExecutionSpace> control{"drogue::flow::control"};
  StepConstants constants;
  std::vector<stepping::MotionInterval> motion;  ///< prescribed, of all ranks
  Kokkos::View<stepping::MotionInterval*, typename ExecutionSpace::memory_space> motion_on_device;
  std::optional<ImplicitDiffusion<ExecutionSpace>> diffusion;         ///< Crank-Nicolson only
  std::optional<PressureEquation<ExecutionSpace>> pressure_equation;  ///< never empty after the constructor
  bool last_solution_is_pressure = false;  ///< false if the last solve was not that of the last step
};

/// Sides of the cells of a rank: those of the domain, or towards other ranks. Values as in
/// `Parameters::boundary`, SI units. Does not throw.
inline std::array<Boundary, 6> sides_of(const Parameters& parameters, const linear::PencilRanks& ranks) {
  std::array<Boundary, 6> sides = parameters.boundary;
  for (std::size_t side = 0; side < 6; ++side)
    if (borders_rank(parameters, ranks, side)) sides[side] = {BoundaryKind::neighbour, {}, {}};
  return sides;
}

template <class ExecutionSpace>
Step<ExecutionSpace>::Step(const ExecutionSpace& space, const Parameters& p, const linear::RankGroup& group)
    : parameters(p),
      ranks((check_parameters(p), ranks_of(p, group.size(), group.rank(), !device::is_host<ExecutionSpace>))),
      axis_tables(space, p),
      grid(axis_tables.attach(make_grid(p, ranks))),
      halo(space, group, ranks, p, grid),
      boundary(space, grid, sides_of(p, ranks)),
      checks_inflow(pressure_problem(p).is_singular() && inflow_changes(p.boundary)),
      eddy_cells(make_eddy_cells(grid, boundary.conditions().kind)),
      fields(make_fields<ExecutionSpace>(p, grid, eddy_cells)),
      constants(step_constants(p, grid)),
      motion(side_motion(p)) {
  if (p.diffusion == Diffusion::crank_nicolson) diffusion.emplace(space, p, halo.communicator(), ranks);
  pressure_equation.emplace(space, p, halo.communicator(), ranks, !diffusion);
  if (p.turbulence != Turbulence::none) eddy_model = make_eddy_model(p, grid);
  for (std::size_t axis = 0; axis < 3; ++axis)
    acceleration[axis] =
        (p.body_force[axis] + p.pressure_drop[axis] / (p.high[axis] - p.low[axis])) / p.density;
  constants.motions = static_cast<int>(motion.size());
  if (!motion.empty()) {
    motion_on_device = decltype(motion_on_device)(
        Kokkos::view_alloc(space, Kokkos::WithoutInitializing, "drogue::flow::motion"), motion.size());
    device::copy_in(space, motion_on_device, motion.data(), motion.size());
    constants.motion = motion_on_device.data();
  }
  space.fence("drogue::flow::step: allocated");
}

}  // namespace drogue::flow
