#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "kernels/fabric/contact/contact.hpp"
#include "kernels/fabric/fabric_forces.hpp"
#include "kernels/fabric/peak_pulls.hpp"
#include "kernels/fabric/solver.hpp"
#include "kernels/fabric/state.hpp"
#include "kernels/fabric/stepping/persistent_driver.hpp"
#include "kernels/fabric/stepping/rk4.hpp"
#include "kernels/fabric/stepping/symplectic_euler.hpp"
#include "kernels/fabric/stepping/verlet.hpp"
#include "kernels/stepping/state_list.hpp"
#include "kernels/stepping/step_launcher.hpp"
#include "kernels/stepping/step_loop.hpp"

namespace drogue::fabric {

/// Fabric of any constitutive model on the caller's instance of an execution space. Other kernels of the same
/// instance run in order with it, read and write its state on the device and add forces of their own.
/// Functions of `Solver` are documented there; those that block throw std::runtime_error after a failed
/// kernel.
///
/// On CUDA the instance must have a stream of its own, since steps are captured from it. Other streams need
/// events.
///
/// `VertexForce` is evaluated with the elastic forces in every stage, fused into the kernels of every driver
/// (`IsVertexForce`). `forces`, `totals`, `fastest_frequency` and `frequency_at_least` do not include it, and
/// a checkpoint does not hold its state.
template <class ExecutionSpace, class VertexForce = NoVertexForce>
class FabricSolver : public Solver {
  // Members with generic lambdas are defined in the class: nvcc cannot emit them outside of a class template
  // with a default argument.
 public:
  using Points = PointsView<ExecutionSpace>;

  /// Allocates all memory of steps, and places the vertices at rest; blocks. `instance` must outlive the
  /// solver. Throws std::invalid_argument for parameters out of range.
  FabricSolver(const device::Instance<ExecutionSpace>& instance, const Parameters& parameters,
               VertexForce vertex_force = {});
  FabricSolver(const FabricSolver&) = delete;  // captured steps refer to this object
  FabricSolver& operator=(const FabricSolver&) = delete;

  /// Instance on which all work is enqueued. Does not throw.
  [[nodiscard]] const ExecutionSpace& space() const { return _instance.space(); }
  /// Number of vertices, those of suspended payloads included. Does not throw.
  [[nodiscard]] int vertices() const { return _forces.vertices; }

  /// Views of positions, m, and velocities, m/s, at the end of the steps enqueued so far. Kernels may write
  /// them between steps; call `enqueue_checkpoint` after it if a failure shall return to the state written.
  /// Does not throw.
  [[nodiscard]] State<ExecutionSpace> state() const {
    return {without_padding(_state.x), without_padding(_state.v)};
  }

  /// It may also be called while the caller captures the instance's stream into a CUDA graph, except with
  /// contact (std::logic_error). Each launch of that graph takes `steps` steps; the caller bounds the
  /// launches in flight. From the first capture on, the solver takes no checkpoints of its own, and
  /// `time_state` is valid after `synchronize`; `upload` does not change that, and the graph remains valid. A
  /// captured graph is invalid after `set_time_state`, `set_line_stiffness` and `watch_pulls`, after which
  /// the solver takes checkpoints again.
  bool enqueue_steps(std::int64_t steps) override;

  /// Enqueues a copy of the state to the checkpoint, which has no effect after a failure. Throws
  /// std::runtime_error if the launch fails.
  void enqueue_checkpoint() { save_checkpoint(-1); }

  /// Blocks until all steps are done. After a failure it restores the last checkpoint. Throws
  /// std::runtime_error after a failed kernel.
  void synchronize();

  /// Record of failures for other kernels, which may read `has_failed`. Does not throw.
  [[nodiscard]] const StepMonitor<ExecutionSpace>& monitor() const { return _state.monitor; }

