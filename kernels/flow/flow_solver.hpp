#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "kernels/device/copy.hpp"
#include "kernels/flow/advection/momentum.hpp"
#include "kernels/flow/boundary/faces.hpp"
#include "kernels/flow/boundary/ghosts.hpp"
#include "kernels/flow/boundary/side_motion.hpp"
#include "kernels/flow/diffusion/implicit_diffusion.hpp"
#include "kernels/flow/halo/halo.hpp"
#include "kernels/flow/observables/extremes.hpp"
#include "kernels/flow/observables/sample.hpp"
#include "kernels/flow/observables/totals.hpp"
#include "kernels/flow/projection/net_inflow.hpp"
#include "kernels/flow/projection/pressure_equation.hpp"
#include "kernels/flow/projection/projection.hpp"
#include "kernels/flow/shift_frame.hpp"
#include "kernels/flow/solver.hpp"
#include "kernels/flow/step_constants.hpp"
#include "kernels/flow/step_control.hpp"
#include "kernels/flow/turbulence/eddy_viscosity.hpp"
#include "kernels/stepping/step_launcher.hpp"

namespace drogue::flow {

/// Sides of the cells of a rank: those of the domain, or towards other ranks. Values as in
/// `Parameters::boundary`, SI units. Does not throw.
inline std::array<Boundary, 6> sides_of(const Parameters& parameters, const linear::PencilRanks& ranks) {
  std::array<Boundary, 6> sides = parameters.boundary;
  for (std::size_t side = 0; side < 6; ++side)
    if (borders_rank(parameters, ranks, side)) sides[side] = {BoundaryKind::neighbour, {}, {}};
  return sides;
}

/// Incompressible flow on a staggered grid, on the caller's instance of an execution space, for coupling to
/// other kernels. Second order in space and time. The projection is exact to round-off (Chorin 1968; Kim and
/// Moin 1985 for the staggered grid), so that with explicit diffusion a pressure increment would give the
/// same velocity; Crank-Nicolson diffusion needs one.
///
/// Functions block unless stated otherwise. All work is enqueued on the instance given to the constructor,
/// which must outlive the solver; on CUDA it must have a stream of its own. After a failed step the state is
/// that before the step.
///
/// On a group of several ranks each holds a box of the cells (`decompose`). All functions are then
/// collective, every step waits for the host, and arrays are those of the rank (`part_of`).
///
/// Final functions are documented in `Solver`.
template <class ExecutionSpace>
class FlowSolver : public Solver {
 public:
  using Values = List<ExecutionSpace>;

  /// Throws std::invalid_argument as `check_parameters` does, and std::runtime_error if memory runs out. Each
  /// rank gives the same parameters. Throws std::invalid_argument also for fast transforms on CUDA and
  /// several ranks.
  FlowSolver(const device::Instance<ExecutionSpace>& instance, const Parameters& parameters,
             const linear::RankGroup& group = {});

  /// Grid of the arrays. Does not throw.
  [[nodiscard]] const MacGrid& grid() const { return _grid; }
  /// Velocity with ghost cells, m/s; valid after the kernels enqueued so far. Does not throw.
  [[nodiscard]] const Values& velocity() const { return _velocity; }
  /// Force per volume on the faces, N/m^3, in the layout of `velocity`; empty unless
  /// `Parameters::external_force`. On sides it acts only on outflows. Other kernels may write it between
  /// steps; it keeps its values. Does not throw.
  [[nodiscard]] const Values& force() const { return _force; }

  // For a coupling that enqueues other kernels between steps. Asynchronous on one rank, without a bound on
  // the steps in flight; collective and blocking on several.

  /// Enqueues the beginning of an advance to the time `target`, s. Throws only after a failed launch.
  void enqueue_begin(double target);
  /// Enqueues a step, which does nothing if the last advance has reached its target or failed. Throws only
  /// after a failed launch.
  void enqueue_step();
  /// Enqueues the end of an advance, after its last step: the ghost cells of other ranks. Throws only after a
  /// failed launch.
  void enqueue_end();
  /// Sets a constant dt, s, > 0, from the next `enqueue_begin` on. Does not throw.
  void set_fixed_dt(double dt);
  /// Lets a run continue that failed because its fixed dt exceeded the largest stable one. Call it before
  /// `set_fixed_dt` with a shorter one. Blocks. Throws only after a failed kernel.
  void forget_long_step();
  /// Changes, between steps, to a frame of reference with another velocity, m/s: the state becomes that which
  /// an observer in the new frame sees, and the velocities of the sides are those of the parameters relative
  /// to it. Blocks. Throws std::invalid_argument as `check_frame` does.
  void change_frame(const std::array<double, 3>& velocity);
  /// Sets the frame of reference of the velocities in the state, m/s, without changing them. Blocks. Throws
  /// as `change_frame` does.
  void set_frame(const std::array<double, 3>& velocity);
  /// Throws std::invalid_argument if the grid cannot move along the marked axes: along axes of one cell,
  /// towards walls or slip sides, and with sides whose velocity is an expression.
  void check_frame(const std::array<bool, 3>& axes) const { flow::check_frame(_parameters, axes); }
  /// Largest dt, s, of that many equal steps that the CFL condition, `Parameters::max_dt` and prescribed
  /// motion admit at this progress; infinite without a bound, NaN without a finite velocity. Does not throw.
  [[nodiscard]] double largest_dt(const Progress& now, double steps = 1.0) const;
  /// Time after `time`, s, at which prescribed motion jumps next; infinite if it does not. Does not throw.
  [[nodiscard]] double next_jump(double time) const;
  /// Progress after the last step, and how that ended.
  struct Condition {
    Progress now;
    bool has_failed;
    /// The velocity outgrew its stability limit in the last step, whose result is not to be trusted.
    bool last_step_violates_cfl;
  };
  /// Condition after the steps enqueued so far. Blocks. Throws std::runtime_error after a failed kernel.
  [[nodiscard]] Condition condition() const {
    const Control control = read_control();
    const bool has_failed = control.trial.stop == Stop::failed;
    return {control.now, has_failed,
            has_failed && !control.has_failed() && control.now.last_dt > largest_excess * control.trial.dt};
  }
  /// Status as last published. Does not throw.
  [[nodiscard]] Status status() const { return _loop.status(); }
  /// Control block. Other kernels may set `trial.stop` to `Stop::failed`: the next step is not taken, and
  /// `advance` ends. Does not throw.
  [[nodiscard]] const ControlView<ExecutionSpace>& control() const { return _control; }

