#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "kernels/device/copy.hpp"
#include "kernels/flow/observables/extremes.hpp"
#include "kernels/flow/observables/sample.hpp"
#include "kernels/flow/observables/totals.hpp"
#include "kernels/flow/shift_frame.hpp"
#include "kernels/flow/solver.hpp"
#include "kernels/flow/step.hpp"
#include "kernels/stepping/step_launcher.hpp"

namespace drogue::flow {

/// Incompressible flow on a staggered grid, on the caller's instance of an execution space, for coupling to
/// other kernels: the life of a run around `Step`, which holds method and arrays. Second order in space and
/// time.
///
/// Functions block unless stated otherwise. All work is enqueued on the instance given to the constructor,
/// which must outlive the solver; on CUDA it must have a stream of its own. After a failed step the state is
/// that before the step.
///
/// On a group of several ranks each holds a box of the cells (`ranks_of`). All functions are then collective,
/// and arrays are those of the rank. Steps wait for the host unless `Step::is_asynchronous`.
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

  /// Messages between the ranks. Does not throw.
  [[nodiscard]] const linear::DeviceCommunicator<ExecutionSpace>& communicator() const {
    return _step.halo.communicator();
  }
  /// Grid of the arrays. Does not throw.
  [[nodiscard]] const MacGrid& grid() const { return _step.grid; }
  /// Velocity with ghost cells, m/s; valid after the kernels enqueued so far. Does not throw.
  [[nodiscard]] const Values& velocity() const { return _step.fields.velocity; }
  /// Force per volume on the faces, N/m^3, in the layout of `velocity`; empty unless
  /// `Parameters::external_force`. On sides it acts only on outflows. Other kernels may write it between
  /// steps; it keeps its values. Does not throw.
  [[nodiscard]] const Values& force() const { return _step.fields.force; }

  // For a coupling that enqueues other kernels between steps. Collective, and asynchronous if
  // `Step::is_asynchronous`, without a bound on the steps in flight.

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
  void check_frame(const std::array<bool, 3>& axes) const { flow::check_frame(_step.parameters, axes); }
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
  [[nodiscard]] const ControlView<ExecutionSpace>& control() const { return _step.control; }

  [[nodiscard]] std::vector<stepping::StateArray> state() const final;
  void upload(std::string_view name, std::span<const double> values) final;
  void download(std::string_view name, std::span<double> values) final;
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
  [[nodiscard]] linear::Transport transport() const final { return communicator().transport(); }
  [[nodiscard]] const char* pressure_solver() const final { return _step.pressure_equation->name(); }
  [[nodiscard]] std::optional<PressureSolve> last_pressure_solve() const final {
    return _step.pressure_equation->last_solve();
  }

 private:
  struct Steps;

  [[nodiscard]] const ExecutionSpace& space() const { return _instance->space(); }
  [[nodiscard]] Control read_control() const;
  void write_control(Control control);
  void begin_trial(Control control, double dt);
  void add_rates(double weight);
  void fill_ghosts();
  [[nodiscard]] double longest_first_dt() const;
  [[nodiscard]] stepping::MotionBound motion_bound(const Progress& now, double dt, double steps) const;
  Control solve_present_pressure(double nu, double fraction = 1e-4);
  [[nodiscard]] const StateEntry<ExecutionSpace>& find(std::string_view name, std::size_t size) const;
  [[nodiscard]] PackFunctor<ExecutionSpace> packing(const StateEntry<ExecutionSpace>& entry,
                                                    bool to_field) const;
  Stop advance_together(const stepping::AdvanceRequest& request, const Poll& poll);
  Stop advance_by_step(const stepping::AdvanceRequest& request, const Poll& poll);
  void enqueue_extremes(const ExecutionSpace& space);