  [[nodiscard]] std::vector<stepping::StateArray> state_arrays() const override {
    return state_list().arrays();
  }
  [[nodiscard]] std::vector<double> download_state() override {
    synchronize();
    enqueue_checkpoint();
    std::vector<double> values(_saved.size());
    device::copy_out(space(), values.data(), _saved, values.size());
    space().fence("drogue::fabric::download_state");
    return values;
  }
  void upload_state(std::span<const double> values) override {
    const auto is_finite = [](double value) { return std::abs(value) < divergence_limit; };
    if (values.size() != _saved.size() || !std::ranges::all_of(values, is_finite))
      throw std::invalid_argument("fabric solver: all arrays of the state must be given, and be finite");
    if (_loop.has_captured_steps()) synchronize();
    if (_contact) _contact->reset();
    device::copy_in(space(), _saved, values.data(), values.size());
    restore_checkpoint();
    _failure.reset();
    reset_monitor();
    enqueue_start();
  }
  void upload(std::span<const Vector> positions, std::span<const Vector> velocities) override {
    const auto is_finite = [](const Vector& vector) {
      return std::abs(vector[0]) + std::abs(vector[1]) + std::abs(vector[2]) < divergence_limit;
    };
    if (!std::ranges::all_of(positions, is_finite) || !std::ranges::all_of(velocities, is_finite))
      throw std::invalid_argument("fabric solver: positions and velocities must be finite");
    require_vertices(positions.size());
    require_vertices(velocities.size());
    if (_loop.has_captured_steps()) synchronize();
    copy_to_points(space(), positions, _state.x);
    copy_to_points(space(), velocities, _state.v);
    if (_contact) _contact->reset();
    _failure.reset();
    reset_monitor();
    enqueue_start();
  }
  void download(std::span<Vector> positions, std::span<Vector> velocities) override {
    require_vertices(positions.size());
    require_vertices(velocities.size());
    synchronize();
    _reader.read(space(), _state.x, positions);
    _reader.read(space(), _state.v, velocities);
  }
  [[nodiscard]] std::optional<StepFailure> failure() override {
    synchronize();
    return _failure;
  }
  [[nodiscard]] TimeState time_state() const override { return _state.time; }
  void set_time_state(const TimeState& time) override {
    if (!(time.dt > 0.0 && std::isfinite(time.dt) && std::isfinite(time.start)))
      throw std::invalid_argument("fabric solver: dt must be positive, and time finite");
    if (time.since < 0 || time.step < time.since)
      throw std::invalid_argument("fabric solver: the step must not precede the first step with its dt");
    synchronize();
    _state.time = time;
    if (_loop.has_captured_steps()) forget_captures();
    reset_monitor();
    enqueue_start();
    if (has_contact_in_steps()) _contact->set_dt(time.dt);
    _launcher.discard_graphs();
  }
  void set_line_stiffness(std::span<const double> of_lines) override {
    Parameters changed = _parameters;
    changed.mesh.line_stiffness.assign(of_lines.begin(), of_lines.end());
    check_parameters(changed);
    synchronize();
    if (_loop.has_captured_steps()) forget_captures();
    _parameters = changed;
    _forces.update_line_stiffness();
    if (_contact) _contact->set_line_stiffness(of_lines);
    _pulls.set_stiffness(space(), of_lines);
    if (_persistent) make_persistent();
  }
  void forces(std::span<Vector> of_vertices) override {
    require_vertices(of_vertices.size());
    synchronize();
    _forces.forces(_state, _state.x, _reader, of_vertices);
  }
  [[nodiscard]] double fastest_frequency() override {
    synchronize();
    return _forces.fastest_frequency(_state);
  }
  [[nodiscard]] double frequency_at_least() override {
    synchronize();
    return _forces.frequency_at_least(_state);
  }
  [[nodiscard]] double fastest_decay() const override { return _forces.decay; }
  void stress(StressMeasure measure, std::span<Stress> of_triangles) override {
    synchronize();
    _forces.stress(_state, measure, of_triangles);
  }
  void vertex_stress(StressMeasure measure, std::span<Stress> of_vertices) override {
    require_vertices(of_vertices.size());
    synchronize();
    _forces.vertex_stress(_state, measure, of_vertices);
  }
  [[nodiscard]] Totals totals() override {
    synchronize();
    Totals totals = _forces.totals(_state);
    if (!_contact) return totals;
    std::vector<ContactWork> work(static_cast<std::size_t>(vertices()));
    contact_work(work);
    for (const ContactWork& of_vertex : work)
      totals.contact += of_vertex.normal, totals.friction += of_vertex.friction;
    return totals;
  }
  void watch_pulls(std::span<const Pull> pulls) override {
    if (_parameters.integrator != Integrator::verlet)
      throw std::invalid_argument("fabric solver: pulls are watched in steps of the velocity Verlet method");
    // The contact of an interval moves its last state after the forces on it were compared.
    if (_contact && !has_contact_in_steps())
      throw std::invalid_argument("fabric solver: pulls are watched with contact in every step");
    if (pulls.size() > _parameters.mesh.rest.size())
      throw std::invalid_argument("fabric solver: there are more pulls than vertices");
    synchronize();
    if (_loop.has_captured_steps()) forget_captures();
    _pulls = PeakPulls<ExecutionSpace>(space(), _parameters.mesh, _parameters.mesh.line_stiffness, pulls);
    record_pulls();
    make_checkpoint();
  }
  [[nodiscard]] std::vector<PeakPull> peak_pulls() override {
    synchronize();
    return _pulls.peaks(space());
  }
  [[nodiscard]] const char* driver() const override { return stepping::driver_name(_launcher.driver()); }
  void contact_work(std::span<ContactWork> of_vertices) override {
    synchronize();
    require_vertices(of_vertices.size());
    std::ranges::fill(of_vertices, ContactWork{});
    if (!_contact) return;
    device::copy_out(space(), of_vertices.data(), _contact->work(), of_vertices.size());
    space().fence("drogue::fabric::contact_work");
  }

