#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <vector>

#include "kernels/coupling/sheet/immersed_sheet.hpp"
#include "kernels/coupling/sheet/line_cuts.hpp"
#include "kernels/coupling/sheet/line_strength.hpp"
#include "kernels/coupling/sheet/moving_frame.hpp"
#include "kernels/coupling/sheet/solver.hpp"
#include "kernels/coupling/sheet/state_list.hpp"
#include "kernels/coupling/sheet/vertex_motion.hpp"
#include "kernels/coupling/total_force.hpp"
#include "kernels/device/stopwatch.hpp"
#include "kernels/fabric/fabric_solver.hpp"
#include "kernels/fabric/peak_pulls.hpp"
#include "kernels/flow/face_views.hpp"
#include "kernels/flow/flow_solver.hpp"

namespace drogue::fabric {
DROGUE_EXTERN_INSTANCES(class FabricSolver, coupling::AirRelaxation)
}  // namespace drogue::fabric

namespace drogue::coupling {

/// Step of the flow at whose beginning the cloth was saved.
template <class ExecutionSpace>
using SavedStep = Kokkos::View<std::int64_t, typename ExecutionSpace::memory_space>;

/// Saves the state at the beginning of a step of the flow. After the flow has stopped, only the state at the
/// end of its last step is new.
template <class ExecutionSpace>
struct SaveStateFunctor {
  flow::ControlView<ExecutionSpace> control;
  SavedStep<ExecutionSpace> saved_step;
  CopyRowsFunctor<ExecutionSpace> save;

  KOKKOS_FUNCTION void operator()(const int i) const {
    if (control().trial.stop != flow::Stop::running && control().now.step == saved_step()) return;
    save(i);
  }
};

/// Kernel of one thread that completes `SaveStateFunctor`, and stops the flow before its step if the cloth
/// has failed.
template <class ExecutionSpace>
struct CheckClothFunctor {
  using ReasonView = Kokkos::View<FailureReason, typename ExecutionSpace::memory_space>;

  flow::ControlView<ExecutionSpace> control;
  SavedStep<ExecutionSpace> saved_step;
  stepping::StepMonitor<ExecutionSpace> cloth;
  GridTransfer<ExecutionSpace> transfer;
  ReasonView reason;
  Kokkos::View<int, typename ExecutionSpace::memory_space> broken_line, failed_line;

  KOKKOS_FUNCTION void operator()(int) const {
    saved_step() = control().now.step;
    const int broken = broken_line();
    broken_line() = no_line;
    if (control().trial.stop != flow::Stop::running) return;
    const TransferCounts counts = transfer.counts();
    FailureReason found = FailureReason::flow;
    if (counts.incomplete_points > 0) found = FailureReason::left_domain;
    if (counts.rejected_forces > 0) found = FailureReason::not_spread;
    if (broken != no_line) found = FailureReason::line;
    if (cloth.has_failed()) found = FailureReason::cloth;
    if (found == FailureReason::flow) return;
    if (found == FailureReason::line) failed_line() = broken;
    reason() = found;
    control().trial.stop = flow::Stop::failed;
  }
};

/// Time of pulls: a step of the flow that began with the saved one and has been completed.
template <class ExecutionSpace>
struct CompletedFlowStep {
  flow::ControlView<ExecutionSpace> control;
  SavedStep<ExecutionSpace> saved_step;

  KOKKOS_FUNCTION bool operator()(double& time) const {
    time = control().now.time;
    return control().now.step > saved_step();
  }
};

/// Cloth in incompressible flow on the caller's instance of an execution space. Each step of the flow holds
/// several steps of the cloth by the symplectic Euler method and one exchange of impulses (`ImmersedSheet`),
/// so that the forces on the air and on the cloth are equal and opposite to round-off. `Solver` is the facade
/// over it for programs that choose the backend at run time.
///
/// Steps of a block have the same dt, which the host chooses from the present speed of the air and frequency
/// of the cloth: within a block, no step waits for the host, copies to it or allocates. A block ends early
/// where the air has become too fast for its dt.
///
/// Sheets may cross periodic sides, but contact does not act between them and their images: a caller whose
/// sheets may meet images compares them, with the state after a call of `advance`.
///
/// On a group of several ranks each holds a box of the cells and the whole cloth, with the same bits.
/// Functions are then collective, except those that only return values of the cloth, and every step waits for
/// the host.
template <class ExecutionSpace>
class CoupledSolver {
 public:
  using Flow = flow::FlowSolver<ExecutionSpace>;
  using Fabric = fabric::FabricSolver<ExecutionSpace, AirRelaxation<ExecutionSpace>>;
  using Vectors = typename LocalAir<ExecutionSpace>::Vectors;

