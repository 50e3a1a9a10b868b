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
#include "kernels/fabric/elastic/force.hpp"
#include "kernels/fabric/elastic/frequency.hpp"
#include "kernels/fabric/elastic/lanczos.hpp"
#include "kernels/fabric/elastic/stress_evaluator.hpp"
#include "kernels/fabric/loads/dirichlet.hpp"
#include "kernels/fabric/loads/make_loads.hpp"
#include "kernels/fabric/peak_pulls.hpp"
#include "kernels/fabric/solver.hpp"
#include "kernels/fabric/state.hpp"
#include "kernels/fabric/stepping/persistent_driver.hpp"
#include "kernels/fabric/stepping/state_copies.hpp"
#include "kernels/fabric/stepping/step.hpp"
#include "kernels/fabric/totals.hpp"
#include "kernels/fabric/vertex_force.hpp"
#include "kernels/mesh/edges.hpp"
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
  [[nodiscard]] int vertices() const { return _vertices; }

  /// Views of positions, m, and velocities, m/s, at the end of the steps enqueued so far. Kernels may write
  /// them between steps; call `enqueue_checkpoint` after it if a failure shall return to the state written.
  /// Does not throw.
  [[nodiscard]] State<ExecutionSpace> state() const;

  /// It may also be called while the caller captures the instance's stream into a CUDA graph, except with
  /// contact (std::logic_error). Each launch of that graph takes `steps` steps; the caller bounds the
  /// launches in flight. From the first capture on, the solver takes no checkpoints of its own, and
  /// `time_state` is valid after `synchronize`; `upload` does not change that, and the graph remains valid. A
  /// captured graph is invalid after `set_time_state` and `watch_pulls`. After `set_time_state` the solver
  /// takes checkpoints again.
  bool enqueue_steps(std::int64_t steps) override;

  /// Enqueues a copy of the state to the checkpoint, which has no effect after a failure. Throws
  /// std::runtime_error if the launch fails.
  void enqueue_checkpoint() { save_checkpoint(-1); }

  /// Blocks until all steps are done. After a failure it restores the last checkpoint. Throws
  /// std::runtime_error after a failed kernel.
  void synchronize();

  /// Record of failures for other kernels, which may read `has_failed`. Does not throw.
  [[nodiscard]] const StepMonitor<ExecutionSpace>& monitor() const { return _monitor; }

  void upload(std::span<const Vector> positions, std::span<const Vector> velocities) override;
  void download(std::span<Vector> positions, std::span<Vector> velocities) override;
  [[nodiscard]] std::optional<StepFailure> failure() override;
  [[nodiscard]] TimeState time_state() const override { return _time; }
  void set_time_state(const TimeState& time) override;
  void set_line_stiffness(std::span<const double> of_lines) override;
  void forces(std::span<Vector> forces) override;
  [[nodiscard]] double fastest_frequency() override;
  [[nodiscard]] double frequency_at_least() override;
  [[nodiscard]] double fastest_decay() const override { return _decay; }
  void stress(StressMeasure measure, std::span<Stress> of_triangles) override;
  void vertex_stress(StressMeasure measure, std::span<Stress> of_vertices) override;
  [[nodiscard]] Totals totals() override;
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
    enqueue_checkpoint();
  }
  [[nodiscard]] std::vector<PeakPull> peak_pulls() override {
    synchronize();
    return _pulls.peaks(space());
  }
  void set_peak_pulls(std::span<const PeakPull> peaks) override {
    _pulls.set_peaks(space(), peaks);
    enqueue_checkpoint();
  }
  [[nodiscard]] const char* driver() const override { return stepping::driver_name(_launcher.driver()); }
  void contact_work(std::span<ContactWork> of_vertices) override;
  void set_contact_work(std::span<const ContactWork> of_vertices) override;

 private:
  [[nodiscard]] Points points(const std::string& label) const {
    return make_points<ExecutionSpace>(label, static_cast<std::size_t>(_vertices));
  }
  [[nodiscard]] Points without_padding(const Points& of) const {
    return Kokkos::subview(of, Kokkos::make_pair(0, _vertices), Kokkos::ALL);
  }
  void require_vertices(std::size_t count) const;

  /// Calls `function.operator()<model>()` with the constitutive model of the fabric.
  template <class Function>
  decltype(auto) with_model(const Function& function) const {
    return dispatch_model(_parameters.material, function);
  }

  // ---- set-up ----
  void make_external_loads();
  void make_drivers();
  [[nodiscard]] Points rest_positions() const;
  /// Other steps alternate between two buffers, which a captured graph would not see.
  [[nodiscard]] static Driver requested_driver(const Parameters& p) {
    return p.integrator == Integrator::rk4 ? p.driver : Driver::plain;
  }
  /// True if the integrator has a persistent driver; that of the symplectic Euler method serves coupling.
  [[nodiscard]] static bool has_persistent_steps(const Parameters& p) {
    return p.integrator == Integrator::rk4 ||
           (p.integrator == Integrator::symplectic_euler && RelaxesVelocity<VertexForce>);
  }

  // ---- steps ----
  struct UniformSteps;
  [[nodiscard]] stepping::StageTime<ExecutionSpace> stage_time(double fraction) const {
    return {_monitor, _time, _parity, fraction};
  }
  [[nodiscard]] VertexForceTerm<VertexForce> vertex_force_term() const {
    return {_vertex_force, _time, _vertices};
  }
  /// True if every step resolves contact.
  [[nodiscard]] bool has_contact_in_steps() const { return _contact && _parameters.contact.interval == 1; }
  /// Enqueues steps without the contact between intervals; as `enqueue_steps`.
  bool enqueue_interval(std::int64_t steps) {
    const bool sound =
        _loop.enqueue_steps(_time.step, steps, stepping::checkpoint_interval, UniformSteps{*this});
    restore_addresses();
    return sound;
  }
  [[nodiscard]] ExternalFunctor<ExecutionSpace> external_functor(const Points& x, const Points& v,
                                                                 double fraction, bool with_dashpots) const {
    return {.external = _external,
            .dead = _dead.total,
            .x = x,
            .v = v,
            .out = _fabric.load,
            .stage_time = stage_time(fraction),
            .with_dashpots = with_dashpots};
  }
  /// Enqueues the evaluation of `_fabric.load`.
  void evaluate_loads(const Points& x, const Points& v, double fraction, bool with_dashpots) const {
    launch_each(space(), "drogue::fabric::loads", _vertices, external_functor(x, v, fraction, with_dashpots));
  }
  [[nodiscard]] bool moves_pins() const { return _dirichlet.has_value(); }
  void apply_dirichlet(const Points& x, const Points& v, double fraction, bool checks_divergence) const;
  /// True if every stage is a kernel: other kernels need its state, or the execution space is a host, whose
  /// registers do not hold two stages at once.
  [[nodiscard]] bool has_stage_kernels() const {
    return device::is_host<ExecutionSpace> || _has_load_kernel || moves_pins() ||
           _launcher.driver() == Driver::stages;
  }
  void enqueue(std::int64_t steps) {
    with_model([&]<ConstitutiveModel model>() { this->template enqueue_model_steps<model>(steps); });
  }
  /// A VertexForce that relaxes velocities leaves all integrators but the symplectic Euler method uncompiled.
  template <ConstitutiveModel model>
  void enqueue_model_steps(std::int64_t steps);
  template <ConstitutiveModel model>
  void enqueue_persistent_steps(std::int64_t steps);
  template <ConstitutiveModel model>
  void enqueue_contact_step();
  /// Enqueues a step by the plain or graph driver. A capture of the caller receives the kernels themselves.
  template <ConstitutiveModel model>
  void launch_runge_kutta_step() {
    const auto enqueue_step = [this](const ExecutionSpace&) { enqueue_runge_kutta_step<model>(); };
    if (_loop.is_capturing())
      enqueue_step(space());
    else
      _launcher.launch(0, enqueue_step);
  }
  template <ConstitutiveModel model>
  void enqueue_runge_kutta_step() const;
  template <ConstitutiveModel model>
  void enqueue_runge_kutta_stages() const;
  template <ConstitutiveModel model, bool last>
  void enqueue_runge_kutta_half(const char* label) const;
  template <ConstitutiveModel model>
  void enqueue_verlet(bool ends, bool begins);
  template <ConstitutiveModel model>
  void enqueue_symplectic_euler();
  void exchange_positions();
  /// Enqueues the comparison of the forces of the present state with their peaks.
  void record_pulls() const {
    _pulls.record(space(), _x, CompletedStep<ExecutionSpace>{_monitor, _time, _parity});
  }
  void restore_addresses();
  /// Returns to steps that the host counts; captured graphs are invalid. Replays have left messages in the
  /// persistent driver that it must not take for those of its next launch.
  void forget_captures() {
    _loop.forget_captures();
    if constexpr (device::PersistentKernel<ExecutionSpace>::available) {
      if (!_persistent) return;
      _persistent->grid.clear_messages();
      _persistent->epoch = 0;
    }
  }
  void save_checkpoint(std::int64_t launches);
  void reset_monitor();

  // ---- evaluation ----
  void forces_at(const Points& x, std::span<Vector> forces) {
    if (_has_load_kernel) evaluate_loads(x, _v, 0.0, false);
    with_model([&]<ConstitutiveModel model>() {
      launch_packs(space(), "drogue::fabric::force", _padded,
                   ForceFunctor<ExecutionSpace, model>{_fabric, x, _next});
    });
    _reader.read(space(), _next, forces);
  }

  const device::Instance<ExecutionSpace>& _instance;
  Parameters _parameters;
  VertexForce _vertex_force;
  int _vertices, _padded;  ///< `_padded`: in whole slices
  double _decay;           ///< 1/s, upper bound of the rates of damping
  TimeState _time;
  FabricViews<ExecutionSpace> _fabric;
  DeadLoads<ExecutionSpace> _dead;
  External<ExecutionSpace> _external;
  bool _has_load_kernel = false;
  bool _has_dashpots = false;
  ListView<ExecutionSpace, double> _load_stiffness;  ///< N/m, of pressure and bending; empty without
  std::optional<DirichletConditions<ExecutionSpace>> _dirichlet;
  stepping::StepLoop<ExecutionSpace> _loop;
  stepping::StepLauncher<ExecutionSpace> _launcher;
  StepMonitor<ExecutionSpace> _monitor;
  stepping::Checkpoint<ExecutionSpace> _checkpoint;
  int _parity = 0;  ///< entry of `_monitor.steps` that counts the completed steps
  std::optional<StepFailure> _failure;
  TotalsEvaluator<ExecutionSpace> _totals;
  StressEvaluator<ExecutionSpace> _stress;
  PointsReader<ExecutionSpace> _reader;
  Points _x, _v, _next;
  Points _saved_x, _saved_v;
  Points _other, _stage_velocity[3];  ///< Runge-Kutta stages; the last one only with a kernel per stage
  Points _damped_v;                   ///< Verlet velocities with dashpots
  std::optional<PersistentDriver<ExecutionSpace>> _persistent;
  std::unique_ptr<ContactHandler<ExecutionSpace>> _contact;  ///< empty without contact
  PeakPulls<ExecutionSpace> _pulls;
};