 private:
  [[nodiscard]] Points points(const std::string& label) const {
    return make_points<ExecutionSpace>(label, static_cast<std::size_t>(vertices()));
  }
  [[nodiscard]] Points without_padding(const Points& of) const {
    return Kokkos::subview(of, Kokkos::make_pair(0, vertices()), Kokkos::ALL);
  }
  void require_vertices(std::size_t count) const {
    if (count != static_cast<std::size_t>(vertices()))
      throw std::invalid_argument("fabric solver: there must be one vector per vertex");
  }

  // ---- state ----

  using StateList = stepping::StateList<ExecutionSpace>;
  /// The state, whose positions and velocities alternate between buffers.
  [[nodiscard]] StateList state_list() const {
    StateList list;
    list.add("position", "m", _state.x, vertices());
    list.add("velocity", "m/s", _state.v, vertices());
    if (_contact) {
      list.add("contact_work", "J", _contact->work(), &ContactWork::normal);
      list.add("friction_work", "J", _contact->work(), &ContactWork::friction);
      list.add("contact_kick_x", "m/s", _contact->work(), &ContactWork::kick_x);
      list.add("contact_kick_y", "m/s", _contact->work(), &ContactWork::kick_y);
      list.add("contact_kick_z", "m/s", _contact->work(), &ContactWork::kick_z);
    }
    list.add("peak_pull", "N", _pulls.present(), &PeakPull::force);
    list.add("peak_pull_time", "s", _pulls.present(), &PeakPull::time);
    return list;
  }
  /// Makes room for a checkpoint of all arrays and takes the first one.
  void make_checkpoint() {
    _saved = typename StateList::Packed("drogue::fabric::saved_state", state_list().size());
    enqueue_checkpoint();
  }

  // ---- drivers ----

  /// Other steps alternate between two buffers, which a captured graph would not see.
  [[nodiscard]] static Driver requested_driver(const Parameters& p) {
    return p.integrator == Integrator::rk4 ? p.driver : Driver::plain;
  }
  /// Makes the persistent driver if the problem fits it. That of the symplectic Euler method serves coupling.
  void make_persistent() {
    if constexpr (device::PersistentKernel<ExecutionSpace>::available) {
      const Integrator persistent =
          RelaxesVelocity<VertexForce> ? Integrator::symplectic_euler : Integrator::rk4;
      if (_parameters.integrator == persistent && _launcher.may_be_persistent(_parameters.driver))
        _persistent = make_persistent_driver(_instance, _forces);
    }
  }
  /// Returns to steps that the host counts; captured graphs are invalid.
  void forget_captures() {
    _loop.forget_captures();
    if constexpr (device::PersistentKernel<ExecutionSpace>::available)
      if (_persistent) _persistent->forget_messages();
  }

  // ---- steps ----

  struct UniformSteps;
  [[nodiscard]] StepInputs<ExecutionSpace, VertexForce> inputs() const {
    return {_forces, {_vertex_force, _state.time, vertices()}};
  }
  /// Enqueues steps without the contact between intervals; as `enqueue_steps`.
  bool enqueue_interval(std::int64_t steps) {
    const bool sound =
        _loop.enqueue_steps(_state.time.step, steps, stepping::checkpoint_interval, UniformSteps{*this});
    restore_addresses(space(), _state);
    return sound;
  }
  /// Enqueues steps with the contact of every step, if any.
  void enqueue(std::int64_t steps) {
    dispatch_model(_parameters.material, [&]<ConstitutiveModel model>() {
      if (!has_contact_in_steps()) return this->template integrate<model>(steps);
      for (std::int64_t k = 0; k < steps; ++k) {
        _contact->begin_step(_state.x, _state.v);
        this->template integrate<model>(1);
        _contact->end_step(_state.x, _state.v);
        record_pulls();
      }
    });
  }
  template <ConstitutiveModel model>
  void integrate(std::int64_t steps);
  /// Enqueues a step by the plain or graph driver. A capture of the caller receives the kernels themselves.
  template <ConstitutiveModel model>
  void launch_runge_kutta_step() {
    const auto enqueue_step = [this](const ExecutionSpace&) {
      _runge_kutta.template enqueue_step<model>(inputs(), _state);
    };
    if (_loop.is_capturing())
      enqueue_step(space());
    else
      _launcher.launch(0, enqueue_step);
  }

