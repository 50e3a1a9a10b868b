#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <vector>

#include "kernels/coupling/sheet/block_plan.hpp"
#include "kernels/coupling/sheet/coupled_step.hpp"
#include "kernels/coupling/sheet/inverse_masses.hpp"
#include "kernels/coupling/sheet/line_cuts.hpp"
#include "kernels/coupling/sheet/moving_frame.hpp"
#include "kernels/coupling/sheet/solver.hpp"
#include "kernels/coupling/sheet/vertex_motion.hpp"
#include "kernels/coupling/total_force.hpp"
#include "kernels/device/stopwatch.hpp"
#include "kernels/fabric/peak_pulls.hpp"
#include "kernels/fabric/points_transfer.hpp"

namespace drogue::coupling {

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
/// several steps of the cloth by the symplectic Euler method and one exchange of impulses (`CoupledStep`), so
/// that the forces on the air and on the cloth are equal and opposite to round-off. Final functions are
/// documented in `Solver`.
///
/// Steps of a block have the same dt, which the host chooses from the present speed of the air and frequency
/// of the cloth: within a block, no step waits for the host, copies to it or allocates. A block ends early
/// where the air has become too fast for its dt.
///
/// Sheets may cross periodic sides, but contact does not act between them and their images: a caller whose
/// sheets may meet images compares them, with the state after a call of `advance`.
///
/// On a group of several ranks each holds a box of the cells and the whole cloth, with the same bits.
/// Functions are then collective, except those that only return values of the cloth. Every step waits for the
/// host unless `flow::Step::is_asynchronous`.
template <class ExecutionSpace>
class CoupledSolver : public Solver {
 public:
  using Flow = typename CoupledStep<ExecutionSpace>::Flow;
  using Fabric = typename CoupledStep<ExecutionSpace>::Fabric;
  using Vectors = typename Sheet<ExecutionSpace>::Vectors;

  /// Fluid at rest and cloth at rest in its mesh; set other states by `flow` and `fabric`, then call `start`.
  /// `instance` must outlive the solver. Each rank gives the same parameters. Blocks. Throws
  /// std::invalid_argument for parameters out of range, and as the constructor of FlowSolver does.
  CoupledSolver(const device::Instance<ExecutionSpace>& instance, const Parameters& parameters,
                const linear::RankGroup& group = {})
      : _space(instance.space()),
        _parameters(with_coupling_settings(parameters)),
        _group(group),
        _flow(instance, _parameters.flow, group),
        _box(flow::force_box(_parameters.flow)),
        _sheet(make_sheet<ExecutionSpace>(
            _parameters.sheet.method, _space, flow::coupling_grid(_flow.grid(), _box),
            _parameters.fabric.mesh, inverse_masses(_parameters.fabric), _parameters.sheet,
            _parameters.flow.density, _flow.communicator(), flow::face_window(_flow.grid(), _box))),
        _drag(_space, flow::coupling_grid(_flow.grid(), _box), _parameters.fabric.mesh, _parameters.line_drag,
              _parameters.vertex_drag, _parameters.sheet, _parameters.flow.density, _flow.communicator(),
              flow::face_window(_flow.grid(), _box)),
        _fabric(instance, _parameters.fabric, _sheet->relaxation(_drag.relaxation())),
        _step(_space, _parameters, _flow, *_sheet, _drag, _fabric),
        _plan(_parameters),
        _total_force(flow::coupling_grid(_flow.grid(), _box)),
        _frame(_space, _parameters.follow, _parameters.fabric),
        _cuts(_parameters.cuts, _parameters.fabric) {
    _step.set_line_stiffness(_cuts.stiffness());
    if (_frame.follows()) _flow.check_frame(_parameters.follow.axes);
  }