  static constexpr std::int64_t block_steps = 16;
  /// Largest ratio of the steps of successive blocks.
  static constexpr double largest_growth = 2.0;

  /// Fluid at rest and cloth at rest in its mesh; set other states by `flow` and `fabric`, then call `start`.
  /// `instance` must outlive the solver. Each rank gives the same parameters. Blocks. Throws
  /// std::invalid_argument for parameters out of range, and as the constructor of FlowSolver does.
  CoupledSolver(const device::Instance<ExecutionSpace>& instance, const Parameters& parameters,
                const linear::RankGroup& group = {})
      : _space(instance.space()),
        _parameters(with_coupling_settings(parameters)),
        _group(group),
        _flow(instance, _parameters.flow, group),
        _sheet(_space, flow::coupling_grid(_flow.grid()), _parameters.fabric, _parameters.sheet,
               _parameters.flow.density, group, flow::face_window(_flow.grid())),
        _fabric(instance, _parameters.fabric, _sheet.relaxation()),
        _reason("drogue::coupling::failure_reason"),
        _saved_step("drogue::coupling::saved_step"),
        _state(_sheet.state()),
        _total_force(flow::coupling_grid(_flow.grid())),
        _frame(_parameters.follow, _parameters.fabric),
        _cuts(_parameters.cuts, _parameters.fabric),
        _strength(_space, _parameters) {
    _state.add("sheet_position", "m", _fabric.state().positions);
    _state.add("sheet_velocity", "m/s", _fabric.state().velocities);
    _strength.set_stiffness(_space, _cuts.stiffness());
    if (_frame.follows()) _flow.check_frame(_parameters.follow.axes);
  }

  /// The parts. Does not throw.
  [[nodiscard]] Flow& flow() { return _flow; }
  [[nodiscard]] const Flow& flow() const { return _flow; }
  [[nodiscard]] Fabric& fabric() { return _fabric; }
  [[nodiscard]] const Fabric& fabric() const { return _fabric; }
  [[nodiscard]] const ImmersedSheet<ExecutionSpace>& sheet() const { return _sheet; }

  /// As the functions of `Solver`.
  void start();
  void restore(const flow::Progress& progress);
  flow::Stop advance(double target, std::int64_t pause_step, const flow::Poll& poll);
  [[nodiscard]] BlockProgress block() const { return _block; }
  void set_block(const BlockProgress& block) {
    _block = block;
    set_cloth_time();
  }
  [[nodiscard]] FrameMotion frame() const { return _frame.motion(); }
  void set_frame(const FrameMotion& frame);
  [[nodiscard]] FailureReason failure_reason();
  [[nodiscard]] int failed_line();
  [[nodiscard]] const std::optional<fabric::StepFailure>& cloth_failure() const { return _cloth_failure; }
  [[nodiscard]] std::vector<stepping::StateArray> state() const { return _state.arrays(); }
  void upload(std::string_view name, std::span<const double> values) {
    _state.upload(_space, name, values);
    renew_cloth();
    _sheet.update_acceleration(_space);
  }
  void download(std::string_view name, std::span<double> values) const {
    _state.download(_space, name, values);
  }
  void watch_pulls(std::span<const fabric::Pull> pulls) {
    _pulls = fabric::PeakPulls<ExecutionSpace>(_space, _parameters.fabric.mesh, _cuts.stiffness(), pulls);
  }
  [[nodiscard]] std::vector<fabric::PeakPull> peak_pulls() const { return _pulls.peaks(_space); }
  void set_peak_pulls(std::span<const fabric::PeakPull> peaks) const { _pulls.set_peaks(_space, peaks); }
  [[nodiscard]] std::array<double, 3> total_force_on_air() const {
    std::array<double, 3> force =
        _total_force(_space, flow::face_views<ExecutionSpace>(_flow.grid(), _flow.force()));
    _group.sum(force);
    return force;
  }
  /// Velocity of the air at the present positions of all vertices, (vertices, 3), m/s, valid until the next
  /// step. On one rank asynchronous. Throws as `ImmersedSheet::air_velocity`.
  [[nodiscard]] const Vectors& air_velocity() const {
    return _sheet.air_velocity(_space, _fabric.state(),
                               flow::face_views<ExecutionSpace>(_flow.grid(), _flow.velocity()));
  }