  // ---- contact, checkpoint and failure ----

  /// True if every step resolves contact.
  [[nodiscard]] bool has_contact_in_steps() const { return _contact && _parameters.contact.interval == 1; }
  /// Enqueues the comparison of the forces of the present state with their peaks.
  void record_pulls() const {
    _pulls.record(space(), _state.x, CompletedStep<ExecutionSpace>{_state.at(0.0)});
  }
  void save_checkpoint(std::int64_t launches);
  void restore_checkpoint();
  /// Sets the device's step counter to the host's and clears its failure record. Blocks.
  void reset_monitor() {
    stepping::reset_monitor(space(), _state.monitor, _state.time.step);
    _state.parity = 0;
  }
  void enqueue_start();

  const device::Instance<ExecutionSpace>& _instance;
  Parameters _parameters;
  VertexForce _vertex_force;
  FabricForces<ExecutionSpace> _forces;
  stepping::StepLoop<ExecutionSpace> _loop;
  stepping::StepLauncher<ExecutionSpace> _launcher;
  StepState<ExecutionSpace> _state;
  typename StateList::Packed _saved;  ///< the last checkpoint
  stepping::Checkpoint<ExecutionSpace> _checkpoint;
  std::optional<StepFailure> _failure;
  RungeKutta<ExecutionSpace> _runge_kutta;
  std::optional<PersistentDriver<ExecutionSpace>> _persistent;
  std::unique_ptr<ContactHandler<ExecutionSpace>> _contact;  ///< empty without contact
  PeakPulls<ExecutionSpace> _pulls;
  PointsReader<ExecutionSpace> _reader;
};

template <class ExecutionSpace, class VertexForce>
FabricSolver<ExecutionSpace, VertexForce>::FabricSolver(const device::Instance<ExecutionSpace>& instance,
                                                        const Parameters& p, VertexForce vertex_force)
    : _instance(instance),
      _parameters((check_parameters(p), p)),
      _vertex_force(vertex_force),
      _forces(space(), _parameters),
      _loop(_instance),
      _launcher(_instance, requested_driver(p)),
      _state{.x = points("drogue::fabric::positions"),
             .v = points("drogue::fabric::velocities"),
             .spare_x = points("drogue::fabric::next"),
             .spare_v = {},
             .monitor = stepping::make_monitor<ExecutionSpace>(_loop.status_view()),
             .time = {0, p.dt, 0, 0.0}} {
  if (RelaxesVelocity<VertexForce> && p.integrator != Integrator::symplectic_euler)
    throw std::invalid_argument("fabric solver: only the symplectic Euler method relaxes velocities");
  copy_to_points<ExecutionSpace>(space(), p.mesh.rest, _state.x);
  reset_monitor();
  if (p.contact.is_enabled())
    _contact = make_contact<ExecutionSpace>(
        p.mesh, p.contact, p.driver, p.dt,
        {_instance, _forces.fabric.inverse_mass, _forces.fabric.fixed_dofs, _state.monitor});
  if (p.integrator == Integrator::rk4) _runge_kutta = {_forces, _launcher.driver() == Driver::stages};
  if (p.integrator == Integrator::verlet && _forces.has_dashpots)
    _state.spare_v = points("drogue::fabric::damped_velocities");
  make_checkpoint();
  make_persistent();
  if (_persistent) _launcher.use_persistent();
}

// ---- steps ----

/// The steps as `StepLoop::enqueue_steps` calls them.
template <class ExecutionSpace, class VertexForce>
struct FabricSolver<ExecutionSpace, VertexForce>::UniformSteps {
  FabricSolver& solver;
  void enqueue(std::int64_t count) const { solver.enqueue(count); }
  void checkpoint(std::int64_t launches) const { solver.save_checkpoint(launches); }
};

template <class ExecutionSpace, class VertexForce>
bool FabricSolver<ExecutionSpace, VertexForce>::enqueue_steps(std::int64_t steps) {
  // Beyond this number, times of steps are no longer distinct.
  constexpr std::int64_t last_step = std::int64_t{1} << 53U;
  if (steps < 0 || steps > last_step - _state.time.step)
    throw std::invalid_argument("fabric solver: the number of steps must be 0 or more, to step 2^53 at most");
  if (_failure) return false;
  if (_contact && device::is_capturing(space()))
    throw std::logic_error("fabric solver: steps with contact cannot be captured");
  if (!_contact || has_contact_in_steps()) return enqueue_interval(steps);
  const std::int64_t longest = _parameters.contact.interval, intervals = (steps + longest - 1) / longest;
  for (std::int64_t k = 0; k < intervals; ++k) {
    const std::int64_t count = steps / intervals + (k < steps % intervals ? 1 : 0);
    _contact->begin_interval(_state.x, static_cast<double>(count) * _state.time.dt);
    if (!enqueue_interval(count)) return false;
    _contact->end_interval(_state.x, _state.v);
  }
  return true;
}

/// Enqueues steps of the integrator without contact. A VertexForce that relaxes velocities leaves all
/// integrators but the symplectic Euler method uncompiled, whose persistent launches take two steps at least.
template <class ExecutionSpace, class VertexForce>
template <ConstitutiveModel model>
void FabricSolver<ExecutionSpace, VertexForce>::integrate(std::int64_t steps) {
  const StepInputs<ExecutionSpace, VertexForce> in = inputs();
  if constexpr (device::PersistentKernel<ExecutionSpace>::available)
    if (_persistent && (steps >= 2 || _parameters.integrator == Integrator::rk4)) {
      restore_addresses(space(), _state);  // after a single step of another kernel
      return launch_persistent_steps<model>(*_persistent, in, _state, steps, _loop.has_captured_steps());
    }
  if (_parameters.integrator == Integrator::symplectic_euler) {
    for (std::int64_t k = 0; k < steps; ++k) enqueue_symplectic_euler_step<model>(in, _state);
  } else if constexpr (!RelaxesVelocity<VertexForce>) {
    if (_parameters.integrator == Integrator::rk4)
      for (std::int64_t k = 0; k < steps; ++k) launch_runge_kutta_step<model>();
    else
      enqueue_verlet_steps<model>(in, _state, steps, [this] {
        if (!has_contact_in_steps()) record_pulls();
      });
  }
}

// ---- checkpoint and failure ----

/// Enqueues prescribed motion at the present time, and checkpoints of the state before and after it.
template <class ExecutionSpace, class VertexForce>
void FabricSolver<ExecutionSpace, VertexForce>::enqueue_start() {
  enqueue_checkpoint();
  if (!_forces.dirichlet || _failure) return;
  _forces.apply_dirichlet(_state.x, _state.v, _state.at(0.0), true);
  enqueue_checkpoint();
}

/// Enqueues the copy of the last checkpoint to the state.
template <class ExecutionSpace, class VertexForce>
void FabricSolver<ExecutionSpace, VertexForce>::restore_checkpoint() {
  const StateList list = state_list();
  launch_each(space(), "drogue::fabric::restore_checkpoint", list.most_rows(),
              stepping::CopyStateFunctor<ExecutionSpace>{list, _saved, false});
}

/// Enqueues a checkpoint that publishes `launches`, unless that is negative.
template <class ExecutionSpace, class VertexForce>
void FabricSolver<ExecutionSpace, VertexForce>::save_checkpoint(std::int64_t launches) {
  const StateList list = state_list();
  _checkpoint.save(space(), "drogue::fabric::checkpoint", _state.monitor, _state.parity, list.most_rows(),
                   stepping::CopyStateFunctor<ExecutionSpace>{list, _saved, true}, launches);
}

template <class ExecutionSpace, class VertexForce>
void FabricSolver<ExecutionSpace, VertexForce>::synchronize() {
  const auto first =
      _checkpoint.roll_back_after_failure(space(), _state.monitor, [this] { restore_checkpoint(); });
  TimeState& time = _state.time;
  if (_loop.has_captured_steps())
    time.step = stepping::completed_steps(space(), _state.monitor, _state.parity);
  if (!first) return;
  time.step = first->step - 1;
  _failure = StepFailure{.reason = _contact ? _contact->reason(first->step) : FailureReason::not_finite,
                         .index = first->index,
                         .step = first->step,
                         .time = time.time(),
                         .dt = time.dt};
  time.step = first->checkpoint_step;
}

// One translation unit per backend compiles the solver without a VertexForce.
DROGUE_EXTERN_INSTANCES(class FabricSolver)

}  // namespace drogue::fabric