  void upload(StateField field, std::span<const double> values) final;
  void download(StateField field, std::span<double> values) final;
  void start() final;
  void restore(const Progress& progress) final;
  Stop advance(double target, std::int64_t pause_step, const Poll& poll) final;
  [[nodiscard]] Progress progress() final { return read_control().now; }
  [[nodiscard]] StepFailure failure() final;
  [[nodiscard]] Totals totals() final;
  [[nodiscard]] Extremes extremes() final { return _extremes ? _extremes->read(space()) : Extremes{}; }
  void set_extremes(const Extremes& extremes) final {
    if (!_extremes) throw std::invalid_argument("flow solver: no extremes are watched");
    _extremes->write(space(), extremes);
  }
  void sample(CellField field, std::span<double> values) final;
  [[nodiscard]] const char* driver() const final { return stepping::driver_name(_launcher.driver()); }
  [[nodiscard]] const char* pressure_solver() const final { return _pressure_equation->name(); }
  [[nodiscard]] std::optional<PressureSolve> last_pressure_solve() const final {
    return _pressure_equation->last_solve();
  }

 private:
  struct Steps;

  [[nodiscard]] static auto one_thread(const ExecutionSpace& space) {
    return Kokkos::RangePolicy<ExecutionSpace>(space, 0, 1);
  }
  [[nodiscard]] const ExecutionSpace& space() const { return _instance->space(); }
  [[nodiscard]] Control read_control() const;
  void write_control(Control control);
  void begin_trial(Control control, double dt);
  void add_rates(double weight);
  void use_motion();
  [[nodiscard]] double longest_first_dt() const;
  void set_guess() const;
  [[nodiscard]] stepping::MotionBound motion_bound(const Progress& now, double dt, double steps) const;
  Control solve_present_pressure(double nu, double fraction = 1e-4);
  [[nodiscard]] PackFunctor<ExecutionSpace> packing(StateField field, std::size_t size, bool to_field) const;
  Stop advance_collectively(const stepping::AdvanceRequest& request, const Poll& poll);
  void begin_ghosts(const ExecutionSpace& space, const Values& velocity) const;
  void finish_ghosts(const ExecutionSpace& space, const Values& velocity) const;
  void enqueue_net_inflow(const ExecutionSpace& space) const;
  void enqueue_momentum(const ExecutionSpace& space, const MomentumSetup<ExecutionSpace>& setup) const;
  void enqueue_eddy_viscosity(const ExecutionSpace& space, const Values& velocity) const;
  void enqueue_rates(const ExecutionSpace& space, const MomentumSetup<ExecutionSpace>& setup,
                     double time_fraction) const;
  [[nodiscard]] MomentumSetup<ExecutionSpace> momentum_setup(double nu) const;
  void enqueue_step(const ExecutionSpace& space) const;
  /// Compares the state with the extremes of the steps so far, if they are watched.
  void enqueue_extremes(const ExecutionSpace& space) const {
    if (!_extremes) return;
    finish_ghosts(space, _velocity);
    _extremes->enqueue(space, _velocity, _control, [&](const EnergyView<ExecutionSpace>& whole) {
      if (_halo) _halo->combine(space, whole);
    });
  }
  void enqueue_stage(const ExecutionSpace& space, const MomentumSetup<ExecutionSpace>& setup,
                     const Values& result, double fraction, double time_fraction) const;
  [[nodiscard]] ProjectionSetup<ExecutionSpace> projection_setup(double fraction) const;
  void enqueue_pressure(const ExecutionSpace& space, const ProjectionSetup<ExecutionSpace>& setup) const;
  void enqueue_projection(const ExecutionSpace& space, const ProjectionSetup<ExecutionSpace>& setup) const;
  /// Where the pressures of other ranks arrive; leaves null pointers on one rank.
  void copy_pressure_below(const double* (&pressure_below)[3]) const {
    if (!_halo) return;
    for (std::size_t axis = 0; axis < 3; ++axis) pressure_below[axis] = _halo->pressure_below(axis);
  }
  /// Solution of the pressure equation: the pressure, or its increment.
  [[nodiscard]] const Values& unknown() const {
    return _diffusion ? _pressure_increment : _divergence_or_pressure;
  }
  [[nodiscard]] double kinematic_viscosity() const { return _parameters.viscosity / _parameters.density; }