  [[nodiscard]] Flow& flow() final { return _flow; }
  [[nodiscard]] Fabric& fabric() final { return _fabric; }
  void start() final;
  void restore(const Progress& progress) final;
  flow::Stop advance(double target, std::int64_t pause_step, const flow::Poll& poll) final;
  [[nodiscard]] Progress progress() final { return {_flow.progress(), _plan.block(), _frame.motion()}; }
  [[nodiscard]] StepFailure failure() final {
    const FailureReason reason = _step.reason();
    return {reason, reason == FailureReason::line ? _step.failed_line() : -1, _cloth_failure};
  }
  [[nodiscard]] std::vector<stepping::StateArray> state() const final { return state_list().arrays(); }
  void upload(std::string_view name, std::span<const double> values) final {
    state_list().upload(_space, name, values);
  }
  void download(std::string_view name, std::span<double> values) final {
    state_list().download(_space, name, values);
  }
  [[nodiscard]] std::array<double, 3> total_force_on_air() final {
    std::array<double, 3> force =
        _total_force(_space, flow::face_views<ExecutionSpace>(_flow.grid(), _box, _flow.force()));
    _group.sum(force);
    return force;
  }
  void air_velocity(std::span<fabric::Vector> at_vertices) final {
    if (at_vertices.size() != static_cast<std::size_t>(_fabric.vertices()))
      throw std::invalid_argument("coupled solver: there must be one vector per vertex");
    _reader.read(_space, air_velocity(), at_vertices);
  }
  /// The same on the device, (vertices, 3), m/s, valid until the next step. Collective, and asynchronous as
  /// steps are. Throws only after a failed kernel.
  [[nodiscard]] const Vectors& air_velocity() const { return _step.air_velocity(); }
  void watch_pulls(std::span<const fabric::Pull> pulls) final {
    _pulls = fabric::PeakPulls<ExecutionSpace>(_space, _parameters.fabric.mesh, _cuts.stiffness(), pulls);
  }
  [[nodiscard]] std::vector<fabric::PeakPull> peak_pulls() final { return _pulls.peaks(_space); }

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
  /// That of the step, and the peaks, which failed steps do not change.
  [[nodiscard]] stepping::StateList<ExecutionSpace> state_list() const {
    stepping::StateList<ExecutionSpace> list = _step.state();
    list.add("peak_pull", "N", _pulls.present(), &fabric::PeakPull::force, {.saved = false});
    list.add("peak_pull_time", "s", _pulls.present(), &fabric::PeakPull::time, {.saved = false});
    return list;
  }
  void set_frame(const FrameMotion& frame);
  /// Gives the lines their stiffness after the cuts so far. Blocks.
  void set_lines() {
    const std::vector<double> stiffness = _cuts.stiffness();
    _fabric.set_line_stiffness(stiffness);
    _step.set_line_stiffness(stiffness);
    _pulls.set_stiffness(_space, stiffness);
  }
  /// Enqueues the comparison of the forces at the end of a completed step with their peaks.
  void record_pulls() const {
    _pulls.record(_space, _fabric.state().positions,
                  CompletedFlowStep<ExecutionSpace>{_flow.control(), _step.saved_step()});
  }
  /// Time of the next jump of prescribed motion, s, at which a block ends unless dt is fixed. Does not throw.
  [[nodiscard]] double next_jump(const flow::Progress& now) const {
    return _parameters.flow.fixed_dt > 0.0 ? std::numeric_limits<double>::infinity()
                                           : _flow.next_jump(now.time);
  }
  [[nodiscard]] bool plan_block(const flow::Progress& now, double target);
  [[nodiscard]] std::optional<std::int64_t> substeps_of(double dt);
  void move_frame(const flow::Progress& now);
  void take_steps(const flow::Progress& now, double target, std::int64_t left);
  [[nodiscard]] bool cloth_has_failed();
  [[nodiscard]] bool needs_shorter_steps(const flow::Progress& now);
  void return_to_last_step(const flow::Progress& now);