// ---- set-up ----

template <class ExecutionSpace, class VertexForce>
FabricSolver<ExecutionSpace, VertexForce>::FabricSolver(const device::Instance<ExecutionSpace>& instance,
                                                        const Parameters& p, VertexForce vertex_force)
    : _instance(instance),
      _parameters((check_parameters(p), p)),
      _vertex_force(vertex_force),
      _vertices(static_cast<int>(p.mesh.rest.size())),
      _padded(padded_vertices(_vertices)),
      _decay(p.integrator == Integrator::rk4 ? p.damping : 0.0),
      _time{0, p.dt, 0, 0.0},
      _fabric(make_fabric_views(space(), p)),
      _dead(make_dead_loads(space(), p)),
      _loop(_instance),
      _launcher(_instance, requested_driver(p)),
      _monitor(stepping::make_monitor<ExecutionSpace>(_loop.status_view())),
      _totals(_vertices) {
  if (RelaxesVelocity<VertexForce> && p.integrator != Integrator::symplectic_euler)
    throw std::invalid_argument("fabric solver: only the symplectic Euler method relaxes velocities");
  _fabric.load = _dead.total;
  make_external_loads();
  if (!p.motions.empty()) _dirichlet = make_dirichlet(space(), p.motions, rest_positions());
  _x = points("drogue::fabric::positions");
  _v = points("drogue::fabric::velocities");
  _next = points("drogue::fabric::next");
  _saved_x = points("drogue::fabric::saved_positions");
  _saved_v = points("drogue::fabric::saved_velocities");
  copy_to_points<ExecutionSpace>(space(), p.mesh.rest, _x);
  device::copy(space(), _saved_x, _x);
  reset_monitor();
  if (p.contact.is_enabled())
    _contact =
        make_contact<ExecutionSpace>(p, {_instance, _fabric.inverse_mass, _fabric.fixed_dofs, _monitor});
  make_drivers();
}