  const device::Instance<ExecutionSpace>* _instance;
  Parameters _parameters;
  linear::PencilRanks _ranks;
  MacGrid _grid;
  mutable std::optional<Halo<ExecutionSpace>> _halo;  ///< only on several ranks
  BoundaryTables<ExecutionSpace> _boundary;
  bool _checks_inflow;  ///< inflows change in time, and the pressure equation has no solution with a net one
  StepConstants _constants{};
  std::vector<stepping::MotionInterval> _motion;
  Kokkos::View<stepping::MotionInterval*, typename ExecutionSpace::memory_space> _motion_on_device;
  std::array<double, 3> _acceleration{};    ///< m/s^2
  std::array<double, 3> _frame_velocity{};  ///< m/s
  EddyModel _eddy_model{};
  EddyCells _eddy_cells{};
  Values _velocity, _predicted, _force;
  Values _rate_or_stage;  ///< AB2: rate of the step before, m/s^2; RK3: velocity of a stage, m/s
  /// Right-hand side of the pressure equation, 1/s^2; with explicit diffusion also its solution, m^2/s^2, so
  /// that the pressure changes with the velocity, in the correction.
  Values _divergence_or_pressure;
  Values _pressure;
  Values _pressure_increment;                  ///< empty with explicit diffusion, which needs no increments
  Values _eddy_viscosity, _eddy_acceleration;  ///< empty without a turbulence model
  std::optional<TotalsSum<ExecutionSpace>> _totals_sum;
  std::optional<StepExtremes<ExecutionSpace>> _extremes;  ///< if they are watched
  ControlView<ExecutionSpace> _control;
  mutable std::optional<ImplicitDiffusion<ExecutionSpace>> _diffusion;  ///< Crank-Nicolson only
  mutable std::optional<PressureEquation<ExecutionSpace>> _pressure_equation;
  /// False if the last solve was not that of the last step.
  mutable bool _last_solution_is_pressure = false;
  stepping::StepLoop<ExecutionSpace> _loop;
  stepping::StepLauncher<ExecutionSpace> _launcher;
};

template <class ExecutionSpace>
FlowSolver<ExecutionSpace>::FlowSolver(const device::Instance<ExecutionSpace>& instance,
                                       const Parameters& parameters, const linear::RankGroup& group)
    : _instance(&instance),
      _parameters(parameters),
      _ranks((check_parameters(parameters), ranks_of(parameters, group.size(), group.rank()))),
      _grid(make_grid(parameters, _ranks)),
      _boundary(instance.space(), _grid, sides_of(parameters, _ranks)),
      _checks_inflow(pressure_problem(parameters).is_singular() && inflow_changes(parameters.boundary)),
      _loop(instance),
      // Messages and an iterative solver wait for the host in every step, which a graph cannot hold.
      _launcher(instance, parameters.pressure_solver == PressureSolver::hypre_pfmg || group.size() > 1
                              ? Driver::plain
                              : parameters.driver) {
  if (group.size() > 1) _halo.emplace(group, _ranks, parameters, _grid);
  const auto field = [&](const std::string& label) {
    // Packs may load beyond the last cell.
    return Values(label, static_cast<std::size_t>(3 * _grid.component + 64));
  };
  const auto cells = static_cast<std::size_t>(_grid.cells());
  _velocity = field("drogue::flow::velocity");
  _predicted = field("drogue::flow::predicted_velocity");
  _rate_or_stage = field("drogue::flow::rate");
  if (parameters.external_force) _force = field("drogue::flow::force");
  _divergence_or_pressure = Values("drogue::flow::divergence", cells);
  _pressure = Values("drogue::flow::pressure", cells);
  const bool is_implicit = parameters.diffusion == Diffusion::crank_nicolson;
  if (is_implicit) {
    _pressure_increment = Values("drogue::flow::pressure_increment", cells);
    _diffusion.emplace(space(), parameters, group, _ranks);
  }
  _totals_sum.emplace(_grid, _predicted);
  if (parameters.watches_extremes) _extremes.emplace(_grid, parameters.density);
  if (parameters.turbulence != Turbulence::none) {
    _eddy_model = make_eddy_model(parameters, _grid);
    _eddy_cells = make_eddy_cells(_grid, _boundary.conditions().kind);
    _eddy_viscosity = Values("drogue::flow::eddy_viscosity", _eddy_cells.size());
    _eddy_acceleration = field("drogue::flow::eddy_acceleration");
  }
  _control = ControlView<ExecutionSpace>("drogue::flow::control");
  _pressure_equation.emplace(space(), parameters, _halo ? group : linear::RankGroup(), _ranks, !is_implicit);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double length = parameters.high[axis] - parameters.low[axis];
    _acceleration[axis] =
        (parameters.body_force[axis] + parameters.pressure_drop[axis] / length) / parameters.density;
  }
  _constants = step_constants(parameters, _grid);
  use_motion();
  space().fence("drogue::flow::solver: allocated");
}

/// Gives the choice of dt the prescribed motion of all ranks.
template <class ExecutionSpace>
void FlowSolver<ExecutionSpace>::use_motion() {
  _motion = side_motion(_parameters);
  _constants.motions = static_cast<int>(_motion.size());
  if (_motion.empty()) return;
  _motion_on_device = decltype(_motion_on_device)(
      Kokkos::view_alloc(space(), Kokkos::WithoutInitializing, "drogue::flow::motion"), _motion.size());
  device::copy_in(space(), _motion_on_device, _motion.data(), _motion.size());
  _constants.motion = _motion_on_device.data();
}

template <class ExecutionSpace>
Control FlowSolver<ExecutionSpace>::read_control() const {
  Control control;
  device::copy_out(space(), &control, _control, 1);
  space().fence("drogue::flow::solver: read control");
  return control;
}

template <class ExecutionSpace>
void FlowSolver<ExecutionSpace>::write_control(Control control) {
  control.trial.launches = _loop.launches();
  device::copy_in(space(), _control, &control, 1);
  space().fence("drogue::flow::solver: write control");
}