 private:
  static Parameters with_coupling_settings(Parameters p) {
    if (!(p.flow.fixed_dt > 0.0 || p.flow.max_dt > 0.0))
      throw std::invalid_argument("coupled solver: either fixed_dt or max_dt must be positive");
    p.fabric.integrator = fabric::Integrator::symplectic_euler;
    // Every block sets its own; before the first one, a motion is evaluated within the run.
    p.fabric.dt = p.flow.fixed_dt > 0.0 ? p.flow.fixed_dt : 1e-6 * std::max(p.flow.horizon, p.flow.max_dt);
    p.fabric.contact.interval = p.contact_interval;
    fabric::check_parameters(p.fabric);
    if (p.substeps < 0)
      throw std::invalid_argument("coupled solver: the number of substeps must not be negative");
    if (!(p.longest_batch > 0.0))
      throw std::invalid_argument("coupled solver: the time of a batch of steps must be positive");
    if (p.flow.cfl == 0.0) p.flow.cfl = default_cfl;
    p.flow.external_force = true;
    if (p.flow.horizon > 0.0 && p.flow.motion.empty()) p.flow.motion = vertex_motion(p);
    return p;
  }
  [[nodiscard]] std::size_t rows() const { return static_cast<std::size_t>(_fabric.vertices()); }
  void forget_steps();
  /// Gives the lines their stiffness after the cuts so far. Blocks.
  void set_lines() {
    const std::vector<double> stiffness = _cuts.stiffness();
    _fabric.set_line_stiffness(stiffness);
    _strength.set_stiffness(_space, stiffness);
    _pulls.set_stiffness(_space, stiffness);
  }
  /// Enqueues the comparison of the forces at the end of a completed step with their peaks.
  void record_pulls() const {
    _pulls.record(_space, _fabric.state().positions,
                  CompletedFlowStep<ExecutionSpace>{_flow.control(), _saved_step});
  }
  /// Time of the next jump of prescribed motion, s, at which a block ends unless dt is fixed. Does not throw.
  [[nodiscard]] double next_jump(const flow::Progress& now) const {
    return _parameters.flow.fixed_dt > 0.0 ? std::numeric_limits<double>::infinity()
                                           : _flow.next_jump(now.time);
  }
  [[nodiscard]] double longest_block_dt(const flow::Progress& now) const;
  [[nodiscard]] bool plan_block(const flow::Progress& now, double target);
  void set_cloth_time();
  /// Counts the time of the cloth from now on, s, which a change of dt makes necessary. Does not throw.
  void count_cloth_time_from(double now) { _block.since = _block.cloth_step, _block.start = now; }
  void move_frame(const flow::Progress& now);
  void end_block_at(double target, const flow::Progress& now);
  void enqueue_step(double dt, bool is_first);
  void adapt_batch(std::int64_t steps, const device::Stopwatch& stopwatch);
  [[nodiscard]] bool cloth_has_failed();
  [[nodiscard]] bool needs_shorter_steps(const flow::Progress& now);
  void return_to_last_step(const flow::Progress& now);
  void renew_cloth();