/// Positions at rest, m, shared with forces or loads if they have them.
template <class ExecutionSpace, class VertexForce>
PointsView<ExecutionSpace> FabricSolver<ExecutionSpace, VertexForce>::rest_positions() const {
  if (_fabric.rest.extent(0) > 0) return _fabric.rest;
  if (_external.rest.extent(0) > 0) return _external.rest;
  return make_rest_positions(space(), _parameters.mesh);
}

template <class ExecutionSpace, class VertexForce>
void FabricSolver<ExecutionSpace, VertexForce>::make_external_loads() {
  const Parameters& p = _parameters;
  const double bending = p.material.bending_stiffness;
  if (bending > 0.0) _external.bending = sliced_ell_views(space(), bending_adjacency(p.mesh, bending));
  _has_dashpots = p.relative_damping > 0.0;
  if (_has_dashpots) {
    const DashpotAdjacency dashpots = dashpot_adjacency(p.mesh, p.mass, p.relative_damping);
    _external.dashpots = sliced_ell_views(space(), dashpots);
    _decay += fastest_dashpot_decay(dashpots, p.mass);
    if (p.integrator == Integrator::verlet) _damped_v = points("drogue::fabric::damped_velocities");
  }
  _has_load_kernel = needs_load_kernel(p);
  if (_has_load_kernel) {
    _external.rest = rest_positions();
    _fabric.load = points("drogue::fabric::load");
    make_timed_loads(space(), p, _external);
  }
  if (!p.follower_pressures.empty()) {
    _external.surface = make_surface(space(), p, _fabric);
    make_pressures(space(), p, _external);
  }
  if (_external.has_pressure() || bending > 0.0)
    _load_stiffness = decltype(_load_stiffness)("drogue::fabric::load_stiffness", p.mass.size());
}