/// Copy of a component of the state to or from the beginning of the predicted velocity, which is free between
/// steps.
template <class ExecutionSpace>
PackFunctor<ExecutionSpace> FlowSolver<ExecutionSpace>::packing(StateField field, std::size_t size,
                                                                bool to_field) const {
  const int index = static_cast<int>(field);
  const bool is_rate = index >= static_cast<int>(StateField::rate_x);
  if (is_rate && _parameters.time_scheme != TimeScheme::ab2)
    throw std::invalid_argument("flow solver: only the scheme AB2 has rates of the previous step");
  const std::array<int, 3> shape = part_of(_parameters, _ranks, field).cells;
  if (size != static_cast<std::size_t>(shape[0]) * static_cast<std::size_t>(shape[1]) *
                  static_cast<std::size_t>(shape[2]))
    throw std::invalid_argument("flow solver: an array of the state has the wrong length");
  const auto axis = static_cast<std::size_t>(index % 3);
  const bool has_low_side = extents(_parameters, field) != _parameters.cells && _ranks.place[axis] == 0;
  return {.grid = _grid,
          .field = is_rate ? _rate_or_stage : _velocity,
          .contiguous = _predicted,
          .first = (index % 3) * _grid.component,
          .extent = {shape[0], shape[1], shape[2]},
          .to_field = to_field,
          .bounded_axis = is_rate && has_low_side ? index % 3 : -1};
}

template <class ExecutionSpace>
void FlowSolver<ExecutionSpace>::upload(StateField field, std::span<const double> values) {
  if (field == StateField::pressure) {
    if (values.size() != _pressure.extent(0))
      throw std::invalid_argument("flow solver: an array of the state has the wrong length");
    device::copy_in(space(), _pressure, values.data(), values.size());
  } else {
    const auto pack = packing(field, values.size(), true);
    device::copy_in(space(), _predicted, values.data(), values.size());
    launch_cells(space(), "drogue::flow::upload", pack.extent, pack);
  }
  space().fence("drogue::flow::upload");
}

template <class ExecutionSpace>
void FlowSolver<ExecutionSpace>::download(StateField field, std::span<double> values) {
  if (field == StateField::pressure) {
    if (values.size() != _pressure.extent(0))
      throw std::invalid_argument("flow solver: an array of the state has the wrong length");
    device::copy_out(space(), values.data(), _pressure, values.size());
  } else {
    const auto pack = packing(field, values.size(), false);
    launch_cells(space(), "drogue::flow::download", pack.extent, pack);
    device::copy_out(space(), values.data(), _predicted, values.size());
  }
  space().fence("drogue::flow::download");
}

template <class ExecutionSpace>
void FlowSolver<ExecutionSpace>::sample(CellField field, std::span<double> values) {
  if (values.size() != static_cast<std::size_t>(_grid.cells()) * static_cast<std::size_t>(components(field)))
    throw std::invalid_argument("flow solver: a field has the wrong length");
  if (field == CellField::pressure) solve_present_pressure(kinematic_viscosity());
  launch_cells(space(), "drogue::flow::sample", _grid.n,
               SampleFunctor<ExecutionSpace>{.grid = _grid,
                                             .velocity = _velocity,
                                             .pressure = unknown(),
                                             .samples = _predicted,
                                             .density = _parameters.density,
                                             .field = field});
  device::copy_out(space(), values.data(), _predicted, values.size());
  space().fence("drogue::flow::sample");
}

/// Lets an iterative solver begin with the pressure of the last step, so that a restart continues bit for
/// bit; with zero if its unknown is an increment.
template <class ExecutionSpace>
void FlowSolver<ExecutionSpace>::set_guess() const {
  if (_diffusion)
    _pressure_equation->set_guess(Values());
  else if (!_last_solution_is_pressure)
    _pressure_equation->set_guess(_pressure);
}

/// Solves for the pressure of the present velocity in `unknown`: that which keeps the velocity of an explicit
/// step free of divergence, in the limit of a short step, with the kinematic viscosity `nu`, m^2/s. Leaves
/// the state as it is. Accelerations of sides are differences over a `fraction` of dt, by whose inverse the
/// round-off of the divergence grows. Returns the control block of the solve, with its failures.
template <class ExecutionSpace>
Control FlowSolver<ExecutionSpace>::solve_present_pressure(double nu, double fraction) {
  const Control kept = read_control();
  const stepping::MotionBound bound =
      motion_bound(kept.now, std::min(admissible_dt(kept.now, _constants), _constants.implicit_dt), 1.0);
  double dt = std::min(bound.dt, bound.jump - kept.now.time);
  // Without a bound, only a force acts, of which the pressure is a multiple.
  if (!(dt > 0.0) || !std::isfinite(dt)) dt = _parameters.horizon > 0.0 ? _parameters.horizon : 1.0;
  begin_trial(kept, fraction * dt);
  MomentumSetup<ExecutionSpace> setup = momentum_setup(nu);
  setup.weights = {0.0, 1.0, false};
  enqueue_rates(space(), setup, 1.0);
  set_guess();
  enqueue_pressure(space(), projection_setup(1.0));
  _last_solution_is_pressure = false;
  if (_boundary.changes()) _boundary.enqueue_evaluation(space(), _control, _constants, {0.0, true});
  const Control solved = read_control();
  write_control(kept);
  return solved;
}

template <class ExecutionSpace>
Totals FlowSolver<ExecutionSpace>::totals() {
  _totals_sum->enqueue(space(), _velocity);
  const Control control = read_control();  // waits
  PartTotals part = _totals_sum->result(_boundary.conditions().kind);
  if (_halo) _halo->combine(part);
  Totals totals = make_totals(part, _parameters, _grid);
  totals.step = control.now.step;
  totals.time = control.now.time;
  totals.dt = control.trial.dt;
  return totals;
}