  const device::Instance<ExecutionSpace>* _instance;
  Step<ExecutionSpace> _step;
  std::vector<StateEntry<ExecutionSpace>> _state;
  std::array<double, 3> _frame_velocity{};  ///< m/s
  TotalsSum<ExecutionSpace> _totals_sum;
  std::optional<StepExtremes<ExecutionSpace>> _extremes;  ///< if they are watched
  stepping::StepLoop<ExecutionSpace> _loop;
  stepping::StepLauncher<ExecutionSpace> _launcher;
};

template <class ExecutionSpace>
FlowSolver<ExecutionSpace>::FlowSolver(const device::Instance<ExecutionSpace>& instance,
                                       const Parameters& parameters, const linear::RankGroup& group)
    : _instance(&instance),
      _step(instance.space(), parameters, group),
      _state(make_state(_step.fields, parameters, _step.ranks)),
      _totals_sum(_step.grid, _step.fields.predicted),
      _loop(instance),
      // A graph cannot hold a step that waits for the host.
      _launcher(instance, _step.is_asynchronous() ? parameters.driver : Driver::plain) {
  if (parameters.watches_extremes) _extremes.emplace(_step.grid, parameters.density);
}

template <class ExecutionSpace>
Control FlowSolver<ExecutionSpace>::read_control() const {
  Control control;
  device::copy_out(space(), &control, _step.control, 1);
  space().fence("drogue::flow::solver: read control");
  return control;
}

template <class ExecutionSpace>
void FlowSolver<ExecutionSpace>::write_control(Control control) {
  control.trial.launches = _loop.launches();
  device::copy_in(space(), _step.control, &control, 1);
  space().fence("drogue::flow::solver: write control");
}

template <class ExecutionSpace>
std::vector<stepping::StateArray> FlowSolver<ExecutionSpace>::state() const {
  std::vector<stepping::StateArray> arrays;
  for (const StateEntry<ExecutionSpace>& entry : _state) arrays.push_back(entry.array);
  return arrays;
}

/// Array of the state with that name and number of entries. Throws as `upload`.
template <class ExecutionSpace>
const StateEntry<ExecutionSpace>& FlowSolver<ExecutionSpace>::find(std::string_view name,
                                                                   std::size_t size) const {
  for (const StateEntry<ExecutionSpace>& entry : _state) {
    if (entry.array.name != name) continue;
    if (entry.array.size() == size) return entry;
    throw std::invalid_argument("flow solver: an array of the state has the wrong length");
  }
  throw std::invalid_argument("flow solver: its state has no array '" + std::string(name) + "'");
}

/// Copy of an array on faces to or from the beginning of the predicted velocity, which is free between steps.
template <class ExecutionSpace>
PackFunctor<ExecutionSpace> FlowSolver<ExecutionSpace>::packing(const StateEntry<ExecutionSpace>& entry,
                                                                bool to_field) const {
  const auto whole = x_first(entry.array.whole), extent = x_first(entry.array.extent);
  const int axis = static_cast<int>(entry.normal);
  // The rates of low faces on a side stand in the ghost cells below them.
  const bool is_rate = entry.values.data() == _step.fields.rate.data();
  const bool has_low_side = whole[entry.normal] != _step.parameters.cells[entry.normal] &&
                            x_first(entry.array.begin)[entry.normal] == 0;
  return {.grid = _step.grid,
          .field = entry.values,
          .contiguous = _step.fields.predicted,
          .first = axis * _step.grid.component,
          .extent = {extent[0], extent[1], extent[2]},
          .to_field = to_field,
          .bounded_axis = is_rate && has_low_side ? axis : -1};
}

template <class ExecutionSpace>
void FlowSolver<ExecutionSpace>::upload(std::string_view name, std::span<const double> values) {
  const StateEntry<ExecutionSpace>& entry = find(name, values.size());
  const bool on_faces = entry.normal != at_cells;
  device::copy_in(space(), on_faces ? _step.fields.predicted : entry.values, values.data(), values.size());
  if (on_faces) {
    const auto pack = packing(entry, true);
    launch_cells(space(), "drogue::flow::upload", pack.extent, pack);
  }
  space().fence("drogue::flow::upload");
}