/// Chooses the driver and allocates the stages of the Runge-Kutta method.
template <class ExecutionSpace, class VertexForce>
void FabricSolver<ExecutionSpace, VertexForce>::make_drivers() {
  const Parameters& p = _parameters;
  _launcher = {_instance, requested_driver(p)};
  _persistent.reset();
  if (p.integrator == Integrator::rk4) {
    for (int stage = 0; stage < (has_stage_kernels() ? 3 : 2); ++stage)
      if (_stage_velocity[stage].extent(0) == 0)
        _stage_velocity[stage] = points("drogue::fabric::stage_velocities");
    if (_other.extent(0) == 0) _other = points("drogue::fabric::stage_positions");
  }
  if constexpr (device::PersistentKernel<ExecutionSpace>::available) {
    // The stencil of bending exceeds the halo; dashpots need the velocities of neighbours.
    if (!has_persistent_steps(p) || !_launcher.may_be_persistent(p.driver) ||
        _external.bending.first.extent(0) > 0 || _has_dashpots || moves_pins() || has_contact_in_steps())
      return;
    _persistent = make_persistent_driver(_instance, p, _has_load_kernel, _external.has_pressure());
    if (_persistent) _launcher.use_persistent();
  }
}

// ---- state ----

template <class ExecutionSpace, class VertexForce>
State<ExecutionSpace> FabricSolver<ExecutionSpace, VertexForce>::state() const {
  return {without_padding(_x), without_padding(_v)};
}

template <class ExecutionSpace, class VertexForce>
void FabricSolver<ExecutionSpace, VertexForce>::set_line_stiffness(std::span<const double> of_lines) {
  Parameters changed = _parameters;
  changed.mesh.line_stiffness.assign(of_lines.begin(), of_lines.end());
  check_parameters(changed);
  synchronize();
  _parameters = changed;
  // The slots stay, so that captured graphs remain valid.
  const SpringAdjacency springs = spring_adjacency(changed.mesh, changed.material);
  device::copy(space(), _fabric.springs.value,
               table_view(space(), "drogue::fabric::slot_values", springs.value));
  space().fence("drogue::fabric::set_line_stiffness");
  if (_contact) _contact->set_line_stiffness(of_lines);
  _pulls.set_stiffness(space(), of_lines);
  if (_persistent) make_drivers();
}

template <class ExecutionSpace, class VertexForce>
void FabricSolver<ExecutionSpace, VertexForce>::require_vertices(std::size_t count) const {
  if (count != static_cast<std::size_t>(_vertices))
    throw std::invalid_argument("fabric solver: there must be one vector per vertex");
}

template <class ExecutionSpace, class VertexForce>
void FabricSolver<ExecutionSpace, VertexForce>::upload(std::span<const Vector> positions,
                                                       std::span<const Vector> velocities) {
  const auto is_finite = [](const Vector& vector) {
    return std::abs(vector[0]) + std::abs(vector[1]) + std::abs(vector[2]) < divergence_limit;
  };
  if (!std::ranges::all_of(positions, is_finite) || !std::ranges::all_of(velocities, is_finite))
    throw std::invalid_argument("fabric solver: positions and velocities must be finite");
  require_vertices(positions.size());
  require_vertices(velocities.size());
  if (_loop.has_captured_steps()) synchronize();
  copy_to_points(space(), positions, _x);
  copy_to_points(space(), velocities, _v);
  _failure.reset();
  reset_monitor();
  if (_contact) _contact->reset();
  enqueue_checkpoint();
  if (!moves_pins()) return;
  apply_dirichlet(_x, _v, 0.0, true);
  enqueue_checkpoint();
}