  ExecutionSpace _space;
  Parameters _parameters;
  linear::RankGroup _group;
  Flow _flow;
  ImmersedSheet<ExecutionSpace> _sheet;
  Fabric _fabric;
  BlockProgress _block;
  typename CheckClothFunctor<ExecutionSpace>::ReasonView _reason;
  SavedStep<ExecutionSpace> _saved_step;
  StateList<ExecutionSpace> _state;
  TotalForce<ExecutionSpace> _total_force;
  MovingFrame<ExecutionSpace> _frame;
  LineCuts _cuts;
  LineStrength<ExecutionSpace> _strength;
  fabric::PeakPulls<ExecutionSpace> _pulls;
  /// Steps of the flow and of the cloth at which the steps enqueued last began.
  std::int64_t _enqueued_step = 0, _enqueued_cloth_step = 0;
  std::int64_t _batch = 1;  ///< largest number of steps of the flow until the next poll
  std::optional<fabric::StepFailure> _cloth_failure;  ///< of the last step that failed by its cloth
};

template <class ExecutionSpace>
void CoupledSolver<ExecutionSpace>::start() {
  if (_frame.follows()) set_frame({});
  _flow.start();
  forget_steps();
  if (_cuts.restart_at(0.0)) set_lines();
  _pulls.set_peaks(_space, std::vector<fabric::PeakPull>(_pulls.size()));
  record_pulls();
}

template <class ExecutionSpace>
void CoupledSolver<ExecutionSpace>::forget_steps() {
  _block = {};
  _sheet.forget_steps(_space);
  Kokkos::deep_copy(_space, _sheet.transfer().counts, TransferCounts{});
  Kokkos::deep_copy(_space, _reason, FailureReason::flow);
  _cloth_failure.reset();
  _strength.reset(_space);
  Kokkos::deep_copy(_space, _saved_step, std::int64_t{-1});
  _space.fence("drogue::coupling::forget_steps");
}

template <class ExecutionSpace>
void CoupledSolver<ExecutionSpace>::set_frame(const FrameMotion& frame) {
  _frame.set(frame);
  if (_frame.follows()) _flow.set_frame(frame.velocity);
}

/// Changes, at the beginning of a block, to the frame that keeps the vertex that it follows in its place.
/// Between these changes the frame is inertial: no force is added, and the steps of a block have the speed of
/// the air that the block was planned for. All velocities change by the same amount, so that neither
/// divergence nor relative velocities nor forces do.
template <class ExecutionSpace>
void CoupledSolver<ExecutionSpace>::move_frame(const flow::Progress& now) {
  const double duration = longest_block_dt(now) * static_cast<double>(block_steps);
  _flow.change_frame(_frame.begin_block(_space, _fabric.state(), now.time, duration).velocity);
}

template <class ExecutionSpace>
void CoupledSolver<ExecutionSpace>::restore(const flow::Progress& progress) {
  _flow.restore(progress);
  forget_steps();
  if (_cuts.restart_at(progress.time)) set_lines();
  // Bodies in prescribed motion are where they are at this time.
  count_cloth_time_from(progress.time);
  set_cloth_time();
}

/// Largest dt of the block that begins with the present step, s: a fixed one, or that of the flow, which
/// grows by degrees. The last block may have had half of it, to end at a target, and less in a single step.
template <class ExecutionSpace>
double CoupledSolver<ExecutionSpace>::longest_block_dt(const flow::Progress& now) const {
  if (_parameters.flow.fixed_dt > 0.0) return _parameters.flow.fixed_dt;
  const double longest = _flow.largest_dt(now, block_steps);
  const bool has_predecessor = _block.dt > 0.0 && _block.cloth_step - _block.since > _block.substeps;
  return has_predecessor ? std::min(longest, largest_growth * _block.dt) : longest;
}

/// Chooses dt and the number of substeps of the block that begins with the present step. Unless dt is fixed,
/// a whole number of steps reaches a target within two blocks: a step of the flow changes the velocity at the
/// sheet by itself, and the impulse that follows would be a large mean force in a far shorter last step.
/// Returns false, without a block, if the cloth is too stiff.
template <class ExecutionSpace>
bool CoupledSolver<ExecutionSpace>::plan_block(const flow::Progress& now, double target) {
  const flow::Parameters& p = _parameters.flow;
  double dt = longest_block_dt(now);
  const double left = target - now.time, needed = std::ceil((1.0 - 1e-9) * left / dt);
  if (!(p.fixed_dt > 0.0) && needed <= 2.0 * block_steps) dt = left / std::max(1.0, needed);
  std::int64_t substeps = _parameters.substeps;
  if (substeps == 0) {
    const double limit = 0.5 * fabric::stable_dt(fabric::Integrator::symplectic_euler,
                                                 _fabric.fastest_frequency(), _fabric.fastest_decay()),
                 steps = std::max(1.0, std::ceil(dt / limit));
    if (!(steps <= static_cast<double>(most_substeps))) {
      Kokkos::deep_copy(_space, _reason, FailureReason::too_stiff);
      _space.fence("drogue::coupling::plan_block");
      return false;
    }
    substeps = static_cast<std::int64_t>(steps);
  }
  _block.dt = dt;
  _block.substeps = substeps;
  _block.end = now.step + block_steps;
  count_cloth_time_from(now.time);
  return true;
}

/// Gives the cloth the step, the time and dt of the present block.
template <class ExecutionSpace>
void CoupledSolver<ExecutionSpace>::set_cloth_time() {
  const double dt =
      _block.dt > 0.0 ? _block.dt / static_cast<double>(_block.substeps) : _parameters.fabric.dt;
  _fabric.set_time_state({_block.cloth_step, dt, _block.since, _block.start});
}

/// Divides what is left to a target within the block into equal steps, whatever pauses lie between.
template <class ExecutionSpace>
void CoupledSolver<ExecutionSpace>::end_block_at(double target, const flow::Progress& now) {
  const auto steps = static_cast<double>(_block.end - now.step);
  const double left = target - now.time, needed = std::ceil((1.0 - 1e-9) * left / _block.dt);
  if (needed > steps || std::abs(left - steps * _block.dt) <= 1e-9 * left) return;
  _block.end = now.step + std::max<std::int64_t>(1, static_cast<std::int64_t>(needed));
  _block.dt = left / static_cast<double>(_block.end - now.step);
  count_cloth_time_from(now.time);
}

template <class ExecutionSpace>
flow::Stop CoupledSolver<ExecutionSpace>::advance(double last_target, std::int64_t pause_step,
                                                  const flow::Poll& poll) {
  while (true) {
    const typename Flow::Condition condition = _flow.condition();
    const flow::Progress& now = condition.now;
    if (condition.last_step_violates_cfl) {
      return_to_last_step(now);
      return flow::Stop::failed;
    }
    if (now.time >= last_target) {
      _block.end = now.step;
      return flow::Stop::target;
    }
    if (now.step >= _parameters.flow.max_steps) return flow::Stop::max_steps;
    if (now.step == pause_step) return flow::Stop::pause;
    if (_cuts.cut_until(now.time)) {
      set_lines();
      _block.end = now.step;
    }
    const double end = std::min(last_target, _cuts.next()), jump = next_jump(now);
    const double target = jump < end * (1.0 - stepping::jump_width) ? jump : end;
    if (condition.has_failed) {
      return_to_last_step(now);
      // Returns its sides to the time before the failed step.
      if (!needs_shorter_steps(now)) return _flow.advance(target, pause_step, {});
      _flow.forget_long_step();
      _cloth_failure.reset();
      if (!plan_block(now, target)) return flow::Stop::failed;
    }
    if (!_group.all(!poll || poll(_flow.status()))) return flow::Stop::interrupted;
    if (now.step >= _block.end) {
      if (_frame.follows()) move_frame(now);
      if (!plan_block(_frame.follows() ? _flow.progress() : now, target)) return flow::Stop::failed;
    }
    end_block_at(target, now);
    std::int64_t steps = std::min({_block.end - now.step, _parameters.flow.max_steps - now.step, _batch});
    if (pause_step > now.step) steps = std::min(steps, pause_step - now.step);
    const double dt = _block.dt;
    const device::Stopwatch stopwatch;
    _flow.set_fixed_dt(dt);
    set_cloth_time();
    if (cloth_has_failed()) return flow::Stop::failed;
    _enqueued_step = now.step, _enqueued_cloth_step = _block.cloth_step;
    _flow.enqueue_begin(target);
    for (std::int64_t k = 0; k < steps; ++k) enqueue_step(dt, now.step + k == 0);
    _block.cloth_step = _fabric.time_state().step;
    _flow.enqueue_end();
    adapt_batch(steps, stopwatch);
  }
}

/// Waits for a number of steps and chooses how many to take before the next poll, the same on all ranks. It
/// changes no result, as pauses do not.
template <class ExecutionSpace>
void CoupledSolver<ExecutionSpace>::adapt_batch(std::int64_t steps, const device::Stopwatch& stopwatch) {
  _space.fence("drogue::coupling::adapt_batch");
  std::array<double, 1> seconds = {stopwatch.seconds()};
  _group.sum(seconds);
  const double mean = seconds[0] / _group.size();
  const double longest = _parameters.longest_batch;
  if (mean > longest) _batch = std::max<std::int64_t>(1, _batch / 2);
  if (mean < 0.25 * longest && steps == _batch) _batch = std::min(2 * _batch, block_steps);
}

template <class ExecutionSpace>
void CoupledSolver<ExecutionSpace>::enqueue_step(double dt, bool is_first) {
  const auto velocity = flow::face_views<ExecutionSpace>(_flow.grid(), _flow.velocity()),
             force_density = flow::face_views<ExecutionSpace>(_flow.grid(), _flow.force());
  // Not before: the pressure of an output contains the forces of the last step.
  clear_spread(_space, _sheet.transfer(), force_density);
  device::launch_each(_space, "drogue::coupling::save_state", _fabric.vertices(),
                      SaveStateFunctor<ExecutionSpace>{_flow.control(), _saved_step, _state.save()});
  _sheet.begin_step(_space, _fabric.state(), velocity, dt);
  static_cast<void>(_fabric.enqueue_steps(_block.substeps));
  _sheet.spread_forces(_space, _fabric.state(), force_density, dt);
  _strength.check(_space, _fabric.state().positions);
  device::launch_each(_space, "drogue::coupling::check_cloth", 1,
                      CheckClothFunctor<ExecutionSpace>{.control = _flow.control(),
                                                        .saved_step = _saved_step,
                                                        .cloth = _fabric.monitor(),
                                                        .transfer = _sheet.transfer(),
                                                        .reason = _reason,
                                                        .broken_line = _strength.broken(),
                                                        .failed_line = _strength.failed()});
  _flow.enqueue_step();
  record_pulls();
  _sheet.end_step(_space, velocity, force_density, dt, is_first, _flow.control());
}

/// True if the state at the beginning of a batch of steps is not finite, say by prescribed motion: it would
/// take no step.
template <class ExecutionSpace>
bool CoupledSolver<ExecutionSpace>::cloth_has_failed() {
  const auto failure = _fabric.failure();
  if (!failure) return false;
  _cloth_failure = failure;
  Kokkos::deep_copy(_space, _reason, FailureReason::cloth);
  _space.fence("drogue::coupling::cloth_has_failed");
  return true;
}

/// True if the flow has stopped because the dt of the block exceeds the stability limit of the next step.
template <class ExecutionSpace>
bool CoupledSolver<ExecutionSpace>::needs_shorter_steps(const flow::Progress& now) {
  return _parameters.flow.fixed_dt == 0.0 && failure_reason() == FailureReason::flow &&
         _flow.failure().reason == flow::FailureReason::time_step && _flow.largest_dt(now) < _block.dt;
}

/// Returns the cloth, and the forces on the air, to the end of the last step that the flow has taken. Those
/// of a sharp sheet return smoothed; they enter the pressure of an output alone.
template <class ExecutionSpace>
void CoupledSolver<ExecutionSpace>::return_to_last_step(const flow::Progress& now) {
  // The upload forgets it.
  if (const auto failure = _fabric.failure()) _cloth_failure = failure;
  std::int64_t saved = -1;
  Kokkos::deep_copy(_space, saved, _saved_step);
  _space.fence("drogue::coupling::return_to_last_step: step");
  if (saved != now.step) return;  // no step was enqueued after it
  // Steps that were discarded do not count: how many there were depends on when the host noticed.
  _block.cloth_step = _enqueued_cloth_step + (now.step - _enqueued_step) * _block.substeps;
  Kokkos::deep_copy(_space, _sheet.transfer().counts, TransferCounts{});
  count_cloth_time_from(now.time);
  set_cloth_time();
  // Where the forces of the discarded step have been spread, before its places are lost.
  const auto force_density = flow::face_views<ExecutionSpace>(_flow.grid(), _flow.force());
  clear_spread(_space, _sheet.transfer(), force_density);
  _state.roll_back(_space);
  renew_cloth();
  _sheet.update_acceleration(_space);
  spread(_space, _sheet.transfer(), _sheet.force(), force_density);
  _space.fence("drogue::coupling::return_to_last_step");
}

/// Gives the fabric the positions and velocities that the list has changed; it forgets a failure.
template <class ExecutionSpace>
void CoupledSolver<ExecutionSpace>::renew_cloth() {
  std::vector<fabric::Vector> positions(rows()), velocities(rows());
  download("sheet_position", numbers(positions));
  download("sheet_velocity", numbers(velocities));
  _fabric.upload(positions, velocities);
}

template <class ExecutionSpace>
int CoupledSolver<ExecutionSpace>::failed_line() {
  int line = no_line;
  Kokkos::deep_copy(_space, line, _strength.failed());
  _space.fence("drogue::coupling::failed_line");
  return line;
}

template <class ExecutionSpace>
FailureReason CoupledSolver<ExecutionSpace>::failure_reason() {
  FailureReason reason = FailureReason::flow;
  Kokkos::deep_copy(_space, reason, _reason);
  _space.fence("drogue::coupling::failure_reason");
  return reason;
}

}  // namespace drogue::coupling