template <class ExecutionSpace>
void FlowSolver<ExecutionSpace>::start() {
  Control control{};
  control.trial.dt = 1.0;  // the initial projection has no time step; without a pressure on outflows, any dt
                           // gives the same velocity
  control.trial.stop = Stop::running;
  control.first_failure = no_failure;
  write_control(control);
  _boundary.enqueue_evaluation(space(), _control, _constants, {0.0, true});
  enqueue_net_inflow(space());
  for (int axis = 0; axis < 3; ++axis)
    if (_grid.n[axis] == 1 && _boundary.conditions().kind[2 * axis] == BoundaryKind::slip)
      Kokkos::deep_copy(
          space(),
          Values(_velocity.data() + axis * _grid.component, static_cast<std::size_t>(_grid.component)), 0.0);
  begin_ghosts(space(), _velocity);
  finish_ghosts(space(), _velocity);
  device::copy(space(), _predicted, _velocity);
  ProjectionSetup<ExecutionSpace> projection = projection_setup(1.0);
  projection.velocity = _velocity;
  projection.ends_step = true;
  enqueue_projection(space(), projection);
  finish_ghosts(space(), _velocity);
  enqueue_eddy_viscosity(space(), _velocity);
  if (_halo) _halo->agree(space(), _control, _checks_inflow);
  Kokkos::deep_copy(space(), _pressure, 0.0);  // the first step has no pressure of a previous one
  control = read_control();
  control.trial.dt = 0.0;
  control.now.velocity_rate_bits = control.next_rate_bits;
  // No first step is admissible after a failure.
  const auto no_rate_bits = Kokkos::bit_cast<std::uint64_t>(std::numeric_limits<double>::quiet_NaN());
  control.now.rate_bits = control.has_failed() ? no_rate_bits : limiting_rate_bits(control, _constants);
  if (const double longest = longest_first_dt(); std::isfinite(longest)) control.now.longest_dt = longest;
  control.forget_step();
  control.trial.stop = Stop::pause;
  write_control(control);
  if (_diffusion && !control.has_failed()) {
    // The first step of implicit diffusion begins with a pressure, too. That of viscosity decays with the
    // thinnest layers, within a long step.
    const Control solved = solve_present_pressure(
        _constants.fixed_dt > _constants.implicit_dt ? 0.0 : kinematic_viscosity(), 5e-3);
    device::copy(space(), _pressure, unknown());
    if (solved.pressure_failed != 0) {
      control.pressure_failed = 1;
      control.pressure_residual = solved.pressure_residual;
      control.now.rate_bits = no_rate_bits;
      write_control(control);
    }
  }
  _last_solution_is_pressure = false;
  _loop.status_view()().step = 0;
  if (!_extremes) return;
  set_extremes({});
  enqueue_extremes(space());
}

/// Bound of the first dt, s, where the velocity of the start sets none: by what sides of constant velocity
/// and forces set in motion, and by implicit diffusion.
template <class ExecutionSpace>
double FlowSolver<ExecutionSpace>::longest_first_dt() const {
  double acceleration = 0.0;  // in cells, 1/s^2
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (_grid.n[axis] > 1) acceleration += std::abs(_acceleration[axis]) * _grid.inverse_h[axis];
  return std::min({_constants.cfl / rate_of_constant_sides(_parameters),
                   std::sqrt(_constants.cfl / acceleration), first_implicit_dt(_constants)});
}

template <class ExecutionSpace>
void FlowSolver<ExecutionSpace>::restore(const Progress& progress) {
  Control control{};
  control.now = progress;
  control.first_failure = no_failure;
  control.trial.stop = Stop::running;
  write_control(control);
  _boundary.enqueue_evaluation(space(), _control, _constants, {0.0, true});
  begin_ghosts(space(), _velocity);
  finish_ghosts(space(), _velocity);
  enqueue_eddy_viscosity(space(), _velocity);
  control.trial.stop = Stop::pause;
  write_control(control);
  _last_solution_is_pressure = false;
  _loop.status_view()().step = progress.step;
}

template <class ExecutionSpace>
StepFailure FlowSolver<ExecutionSpace>::failure() {
  const Control control = read_control();
  StepFailure failure{{.reason = FailureReason::time_step,
                       .index = -1,
                       .step = control.now.step + 1,
                       .time = control.now.time,
                       .dt = control.trial.dt}};
  if (control.failed_side != 0) {
    failure.reason = FailureReason::side_velocity;
    failure.index = control.failed_side - 1;
  } else if (control.is_unbalanced != 0) {
    failure.reason = FailureReason::net_inflow;
    failure.net_inflow = control.net_inflow;
  } else if (control.first_failure != no_failure) {
    failure.reason = FailureReason::not_finite;
    failure.index = static_cast<std::int64_t>(control.first_failure);
  } else if (control.pressure_failed != 0) {
    failure.reason = FailureReason::pressure_solver;
    failure.pressure_residual = control.pressure_residual;
  } else if (!std::isfinite(Kokkos::bit_cast<double>(control.next_rate_bits))) {
    failure.reason = FailureReason::not_finite;
  }
  return failure;
}

/// Steps of the solver, as `StepLoop` enqueues them.
template <class ExecutionSpace>
struct FlowSolver<ExecutionSpace>::Steps {
  FlowSolver& solver;

  void begin(const stepping::AdvanceRequest& request, std::int64_t output_step) {
    Kokkos::parallel_for("drogue::flow::begin_advance", one_thread(solver.space()),
                         BeginAdvanceFunctor<ExecutionSpace>{.control = solver._control,
                                                             .status = solver._loop.status_view(),
                                                             .constants = solver._constants,
                                                             .request = request,
                                                             .output_step = output_step});
  }
  [[nodiscard]] bool holds_many_steps(int /*variant*/) const { return false; }
  void enqueue(int variant, std::int64_t /*max_steps*/) {
    solver._launcher.launch(variant, [this](const ExecutionSpace& on) { solver.enqueue_step(on); });
  }
};