template <class ExecutionSpace, class VertexForce>
void FabricSolver<ExecutionSpace, VertexForce>::download(std::span<Vector> positions,
                                                         std::span<Vector> velocities) {
  require_vertices(positions.size());
  require_vertices(velocities.size());
  synchronize();
  _reader.read(space(), _x, positions);
  _reader.read(space(), _v, velocities);
}

// ---- steps ----

/// Sets the axes that expressions move, of which there are some (`moves_pins`).
template <class ExecutionSpace, class VertexForce>
void FabricSolver<ExecutionSpace, VertexForce>::apply_dirichlet(const Points& x, const Points& v,
                                                                double fraction,
                                                                bool checks_divergence) const {
  launch_each(space(), "drogue::fabric::dirichlet", static_cast<int>(_dirichlet->vertex.extent(0)),
              DirichletFunctor<ExecutionSpace>{.prescribed = *_dirichlet,
                                               .x = x,
                                               .v = v,
                                               .stage_time = stage_time(fraction),
                                               .checks_divergence = checks_divergence});
}

template <class ExecutionSpace, class VertexForce>
template <ConstitutiveModel model, bool last>
void FabricSolver<ExecutionSpace, VertexForce>::enqueue_runge_kutta_half(const char* label) const {
  launch_packs(space(), label, _padded,
               RungeKuttaHalfFunctor<ExecutionSpace, model, last, VertexForce>{
                   .fabric = _fabric,
                   .x = _x,
                   .v = _v,
                   .third = _next,
                   .fourth = _other,
                   .velocity = {_stage_velocity[0], _stage_velocity[1]},
                   .monitor = _monitor,
                   .dt = _time.dt,
                   .vertex_force = vertex_force_term()});
}

template <class ExecutionSpace, class VertexForce>
template <ConstitutiveModel model>
void FabricSolver<ExecutionSpace, VertexForce>::enqueue_runge_kutta_step() const {
  if (has_stage_kernels()) return enqueue_runge_kutta_stages<model>();
  if constexpr (!device::is_host<ExecutionSpace>) {
    enqueue_runge_kutta_half<model, false>("drogue::fabric::rk4_begin");
    enqueue_runge_kutta_half<model, true>("drogue::fabric::rk4_end");
  }
}

template <class ExecutionSpace, class VertexForce>
template <ConstitutiveModel model>
void FabricSolver<ExecutionSpace, VertexForce>::enqueue_runge_kutta_stages() const {
  const Points at[] = {_x, _next, _other, _next}, next[] = {_next, _other, _next, _x};
  // Fractions of the step before and after each stage; the last stage has counted the step.
  const double before[] = {0.0, 0.5, 0.5, 1.0}, after[] = {0.5, 0.5, 1.0, 0.0};
  for (int stage = 0; stage < 4; ++stage) {
    if (_has_load_kernel)
      evaluate_loads(at[stage], stage == 0 ? _v : _stage_velocity[stage - 1], before[stage], _has_dashpots);
    launch_packs(space(), "drogue::fabric::rk4_stage", _padded,
                 RungeKuttaFunctor<ExecutionSpace, model, VertexForce>{
                     .fabric = _fabric,
                     .x = _x,
                     .v = _v,
                     .at = at[stage],
                     .next = next[stage],
                     .velocity = {_stage_velocity[0], _stage_velocity[1], _stage_velocity[2]},
                     .monitor = _monitor,
                     .dt = _time.dt,
                     .stage = stage,
                     .vertex_force = vertex_force_term()});
    if (moves_pins())
      apply_dirichlet(next[stage], stage == 3 ? _v : _stage_velocity[stage], after[stage], stage == 3);
  }
}

template <class ExecutionSpace, class VertexForce>
template <ConstitutiveModel model>
void FabricSolver<ExecutionSpace, VertexForce>::enqueue_verlet(bool ends, bool begins) {
  if (_has_load_kernel) evaluate_loads(_x, _v, 0.0, false);
  launch_packs(space(), "drogue::fabric::verlet", _padded,
               VerletFunctor<ExecutionSpace, model, VertexForce>{.fabric = _fabric,
                                                                 .x = _x,
                                                                 .v = _v,
                                                                 .next = _next,
                                                                 .monitor = _monitor,
                                                                 .damping = _parameters.damping,
                                                                 .dt = _time.dt,
                                                                 .parity = _parity,
                                                                 .ends = ends,
                                                                 .begins = begins,
                                                                 .drifts = !_has_dashpots,
                                                                 .vertex_force = vertex_force_term()});
  if (!begins) return;
  if (_has_dashpots) {
    launch_each(space(), "drogue::fabric::dashpot_damping", _vertices,
                DashpotDampingFunctor<ExecutionSpace>{.fabric = _fabric,
                                                      .dashpots = _external.dashpots,
                                                      .x = _x,
                                                      .v = _v,
                                                      .damped_v = _damped_v,
                                                      .next = _next,
                                                      .dt = _time.dt});
    std::swap(_v, _damped_v);
  }
  exchange_positions();
}