template <class ExecutionSpace>
void FlowSolver<ExecutionSpace>::download(std::string_view name, std::span<double> values) {
  const StateEntry<ExecutionSpace>& entry = find(name, values.size());
  const bool on_faces = entry.normal != at_cells;
  if (on_faces) {
    const auto pack = packing(entry, false);
    launch_cells(space(), "drogue::flow::download", pack.extent, pack);
  }
  device::copy_out(space(), values.data(), on_faces ? _step.fields.predicted : entry.values, values.size());
  space().fence("drogue::flow::download");
}

template <class ExecutionSpace>
void FlowSolver<ExecutionSpace>::sample(CellField field, std::span<double> values) {
  if (values.size() !=
      static_cast<std::size_t>(_step.grid.cells()) * static_cast<std::size_t>(components(field)))
    throw std::invalid_argument("flow solver: a field has the wrong length");
  if (field == CellField::pressure) solve_present_pressure(_step.kinematic_viscosity());
  launch_cells(space(), "drogue::flow::sample", _step.grid.n,
               SampleFunctor<ExecutionSpace>{.grid = _step.grid,
                                             .velocity = _step.fields.velocity,
                                             .pressure = _step.fields.solution,
                                             .samples = _step.fields.predicted,
                                             .density = _step.parameters.density,
                                             .field = field});
  device::copy_out(space(), values.data(), _step.fields.predicted, values.size());
  space().fence("drogue::flow::sample");
}

/// Solves for the pressure of the present velocity in `Fields::solution`: that which keeps the velocity of an
/// explicit step free of divergence, in the limit of a short step, with the kinematic viscosity `nu`, m^2/s.
/// Leaves the state as it is. Accelerations of sides are differences over a `fraction` of dt, by whose
/// inverse the round-off of the divergence grows. Returns the control block of the solve, with its failures.
template <class ExecutionSpace>
Control FlowSolver<ExecutionSpace>::solve_present_pressure(double nu, double fraction) {
  const Control kept = read_control();
  const stepping::MotionBound bound = motion_bound(
      kept.now, std::min(admissible_dt(kept.now, _step.constants), _step.constants.implicit_dt), 1.0);
  double dt = std::min(bound.dt, bound.jump - kept.now.time);
  // Without a bound, only a force acts, of which the pressure is a multiple.
  if (!(dt > 0.0) || !std::isfinite(dt)) dt = _step.parameters.horizon > 0.0 ? _step.parameters.horizon : 1.0;
  begin_trial(kept, fraction * dt);
  MomentumSetup<ExecutionSpace> setup =
      _step.momentum_setup(_step.fields.velocity, {.state = 0.0, .rate = 1.0});
  setup.nu = nu;
  _step.predict_explicitly(space(), setup, 1.0);
  _step.set_guess();
  _step.solve_pressure(space(), _step.projection_setup(Values(), 1.0));
  _step.last_solution_is_pressure = false;
  if (_step.boundary.changes())
    _step.boundary.enqueue_evaluation(space(), _step.control, _step.constants, {0.0, true});
  const Control solved = read_control();
  write_control(kept);
  return solved;
}