template <class ExecutionSpace>
Stop FlowSolver<ExecutionSpace>::advance(double target, std::int64_t pause_step, const Poll& poll) {
  const Stop stop = _halo ? advance_collectively({target, pause_step}, poll)
                          : _loop.advance({target, pause_step}, Steps{*this}, poll);
  if (stop == Stop::failed && _boundary.changes()) {
    _boundary.enqueue_evaluation(space(), _control, _constants, {0.0, true});
    space().fence("drogue::flow::advance: sides before the failed step");
  }
  return stop;
}

template <class ExecutionSpace>
void FlowSolver<ExecutionSpace>::enqueue_begin(double target) {
  Steps{*this}.begin({target}, -1);
  _loop.count_launch();
}

template <class ExecutionSpace>
void FlowSolver<ExecutionSpace>::enqueue_step() {
  Steps{*this}.enqueue(0, 1);
  _loop.count_launch();
}

template <class ExecutionSpace>
void FlowSolver<ExecutionSpace>::enqueue_end() {
  finish_ghosts(space(), _velocity);
}

template <class ExecutionSpace>
stepping::MotionBound FlowSolver<ExecutionSpace>::motion_bound(const Progress& now, double dt,
                                                               double steps) const {
  StepConstants constants = _constants;
  constants.motion = _motion.data();  // those of the host
  return resolved_motion(now, dt, steps, constants);
}

template <class ExecutionSpace>
double FlowSolver<ExecutionSpace>::largest_dt(const Progress& now, double steps) const {
  StepConstants constants = _constants;
  constants.fixed_dt = 0.0;
  return motion_bound(now, admissible_dt(now, constants), steps).dt;
}

template <class ExecutionSpace>
double FlowSolver<ExecutionSpace>::next_jump(double time) const {
  for (const stepping::MotionInterval& interval : _motion)
    if (interval.begins_with != 0 && interval.begin - time > stepping::jump_width * interval.begin)
      return interval.begin;
  return std::numeric_limits<double>::infinity();
}

template <class ExecutionSpace>
void FlowSolver<ExecutionSpace>::set_fixed_dt(double dt) {
  if (dt == _constants.fixed_dt) return;
  _constants.fixed_dt = dt;
  _launcher.discard_graphs();  // they hold the constants
}

template <class ExecutionSpace>
void FlowSolver<ExecutionSpace>::set_frame(const std::array<double, 3>& velocity) {
  check_frame({velocity[0] != 0.0, velocity[1] != 0.0, velocity[2] != 0.0});
  _frame_velocity = velocity;
  for (std::size_t side = 0; side < 6; ++side) {
    std::array<double, 3> relative = _parameters.boundary[side].velocity;
    for (std::size_t c = 0; c < 3; ++c) relative[c] -= velocity[c];
    _boundary.set_velocity(side, relative);
  }
  _launcher.discard_graphs();  // they hold the conditions
  begin_ghosts(space(), _velocity);
  finish_ghosts(space(), _velocity);
  space().fence("drogue::flow::set_frame");
}

template <class ExecutionSpace>
void FlowSolver<ExecutionSpace>::change_frame(const std::array<double, 3>& velocity) {
  check_frame({velocity[0] != 0.0, velocity[1] != 0.0, velocity[2] != 0.0});
  double shift[3], rate = 0.0;
  for (std::size_t c = 0; c < 3; ++c) {
    shift[c] = velocity[c] - _frame_velocity[c];
    rate += std::abs(shift[c]) * _grid.inverse_h[c];
  }
  Control control = read_control();
  const double dt = control.now.last_dt;
  // The rates of the previous step change as those of the present velocity do.
  const bool has_rates = _parameters.time_scheme == TimeScheme::ab2 && dt > 0.0;
  if (has_rates) {
    begin_trial(control, dt);
    add_rates(-1.0 / dt);
  }
  device::launch_each(
      space(), "drogue::flow::shift_velocity", static_cast<int>(_grid.component),
      ShiftVelocityFunctor<ExecutionSpace>{_velocity, _grid.component, {shift[0], shift[1], shift[2]}});
  set_frame(velocity);
  if (has_rates) add_rates(1.0 / dt);
  // An upper bound until the next step.
  control.now.rate_bits =
      Kokkos::bit_cast<std::uint64_t>(Kokkos::bit_cast<double>(control.now.rate_bits) + rate);
  write_control(control);
}

/// Lets kernels of a step of `dt`, s, run between steps, until another control block is written.
template <class ExecutionSpace>
void FlowSolver<ExecutionSpace>::begin_trial(Control control, double dt) {
  control.trial.dt = dt;
  control.trial.stop = Stop::running;
  control.first_failure = no_failure;
  control.pressure_failed = control.failed_side = control.is_unbalanced = 0;
  write_control(control);
}

/// Adds `weight`, 1/s, times the change of the present velocity in the step that `begin_trial` began, without
/// forces of other kernels, to the rates of the previous step.
template <class ExecutionSpace>
void FlowSolver<ExecutionSpace>::add_rates(double weight) {
  MomentumSetup<ExecutionSpace> setup = momentum_setup(_diffusion ? 0.0 : kinematic_viscosity());
  setup.weights = {0.0, 1.0, false};
  setup.force = Values();
  enqueue_rates(space(), setup, 1.0);
  launch_cells(space(), "drogue::flow::add_rates", _grid.n,
               AddRatesFunctor<ExecutionSpace>{.grid = _grid,
                                               .boundary = _boundary.conditions(),
                                               .velocity = _velocity,
                                               .predicted = _predicted,
                                               .rate = _rate_or_stage,
                                               .weight = weight});
}