template <class ExecutionSpace, class VertexForce>
template <ConstitutiveModel model>
void FabricSolver<ExecutionSpace, VertexForce>::enqueue_symplectic_euler() {
  if (_has_load_kernel) evaluate_loads(_x, _v, 0.0, _has_dashpots);
  if constexpr (RelaxesVelocity<VertexForce>)
    // The relaxation is implicit: it needs the velocity of pins at the end of the step. Their positions go
    // where the kernel writes those after the drift.
    if (moves_pins()) apply_dirichlet(_next, _v, 1.0, false);
  launch_packs(
      space(), "drogue::fabric::symplectic_euler", _padded,
      SymplecticEulerFunctor<ExecutionSpace, model, VertexForce>{.fabric = _fabric,
                                                                 .x = _x,
                                                                 .v = _v,
                                                                 .next = _next,
                                                                 .monitor = _monitor,
                                                                 .damping = _parameters.damping,
                                                                 .dt = _time.dt,
                                                                 .parity = _parity,
                                                                 .vertex_force = vertex_force_term()});
  exchange_positions();
}

/// Makes the positions after a drift those of the state.
template <class ExecutionSpace, class VertexForce>
void FabricSolver<ExecutionSpace, VertexForce>::exchange_positions() {
  std::swap(_x, _next);
  _parity = 1 - _parity;
  if (moves_pins()) apply_dirichlet(_x, _v, 0.0, true);
}

/// Enqueues one launch. Checkpoints end launches, so that none has more than `checkpoint_interval` steps,
/// which take a few milliseconds.
template <class ExecutionSpace, class VertexForce>
template <ConstitutiveModel model>
void FabricSolver<ExecutionSpace, VertexForce>::enqueue_persistent_steps(std::int64_t steps) {
  if constexpr (device::PersistentKernel<ExecutionSpace>::available) {
    restore_addresses();  // after a single step of another kernel
    FabricViews<ExecutionSpace> fabric = _fabric;
    fabric.load = _dead.total;
    const PersistentInputs<ExecutionSpace, VertexForce> inputs{.fabric = fabric,
                                                               .x = _x,
                                                               .v = _v,
                                                               .monitor = _monitor,
                                                               .time = _time,
                                                               .vertex_force = vertex_force_term(),
                                                               .external = _external,
                                                               .has_loads = _has_load_kernel};
    if constexpr (RelaxesVelocity<VertexForce>)
      launch_persistent_euler<model>(space(), *_persistent, inputs, _parameters.damping, steps,
                                     _loop.has_captured_steps());
    else
      launch_persistent_steps<model>(space(), *_persistent, inputs, steps, _loop.has_captured_steps());
  }
}

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
  if (steps < 0 || steps > last_step - _time.step)
    throw std::invalid_argument("fabric solver: the number of steps must be 0 or more, to step 2^53 at most");
  if (_failure) return false;
  if (_contact && device::is_capturing(space()))
    throw std::logic_error("fabric solver: steps with contact cannot be captured");
  if (!_contact || has_contact_in_steps()) return enqueue_interval(steps);
  const std::int64_t longest = _parameters.contact.interval, intervals = (steps + longest - 1) / longest;
  for (std::int64_t k = 0; k < intervals; ++k) {
    const std::int64_t count = steps / intervals + (k < steps % intervals ? 1 : 0);
    _contact->begin_interval(_x, static_cast<double>(count) * _time.dt);
    if (!enqueue_interval(count)) return false;
    _contact->end_interval(_x, _v);
  }
  return true;
}

template <class ExecutionSpace, class VertexForce>
template <ConstitutiveModel model>
void FabricSolver<ExecutionSpace, VertexForce>::enqueue_model_steps(std::int64_t steps) {
  if (has_contact_in_steps()) {
    for (std::int64_t k = 0; k < steps; ++k) enqueue_contact_step<model>();
  } else if (_parameters.integrator == Integrator::symplectic_euler) {
    if constexpr (RelaxesVelocity<VertexForce>)
      if (_launcher.is_persistent() && steps >= 2) return enqueue_persistent_steps<model>(steps);
    for (std::int64_t k = 0; k < steps; ++k) enqueue_symplectic_euler<model>();
  } else if constexpr (!RelaxesVelocity<VertexForce>) {
    if (_parameters.integrator == Integrator::verlet) {
      enqueue_verlet<model>(false, true);
      for (std::int64_t k = 1; k < steps; ++k) {
        record_pulls();
        enqueue_verlet<model>(true, true);
      }
      record_pulls();
      enqueue_verlet<model>(true, false);
    } else if (_launcher.is_persistent()) {
      enqueue_persistent_steps<model>(steps);
    } else {
      for (std::int64_t k = 0; k < steps; ++k) launch_runge_kutta_step<model>();
    }
  }
}