template <class ExecutionSpace>
Totals FlowSolver<ExecutionSpace>::totals() {
  _totals_sum.enqueue(space(), _step.fields.velocity);
  const Control control = read_control();  // waits
  PartTotals part = _totals_sum.result(_step.boundary.conditions().kind);
  _step.halo.combine(part);
  Totals totals = make_totals(part, _step.parameters, _step.grid);
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
  _step.boundary.enqueue_evaluation(space(), _step.control, _step.constants, {0.0, true});
  _step.enqueue_net_inflow(space());
  for (int axis = 0; axis < 3; ++axis)
    if (_step.grid.n[axis] == 1 && _step.boundary.conditions().kind[2 * axis] == BoundaryKind::slip)
      Kokkos::deep_copy(space(),
                        Values(_step.fields.velocity.data() + axis * _step.grid.component,
                               static_cast<std::size_t>(_step.grid.component)),
                        0.0);
  fill_ghosts();
  device::copy(space(), _step.fields.predicted, _step.fields.velocity);
  _step.project(space(), _step.fields.velocity, 1.0);
  _step.finish_ghosts(space(), _step.fields.velocity);
  _step.evaluate_eddy_viscosity(space(), _step.fields.velocity);
  _step.halo.agree(space(), _step.control, _step.checks_inflow);
  Kokkos::deep_copy(space(), _step.fields.pressure, 0.0);  // the first step has no pressure of a previous one
  control = read_control();
  control.trial.dt = 0.0;
  control.now.velocity_rate_bits = control.next_rate_bits;
  // No first step is admissible after a failure.
  const auto no_rate_bits = Kokkos::bit_cast<std::uint64_t>(std::numeric_limits<double>::quiet_NaN());
  control.now.rate_bits = control.has_failed() ? no_rate_bits : limiting_rate_bits(control, _step.constants);
  if (const double longest = longest_first_dt(); std::isfinite(longest)) control.now.longest_dt = longest;
  control.forget_step();
  control.trial.stop = Stop::pause;
  write_control(control);
  if (_step.diffusion && !control.has_failed()) {
    // The first step of implicit diffusion begins with a pressure, too. That of viscosity decays with the
    // thinnest layers, within a long step.
    const Control solved = solve_present_pressure(
        _step.constants.fixed_dt > _step.constants.implicit_dt ? 0.0 : _step.kinematic_viscosity(), 5e-3);
    device::copy(space(), _step.fields.pressure, _step.fields.solution);
    if (solved.pressure_failed != 0) {
      control.pressure_failed = 1;
      control.pressure_residual = solved.pressure_residual;
      control.now.rate_bits = no_rate_bits;
      write_control(control);
    }
  }
  _step.last_solution_is_pressure = false;
  _loop.status_view()().step = 0;
  if (_extremes) set_extremes({});
  enqueue_extremes(space());
}

/// Fills the ghost cells of the velocity.
template <class ExecutionSpace>
void FlowSolver<ExecutionSpace>::fill_ghosts() {
  _step.begin_ghosts(space(), _step.fields.velocity);
  _step.finish_ghosts(space(), _step.fields.velocity);
}

/// Compares the state with the extremes of the steps so far, if they are watched.
template <class ExecutionSpace>
void FlowSolver<ExecutionSpace>::enqueue_extremes(const ExecutionSpace& space) {
  if (!_extremes) return;
  _step.finish_ghosts(space, _step.fields.velocity);
  _extremes->enqueue(space, _step.fields.velocity, _step.control, _step.halo);
}

/// Bound of the first dt, s, where the velocity of the start sets none: by what sides of constant velocity
/// and forces set in motion, and by implicit diffusion.
template <class ExecutionSpace>
double FlowSolver<ExecutionSpace>::longest_first_dt() const {
  double acceleration = 0.0;  // in cells, 1/s^2
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (_step.grid.n[axis] > 1)
      acceleration += std::abs(_step.acceleration[axis]) * _step.grid.inverse_h[axis];
  return std::min({_step.constants.cfl / rate_of_constant_sides(_step.parameters),
                   std::sqrt(_step.constants.cfl / acceleration), first_implicit_dt(_step.constants)});
}