template <class ExecutionSpace>
void FlowSolver<ExecutionSpace>::forget_long_step() {
  Control control = read_control();
  control.trial.stop = Stop::pause;
  write_control(control);
}

/// Step loop of several ranks: step by step, so that all take the same steps.
template <class ExecutionSpace>
Stop FlowSolver<ExecutionSpace>::advance_collectively(const stepping::AdvanceRequest& request,
                                                      const Poll& poll) {
  const auto goes_on = [&] { return _halo->group().all(!poll || poll(_loop.status())); };
  if (!goes_on()) return Stop::interrupted;
  Steps steps{*this};
  steps.begin(request, -1);
  _loop.count_launch();
  space().fence("drogue::flow::advance_collectively: begun");
  bool interrupted = false;
  while (_loop.status().stop == Stop::running && !interrupted) {
    steps.enqueue(0, 1);
    _loop.count_launch();
    space().fence("drogue::flow::advance_collectively: stepped");
    interrupted = _loop.status().stop == Stop::running && !goes_on();
  }
  finish_ghosts(space(), _velocity);
  space().fence("drogue::flow::advance_collectively: stopped");
  return interrupted ? Stop::interrupted : _loop.status().stop;
}

/// Enqueues the fill of the ghost cells of a velocity field; on several ranks it only begins.
template <class ExecutionSpace>
void FlowSolver<ExecutionSpace>::begin_ghosts(const ExecutionSpace& space, const Values& velocity) const {
  if (_halo)
    _halo->begin_velocity(space, velocity);
  else
    launch_ghosts(space, _grid, _boundary.conditions(), velocity, _control);
}

/// Completes what `begin_ghosts` began for the same field.
template <class ExecutionSpace>
void FlowSolver<ExecutionSpace>::finish_ghosts(const ExecutionSpace& space, const Values& velocity) const {
  if (_halo && _halo->finish_velocity(space, velocity))
    launch_ghosts(space, _grid, _boundary.conditions(), velocity, _control);
}

/// Net inflow of the present values of the sides, if it may change and must be zero.
template <class ExecutionSpace>
void FlowSolver<ExecutionSpace>::enqueue_net_inflow(const ExecutionSpace& space) const {
  if (_checks_inflow)
    launch_net_inflow(space,
                      NetInflowFunctor<ExecutionSpace>{_grid, _boundary.conditions(), _control, !_halo});
}

/// Momentum stage. On several ranks, cells that need no other rank come first, while the messages are under
/// way.
template <class ExecutionSpace>
void FlowSolver<ExecutionSpace>::enqueue_momentum(const ExecutionSpace& space,
                                                  const MomentumSetup<ExecutionSpace>& setup) const {
  if (!_halo) return dispatch_momentum(space, setup, _parameters.advection);
  MomentumSetup<ExecutionSpace> part = setup;
  const std::vector<MacGrid> parts = _halo->parts();
  for (std::size_t i = 0; i < parts.size(); ++i) {
    // The cells inside need the ghost cells at the sides of the domain.
    if (i == 0 && parts.size() > 1)
      launch_ghosts(space, _grid, _boundary.conditions(), setup.stage, _control);
    if (i == 1 || parts.size() == 1) finish_ghosts(space, setup.stage);
    part.grid = parts[i];
    dispatch_momentum(space, part, _parameters.advection);
  }
}

/// Momentum stage of the state, without weights. `nu`: kinematic viscosity, m^2/s.
template <class ExecutionSpace>
MomentumSetup<ExecutionSpace> FlowSolver<ExecutionSpace>::momentum_setup(double nu) const {
  // m^2/s^2: above zero, so that a uniform velocity is kept, and below the square of any difference that
  // round-off leaves of a velocity above 1e-19 m/s, so that results do not depend on the unit of velocity.
  // Its fourth power, a product of the weights, is a number.
  constexpr double smoothness_floor = 1e-72;
  return {.grid = _grid,
          .state = _velocity,
          .stage = _velocity,
          .out = _predicted,
          .old_rate = _rate_or_stage,
          .force = _force,
          .eddy = _eddy_acceleration,
          .control = _control,
          .nu = nu,
          .acceleration = {_acceleration[0], _acceleration[1], _acceleration[2]},
          .specific_volume = 1.0 / _parameters.density,
          .epsilon = smoothness_floor,
          .rows = tile_rows(_parameters.block),
          .weights = {}};
}

template <class ExecutionSpace>
void FlowSolver<ExecutionSpace>::enqueue_step(const ExecutionSpace& space) const {
  MomentumSetup<ExecutionSpace> setup = momentum_setup(_diffusion ? 0.0 : kinematic_viscosity());
  set_guess();
  _last_solution_is_pressure = true;
  if (_parameters.time_scheme == TimeScheme::ab2) {
    setup.weights = {0.0, 1.0, true};
    enqueue_stage(space, setup, _velocity, 1.0, 1.0);
  } else {
    // Shu and Osher 1988, eq. (2.18). The first two stages are projected into the array of rates.
    setup.weights = {0.0, 1.0, false};
    enqueue_stage(space, setup, _rate_or_stage, 1.0, 1.0);
    setup.stage = _rate_or_stage;
    setup.weights = {0.75, 0.25, false};
    enqueue_stage(space, setup, _rate_or_stage, 0.25, 0.5);
    setup.weights = {1.0 / 3.0, 2.0 / 3.0, false};
    enqueue_stage(space, setup, _velocity, 2.0 / 3.0, 1.0);
  }
  enqueue_eddy_viscosity(space, _velocity);
  if (_halo) _halo->agree(space, _control, _checks_inflow);
  Kokkos::parallel_for("drogue::flow::finish_step", one_thread(space),
                       FinishStepFunctor<ExecutionSpace>{_control, _loop.status_view(), _constants});
  enqueue_extremes(space);
}