template <class ExecutionSpace, class VertexForce>
template <ConstitutiveModel model>
void FabricSolver<ExecutionSpace, VertexForce>::enqueue_contact_step() {
  _contact->begin_step(_x, _v);
  if (_parameters.integrator == Integrator::symplectic_euler) {
    enqueue_symplectic_euler<model>();
  } else if constexpr (!RelaxesVelocity<VertexForce>) {
    if (_parameters.integrator == Integrator::verlet) {
      enqueue_verlet<model>(false, true);
      enqueue_verlet<model>(true, false);
    } else {
      launch_runge_kutta_step<model>();
    }
  }
  _contact->end_step(_x, _v);
  record_pulls();
}

/// Moves the state back to its stable addresses after an odd number of steps that alternate between two
/// buffers.
template <class ExecutionSpace, class VertexForce>
void FabricSolver<ExecutionSpace, VertexForce>::restore_addresses() {
  if (_parity == 0) return;
  const Points x = _x, v = _v;
  std::swap(_x, _next);
  if (_damped_v.extent(0) > 0) std::swap(_v, _damped_v);
  launch_each(space(), "drogue::fabric::restore_addresses", _padded,
              RestoreAddressesFunctor<ExecutionSpace>{
                  .monitor = _monitor, .from_x = x, .from_v = v, .x = _x, .v = _v});
  _parity = 0;
}

/// Enqueues a checkpoint that publishes `launches`, unless that is negative.
template <class ExecutionSpace, class VertexForce>
void FabricSolver<ExecutionSpace, VertexForce>::save_checkpoint(std::int64_t launches) {
  SavedState<ExecutionSpace> now{_x, _v, {}, _pulls.present()}, saved{_saved_x, _saved_v, {}, _pulls.saved()};
  if (_contact) {
    const CheckpointedWork<ExecutionSpace> work = _contact->checkpointed_work();
    now.work = work.now, saved.work = work.saved;
  }
  _checkpoint.save(space(), "drogue::fabric::checkpoint", _monitor, _parity, _padded,
                   CopyStateFunctor<ExecutionSpace>{now, saved}, launches);
}

template <class ExecutionSpace, class VertexForce>
void FabricSolver<ExecutionSpace, VertexForce>::synchronize() {
  const auto first = _checkpoint.roll_back_after_failure(space(), _monitor, [this] {
    device::copy(space(), _x, _saved_x);
    device::copy(space(), _v, _saved_v);
    if (_pulls.size() > 0) device::copy(space(), _pulls.present(), _pulls.saved());
    if (!_contact) return;
    const CheckpointedWork<ExecutionSpace> work = _contact->checkpointed_work();
    device::copy(space(), work.now, work.saved);
  });
  if (_loop.has_captured_steps()) _time.step = stepping::completed_steps(space(), _monitor, _parity);
  if (!first) return;
  _time.step = first->step - 1;
  _failure = StepFailure{.reason = _contact ? _contact->reason(first->step) : FailureReason::not_finite,
                         .index = first->index,
                         .step = first->step,
                         .time = _time.time(),
                         .dt = _time.dt};
  _time.step = first->checkpoint_step;
}

template <class ExecutionSpace, class VertexForce>
std::optional<StepFailure> FabricSolver<ExecutionSpace, VertexForce>::failure() {
  synchronize();
  return _failure;
}

/// Sets the device's step counter to the host's and clears its failure record. Blocks.
template <class ExecutionSpace, class VertexForce>
void FabricSolver<ExecutionSpace, VertexForce>::reset_monitor() {
  stepping::reset_monitor(space(), _monitor, _time.step);
  _parity = 0;
}

template <class ExecutionSpace, class VertexForce>
void FabricSolver<ExecutionSpace, VertexForce>::set_time_state(const TimeState& time) {
  if (!(time.dt > 0.0 && std::isfinite(time.dt) && std::isfinite(time.start)))
    throw std::invalid_argument("fabric solver: dt must be positive, and time finite");
  if (time.since < 0 || time.step < time.since)
    throw std::invalid_argument("fabric solver: the step must not precede the first step with its dt");
  synchronize();
  _time = time;
  if (_loop.has_captured_steps()) forget_captures();
  reset_monitor();
  enqueue_checkpoint();
  if (moves_pins() && !_failure) {
    apply_dirichlet(_x, _v, 0.0, true);
    enqueue_checkpoint();
  }
  if (has_contact_in_steps()) _contact->set_dt(_time.dt);
  _launcher.discard_graphs();
}