  ExecutionSpace _space;
  Parameters _parameters;
  linear::RankGroup _group;
  Flow _flow;
  flow::Core _box;  ///< of the grid, that sheets lie in
  std::unique_ptr<Sheet<ExecutionSpace>> _sheet;
  AirDrag<ExecutionSpace> _drag;
  Fabric _fabric;
  CoupledStep<ExecutionSpace> _step;
  BlockPlan _plan;
  TotalForce<ExecutionSpace> _total_force;
  MovingFrame<ExecutionSpace> _frame;
  LineCuts _cuts;
  fabric::PeakPulls<ExecutionSpace> _pulls;
  fabric::PointsReader<ExecutionSpace> _reader;
  std::optional<fabric::StepFailure> _cloth_failure;  ///< of the last step that failed by its cloth
};

template <class ExecutionSpace>
void CoupledSolver<ExecutionSpace>::start() {
  if (_frame.follows()) set_frame({});
  _flow.start();
  _plan.set({});
  _cloth_failure.reset();
  _step.start();
  if (_cuts.restart_at(0.0)) set_lines();
  _pulls.reset(_space);
  record_pulls();
}

template <class ExecutionSpace>
void CoupledSolver<ExecutionSpace>::restore(const Progress& progress) {
  // First: it forgets a failure, after which the fabric would return to its checkpoint.
  _step.renew();
  _step.restore();
  _cloth_failure.reset();
  _flow.restore(progress.flow);
  set_frame(progress.frame);
  if (_cuts.restart_at(progress.flow.time)) set_lines();
  _plan.set(progress.block);
  // Bodies in prescribed motion are where they are at this time.
  _fabric.set_time_state(_plan.cloth_time());
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
  const double dt = _plan.longest_dt(_flow.largest_dt(now, BlockPlan::block_steps));
  const double duration = dt * static_cast<double>(_plan.steps_from(now.time, dt));
  _flow.change_frame(_frame.begin_block(_space, _fabric.state(), now.time, duration).velocity);
}

/// Begins a block at the present step. Returns false, without a block, if the cloth is too stiff.
template <class ExecutionSpace>
bool CoupledSolver<ExecutionSpace>::plan_block(const flow::Progress& now, double target) {
  const double dt = _plan.next_dt(now.time, target, _flow.largest_dt(now, BlockPlan::block_steps));
  const std::optional<std::int64_t> substeps = substeps_of(dt);
  if (substeps)
    _plan.begin(now, dt, *substeps);
  else
    _step.set_reason(FailureReason::too_stiff);
  return substeps.has_value();
}

/// Number of steps of the cloth in a step of the flow of dt, s, unless it needs too many.
template <class ExecutionSpace>
std::optional<std::int64_t> CoupledSolver<ExecutionSpace>::substeps_of(double dt) {
  if (_parameters.substeps > 0) return _parameters.substeps;
  const double limit = 0.5 * fabric::stable_dt(fabric::Integrator::symplectic_euler,
                                               _fabric.fastest_frequency(), _fabric.fastest_decay()),
               steps = std::max(1.0, std::ceil(dt / limit));
  if (!(steps <= static_cast<double>(most_substeps))) return {};
  return static_cast<std::int64_t>(steps);
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
      _plan.end_at(now.step);
      return flow::Stop::target;
    }
    if (now.step >= _parameters.flow.max_steps) return flow::Stop::max_steps;
    if (now.step == pause_step) return flow::Stop::pause;
    if (_cuts.cut_until(now.time)) {
      set_lines();
      _plan.end_at(now.step);
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
    if (_plan.has_ended(now.step)) {
      if (_frame.follows()) move_frame(now);
      if (!plan_block(_frame.follows() ? _flow.progress() : now, target)) return flow::Stop::failed;
    }
    _plan.divide_rest(now, target);
    _flow.set_fixed_dt(_plan.block().dt);
    _fabric.set_time_state(_plan.cloth_time());
    if (cloth_has_failed()) return flow::Stop::failed;
    const std::int64_t left = _parameters.flow.max_steps - now.step;
    take_steps(now, target, pause_step > now.step ? std::min(left, pause_step - now.step) : left);
  }
}

/// Takes a batch of steps, of which `left` are left, and waits for it.
template <class ExecutionSpace>
void CoupledSolver<ExecutionSpace>::take_steps(const flow::Progress& now, double target, std::int64_t left) {
  const device::Stopwatch stopwatch;
  const BlockProgress& block = _plan.block();
  const std::int64_t steps = _plan.begin_batch(now.step, left);
  _flow.enqueue_begin(target);
  for (std::int64_t k = 0; k < steps; ++k) {
    _step.enqueue(block.dt, block.substeps, now.step + k == 0);
    record_pulls();
  }
  const std::int64_t cloth_step = _fabric.time_state().step;
  _flow.enqueue_end();
  _space.fence("drogue::coupling::take_steps");
  std::array<double, 1> seconds = {stopwatch.seconds()};
  _group.sum(seconds);
  _plan.end_batch(steps, cloth_step, seconds[0] / _group.size());
}

/// True if the state at the beginning of a batch of steps is not finite, say by prescribed motion: it would
/// take no step.
template <class ExecutionSpace>
bool CoupledSolver<ExecutionSpace>::cloth_has_failed() {
  const auto failure = _fabric.failure();
  if (!failure) return false;
  _cloth_failure = failure;
  _step.set_reason(FailureReason::cloth);
  return true;
}

/// True if the flow has stopped because the dt of the block exceeds the stability limit of the next step.
template <class ExecutionSpace>
bool CoupledSolver<ExecutionSpace>::needs_shorter_steps(const flow::Progress& now) {
  return _parameters.flow.fixed_dt == 0.0 && _step.reason() == FailureReason::flow &&
         _flow.failure().reason == flow::FailureReason::time_step && _flow.largest_dt(now) < _plan.block().dt;
}

/// Returns the cloth, and the forces on the air, to the end of the last step that the flow has taken.
template <class ExecutionSpace>
void CoupledSolver<ExecutionSpace>::return_to_last_step(const flow::Progress& now) {
  // The roll-back forgets it.
  if (const auto failure = _fabric.failure()) _cloth_failure = failure;
  if (!_step.was_saved_at(now.step)) return;  // no step was enqueued after it
  _plan.return_to(now);
  _fabric.set_time_state(_plan.cloth_time());
  _step.roll_back();
}

}  // namespace drogue::coupling