template <class ExecutionSpace>
void FlowSolver<ExecutionSpace>::restore(const Progress& progress) {
  Control control{};
  control.now = progress;
  control.first_failure = no_failure;
  control.trial.stop = Stop::running;
  write_control(control);
  _step.boundary.enqueue_evaluation(space(), _step.control, _step.constants, {0.0, true});
  fill_ghosts();
  _step.evaluate_eddy_viscosity(space(), _step.fields.velocity);
  control.trial.stop = Stop::pause;
  write_control(control);
  _step.last_solution_is_pressure = false;
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
    Kokkos::parallel_for("drogue::flow::begin_advance",
                         Kokkos::RangePolicy<ExecutionSpace>(solver.space(), 0, 1),
                         BeginAdvanceFunctor<ExecutionSpace>{.control = solver._step.control,
                                                             .status = solver._loop.status_view(),
                                                             .constants = solver._step.constants,
                                                             .request = request,
                                                             .output_step = output_step});
  }
  [[nodiscard]] bool holds_many_steps(int /*variant*/) const { return false; }
  void enqueue(int variant, std::int64_t /*max_steps*/) {
    solver._launcher.launch(variant, [this](const ExecutionSpace& on) {
      solver._step.enqueue(on, solver._loop.status_view());
      solver.enqueue_extremes(on);
    });
    // Not every step of a graph has been enqueued here.
    if (solver._step.outdates_ghosts()) solver._step.halo.outdate_velocity();
  }
  /// Lets this rank launch as many steps as the others, whose messages wait for it. Those beyond the stop do
  /// nothing.
  void complete_launches() {
    const linear::RankGroup& group = solver._step.halo.group();
    auto most = static_cast<std::uint64_t>(solver._loop.launches());
    group.maximize({&most, 1});
    while (solver._loop.launches() < static_cast<std::int64_t>(most)) {
      enqueue(0, 1);
      solver._loop.count_launch();
    }
  }
};