// ---- evaluation ----

template <class ExecutionSpace, class VertexForce>
void FabricSolver<ExecutionSpace, VertexForce>::forces(std::span<Vector> forces) {
  require_vertices(forces.size());
  synchronize();
  forces_at(_x, forces);
}

template <class ExecutionSpace, class VertexForce>
double FabricSolver<ExecutionSpace, VertexForce>::fastest_frequency() {
  synchronize();
  if (_load_stiffness.extent(0) > 0)
    launch_each(space(), "drogue::fabric::load_stiffness", _vertices,
                LoadStiffnessFunctor<ExecutionSpace>{external_functor(_x, _v, 0.0, false), _load_stiffness});
  return frequency_bound(space(), _parameters.material, _fabric, _x, _load_stiffness, _vertices);
}

template <class ExecutionSpace, class VertexForce>
double FabricSolver<ExecutionSpace, VertexForce>::frequency_at_least() {
  synchronize();
  const auto n = static_cast<std::size_t>(_vertices);
  const auto inverse_mass = Kokkos::create_mirror_view(_fabric.inverse_mass);
  const auto fixed_dofs = Kokkos::create_mirror_view(_fabric.fixed_dofs);
  device::copy(space(), inverse_mass, _fabric.inverse_mass);
  device::copy(space(), fixed_dofs, _fabric.fixed_dofs);
  space().fence("drogue::fabric::masses");
  std::vector<double> root(3 * n);
  for (std::size_t k = 0; k < root.size(); ++k)
    root[k] = (fixed_dofs(k / 3) >> k % 3 & 1U) != 0U ? 0.0 : std::sqrt(inverse_mass(k / 3));
  // Short enough for linear forces, long enough for forces above round-off.
  const double displacement = 1e-5 * shortest_edge(_parameters.mesh);
  std::vector<Vector> now(n), v(n);
  download(now, v);
  const Points trial = points("drogue::fabric::trial");
  return lanczos_frequency(root, now, displacement,
                           [&](const std::vector<Vector>& positions, std::vector<Vector>& forces) {
                             copy_to_points<ExecutionSpace>(space(), positions, trial);
                             forces_at(trial, forces);
                           });
}

template <class ExecutionSpace, class VertexForce>
void FabricSolver<ExecutionSpace, VertexForce>::stress(StressMeasure measure,
                                                       std::span<Stress> of_triangles) {
  synchronize();
  _stress.triangles(space(), _parameters, _fabric.moduli, _x, measure, of_triangles);
}

template <class ExecutionSpace, class VertexForce>
void FabricSolver<ExecutionSpace, VertexForce>::vertex_stress(StressMeasure measure,
                                                              std::span<Stress> of_vertices) {
  require_vertices(of_vertices.size());
  synchronize();
  _stress.vertices(space(), _parameters, _fabric.moduli, _x, measure, of_vertices);
}

template <class ExecutionSpace, class VertexForce>
Totals FabricSolver<ExecutionSpace, VertexForce>::totals() {
  synchronize();
  FabricViews<ExecutionSpace> with_dead_loads = _fabric;
  with_dead_loads.load = _dead.total;
  Totals totals = _totals.evaluate(space(), _parameters.material, with_dead_loads, _x, _v, _dead.rest_forces,
                                   _external.bending);
  totals.elastic += _dead.rest_energy;
  if (!_contact) return totals;
  std::vector<ContactWork> work(static_cast<std::size_t>(_vertices));
  _contact->work(work);
  for (const ContactWork& of_vertex : work)
    totals.contact += of_vertex.normal, totals.friction += of_vertex.friction;
  return totals;
}

template <class ExecutionSpace, class VertexForce>
void FabricSolver<ExecutionSpace, VertexForce>::contact_work(std::span<ContactWork> of_vertices) {
  synchronize();
  require_vertices(of_vertices.size());
  std::ranges::fill(of_vertices, ContactWork{});
  if (_contact) _contact->work(of_vertices);
}

template <class ExecutionSpace, class VertexForce>
void FabricSolver<ExecutionSpace, VertexForce>::set_contact_work(std::span<const ContactWork> of_vertices) {
  synchronize();
  require_vertices(of_vertices.size());
  if (!_contact) return;
  _contact->set_work(of_vertices);
  enqueue_checkpoint();
}

// One translation unit per backend compiles the solver without a VertexForce.
DROGUE_EXTERN_INSTANCES(class FabricSolver)

}  // namespace drogue::fabric