/// Eddy viscosity of a velocity field, if there is a model. That of the state is evaluated at the end of a
/// step, because it limits the next dt.
template <class ExecutionSpace>
void FlowSolver<ExecutionSpace>::enqueue_eddy_viscosity(const ExecutionSpace& space,
                                                        const Values& velocity) const {
  if (_parameters.turbulence == Turbulence::none) return;
  finish_ghosts(space, velocity);
  launch_cells(space, "drogue::flow::eddy_viscosity", _eddy_cells.extent,
               EddyViscosityFunctor<ExecutionSpace>{.grid = _grid,
                                                    .model = _eddy_model,
                                                    .velocity = velocity,
                                                    .cells = _eddy_cells,
                                                    .viscosity = _eddy_viscosity,
                                                    .control = _control});
}

/// Predicted velocity of a momentum stage. `time_fraction`: of dt at which it has the values of the sides.
template <class ExecutionSpace>
void FlowSolver<ExecutionSpace>::enqueue_rates(const ExecutionSpace& space,
                                               const MomentumSetup<ExecutionSpace>& setup,
                                               double time_fraction) const {
  if (_parameters.turbulence != Turbulence::none)
    launch_cells(space, "drogue::flow::eddy_stress", _grid.n,
                 EddyStressFunctor<ExecutionSpace>{.grid = _grid,
                                                   .velocity = setup.stage,
                                                   .cells = _eddy_cells,
                                                   .viscosity = _eddy_viscosity,
                                                   .acceleration = _eddy_acceleration,
                                                   .control = _control});
  enqueue_momentum(space, setup);
  if (_boundary.changes()) _boundary.enqueue_evaluation(space, _control, _constants, {time_fraction, false});
  enqueue_net_inflow(space);
  launch_boundary_faces(space, setup, _boundary.conditions(), _parameters.advection);
}

/// Momentum stage and projection. `fraction`: of dt that the pressure of the stage acts; `time_fraction`: of
/// dt at which the result of the stage approximates the velocity.
template <class ExecutionSpace>
void FlowSolver<ExecutionSpace>::enqueue_stage(const ExecutionSpace& space,
                                               const MomentumSetup<ExecutionSpace>& setup,
                                               const Values& result, double fraction,
                                               double time_fraction) const {
  if (setup.stage.data() != _velocity.data()) enqueue_eddy_viscosity(space, setup.stage);
  enqueue_rates(space, setup, time_fraction);
  if (_diffusion) {
    DiffusionSetup<ExecutionSpace> diffusion{.grid = _grid,
                                             .boundary = _boundary.conditions(),
                                             .velocity = _velocity,
                                             .predicted = _predicted,
                                             .pressure = _pressure,
                                             .control = _control,
                                             .nu = kinematic_viscosity(),
                                             .pressure_below = {}};
    if (_halo) _halo->exchange_pressure(space, _pressure);
    copy_pressure_below(diffusion.pressure_below);
    _diffusion->enqueue(space, diffusion, _divergence_or_pressure, _pressure_increment);
  }
  ProjectionSetup<ExecutionSpace> projection = projection_setup(fraction);
  projection.velocity = result;
  if (result.data() == _velocity.data()) {
    projection.ends_step = true;
    projection.total_pressure = _pressure;
  }
  enqueue_projection(space, projection);
}

/// Projection of the predicted velocity, without a result.
template <class ExecutionSpace>
ProjectionSetup<ExecutionSpace> FlowSolver<ExecutionSpace>::projection_setup(double fraction) const {
  ProjectionSetup<ExecutionSpace> setup{.grid = _grid,
                                        .boundary = _boundary.conditions(),
                                        .predicted = _predicted,
                                        .velocity = Values(),
                                        .divergence = _divergence_or_pressure,
                                        .pressure = unknown(),
                                        .total_pressure = Values(),
                                        .is_increment = _diffusion.has_value(),
                                        .control = _control,
                                        .nu = kinematic_viscosity(),
                                        .step_fraction = fraction,
                                        .ends_step = false,
                                        .rows = tile_rows(_parameters.block),
                                        .pressure_below = {}};
  copy_pressure_below(setup.pressure_below);
  return setup;
}

/// Solves the pressure equation for `unknown`.
template <class ExecutionSpace>
void FlowSolver<ExecutionSpace>::enqueue_pressure(const ExecutionSpace& space,
                                                  const ProjectionSetup<ExecutionSpace>& setup) const {
  if (_halo) _halo->exchange_high_faces(space, _predicted);
  launch_divergence(space, setup);
  if (!_pressure_equation->enqueue_solve(_divergence_or_pressure, unknown()))
    device::launch_each(space, "drogue::flow::pressure_failure", 1,
                        PressureFailureFunctor<ExecutionSpace>{_control, last_pressure_solve()->residual});
}

template <class ExecutionSpace>
void FlowSolver<ExecutionSpace>::enqueue_projection(const ExecutionSpace& space,
                                                    const ProjectionSetup<ExecutionSpace>& setup) const {
  enqueue_pressure(space, setup);
  if (_halo) {
    // No rank may overwrite the state if another one has failed.
    _halo->agree(space, _control, _checks_inflow);
    _halo->exchange_pressure(space, unknown());
  }
  launch_correction(space, setup);
  begin_ghosts(space, setup.velocity);
}

// One translation unit per backend compiles the solver.
DROGUE_EXTERN_INSTANCES(class FlowSolver)

}  // namespace drogue::flow