template <class ExecutionSpace>
Stop FlowSolver<ExecutionSpace>::advance(double target, std::int64_t pause_step, const Poll& poll) {
  const stepping::AdvanceRequest request{target, pause_step};
  const Stop stop = _step.halo.is_alone()     ? _loop.advance(request, Steps{*this}, poll)
                    : _step.is_asynchronous() ? advance_together(request, poll)
                                              : advance_by_step(request, poll);
  if (stop == Stop::failed && _step.boundary.changes()) {
    _step.boundary.enqueue_evaluation(space(), _step.control, _step.constants, {0.0, true});
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
  _step.finish_ghosts(space(), _step.fields.velocity);
}

template <class ExecutionSpace>
stepping::MotionBound FlowSolver<ExecutionSpace>::motion_bound(const Progress& now, double dt,
                                                               double steps) const {
  StepConstants constants = _step.constants;
  constants.motion = _step.motion.data();  // those of the host
  return resolved_motion(now, dt, steps, constants);
}

template <class ExecutionSpace>
double FlowSolver<ExecutionSpace>::largest_dt(const Progress& now, double steps) const {
  StepConstants constants = _step.constants;
  constants.fixed_dt = 0.0;
  return motion_bound(now, admissible_dt(now, constants), steps).dt;
}

template <class ExecutionSpace>
double FlowSolver<ExecutionSpace>::next_jump(double time) const {
  for (const stepping::MotionInterval& interval : _step.motion)
    if (interval.begins_with != 0 && interval.begin - time > stepping::jump_width * interval.begin)
      return interval.begin;
  return std::numeric_limits<double>::infinity();
}

template <class ExecutionSpace>
void FlowSolver<ExecutionSpace>::set_fixed_dt(double dt) {
  if (dt == _step.constants.fixed_dt) return;
  _step.constants.fixed_dt = dt;
  _launcher.discard_graphs();  // they hold the constants
}

template <class ExecutionSpace>
void FlowSolver<ExecutionSpace>::set_frame(const std::array<double, 3>& velocity) {
  check_frame({velocity[0] != 0.0, velocity[1] != 0.0, velocity[2] != 0.0});
  _frame_velocity = velocity;
  for (std::size_t side = 0; side < 6; ++side) {
    std::array<double, 3> relative = _step.parameters.boundary[side].velocity;
    for (std::size_t c = 0; c < 3; ++c) relative[c] -= velocity[c];
    _step.boundary.set_velocity(side, relative);
  }
  _launcher.discard_graphs();  // they hold the conditions
  fill_ghosts();
  space().fence("drogue::flow::set_frame");
}

template <class ExecutionSpace>
void FlowSolver<ExecutionSpace>::change_frame(const std::array<double, 3>& velocity) {
  check_frame({velocity[0] != 0.0, velocity[1] != 0.0, velocity[2] != 0.0});
  double shift[3], rate = 0.0;
  for (std::size_t c = 0; c < 3; ++c) {
    shift[c] = velocity[c] - _frame_velocity[c];
    rate += std::abs(shift[c]) * _step.grid.inverse_h[c];
  }
  Control control = read_control();
  const double dt = control.now.last_dt;
  // The rates of the previous step change as those of the present velocity do.
  const bool has_rates = _step.parameters.time_scheme == TimeScheme::ab2 && dt > 0.0;
  if (has_rates) {
    begin_trial(control, dt);
    add_rates(-1.0 / dt);
  }
  device::launch_each(space(), "drogue::flow::shift_velocity", static_cast<int>(_step.grid.component),
                      ShiftVelocityFunctor<ExecutionSpace>{
                          _step.fields.velocity, _step.grid.component, {shift[0], shift[1], shift[2]}});
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
  MomentumSetup<ExecutionSpace> setup =
      _step.momentum_setup(_step.fields.velocity, {.state = 0.0, .rate = 1.0});
  setup.force = Values();
  _step.predict_explicitly(space(), setup, 1.0);
  launch_cells(space(), "drogue::flow::add_rates", _step.grid.n,
               AddRatesFunctor<ExecutionSpace>{.grid = _step.grid,
                                               .boundary = _step.boundary.conditions(),
                                               .velocity = _step.fields.velocity,
                                               .predicted = _step.fields.predicted,
                                               .rate = _step.fields.rate,
                                               .weight = weight});
}

template <class ExecutionSpace>
void FlowSolver<ExecutionSpace>::forget_long_step() {
  Control control = read_control();
  control.trial.stop = Stop::pause;
  write_control(control);
}

/// Step loop of several ranks that wait for no host: the device decides after which step all stop, also for
/// the poll of one.
template <class ExecutionSpace>
Stop FlowSolver<ExecutionSpace>::advance_together(const stepping::AdvanceRequest& request, const Poll& poll) {
  if (!_step.halo.group().all(!poll || poll(_loop.status()))) return Stop::interrupted;
  _step.halo.ask_for_interrupt(false);
  const Stop stop = _loop.advance(request, Steps{*this}, [&](const Status& now) {
    if (poll && !poll(now)) _step.halo.ask_for_interrupt(true);
    return true;
  });
  _step.finish_ghosts(space(), _step.fields.velocity);
  space().fence("drogue::flow::advance_together: stopped");
  return stop;
}

/// Step loop of several ranks whose steps wait for the host: step by step, so that all take the same steps.
template <class ExecutionSpace>
Stop FlowSolver<ExecutionSpace>::advance_by_step(const stepping::AdvanceRequest& request, const Poll& poll) {
  const auto goes_on = [&] { return _step.halo.group().all(!poll || poll(_loop.status())); };
  if (!goes_on()) return Stop::interrupted;
  Steps steps{*this};
  steps.begin(request, -1);
  _loop.count_launch();
  space().fence("drogue::flow::advance_by_step: begun");
  bool interrupted = false;
  while (_loop.status().stop == Stop::running && !interrupted) {
    steps.enqueue(0, 1);
    _loop.count_launch();
    space().fence("drogue::flow::advance_by_step: stepped");
    interrupted = _loop.status().stop == Stop::running && !goes_on();
  }
  _step.finish_ghosts(space(), _step.fields.velocity);
  space().fence("drogue::flow::advance_by_step: stopped");
  return interrupted ? Stop::interrupted : _loop.status().stop;
}

// One translation unit per backend compiles the solver.
DROGUE_EXTERN_INSTANCES(class FlowSolver)

}  // namespace drogue::flow
