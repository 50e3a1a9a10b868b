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
#include "kernels/fabric/elastic/frequency.hpp"
#include "kernels/fabric/elastic/lanczos.hpp"
#include "kernels/fabric/elastic/stress.hpp"
#include "kernels/fabric/loads/dirichlet.hpp"
#include "kernels/fabric/loads/prescribed_motion.hpp"
#include "kernels/fabric/solver.hpp"
#include "kernels/fabric/stepping/persistent_pairs.hpp"
#include "kernels/fabric/stepping/persistent_rings.hpp"
#include "kernels/fabric/stepping/state_copies.hpp"
#include "kernels/fabric/stepping/step.hpp"
#include "kernels/fabric/totals.hpp"
#include "kernels/fabric/vertex_force.hpp"
#include "kernels/mesh/edges.hpp"
#include "kernels/stepping/step_launcher.hpp"
#include "kernels/stepping/step_loop.hpp"

namespace drogue::fabric {

/// Device-resident state of a fabric. The addresses are stable for the life of the solver.
///
/// Both Views have the shape (vertices, 3) in layout left. Components are `positions.stride(1)` numbers
/// apart, which is the number of vertices padded to a multiple of `slice`; the padding belongs to the solver.
template <class ExecutionSpace>
struct State {
  PointsView<ExecutionSpace> positions;   ///< m
  PointsView<ExecutionSpace> velocities;  ///< m/s; a pinned axis moves at its velocity
};

/// Calls `function.operator()<model>()` with the compiled constitutive model of a material. Edge springs and
/// springs of vectors share one.
template <class Function>
decltype(auto) dispatch_model(const Material& material, const Function& function) {
  const auto with = [&]<bool tension_only>() -> decltype(auto) {
    switch (material.model) {
      case Model::quadratic:
        return function.template operator()<ConstitutiveModel{Model::quadratic, tension_only}>();
      case Model::biquadratic:
        return function.template operator()<ConstitutiveModel{Model::biquadratic, tension_only}>();
      default:
        return function.template operator()<ConstitutiveModel{Model::edge, tension_only}>();
    }
  };
  return material.tension_only ? with.template operator()<true>() : with.template operator()<false>();
}

/// Elastic forces and loads, N, at given positions.
template <class ExecutionSpace, ConstitutiveModel law>
struct ForceFunctor {
  using R = std::conditional_t<device::is_host<ExecutionSpace>, device::HostPack<double>, double>;
  using Bounds = Kokkos::LaunchBounds<>;
  FabricViews<ExecutionSpace> cloth;
  PointsView<ExecutionSpace> x, out;

  KOKKOS_FUNCTION void operator()(const int pack) const {
    const int i = pack * device::Access<R>::lanes;
    store_points(out, i, force<law, R>(cloth, x, i));
  }
};

/// Fabric of any constitutive model on the caller's instance of an execution space, for coupling to other
/// kernels. `Solver` is the facade over it for programs that choose the backend at run time.
///
/// All work is enqueued on the instance given to the constructor. Kernels of the same instance run in order
/// with it; other streams need events. On CUDA the instance must have a stream of its own, since steps are
/// captured from it. Member functions are asynchronous unless they say that they block.
///
/// `VertexForce` is evaluated with the elastic forces in every stage, fused into the kernels of every driver
/// (`IsVertexForce`). `forces`, `totals`, `fastest_frequency` and `frequency_at_least` do not include it, and
/// a checkpoint does not hold its state.
template <class ExecutionSpace, class VertexForce = NoVertexForce>
class FabricSolver {
  // Members with generic lambdas are defined in the class: nvcc cannot emit them outside of a class template
  // with a default argument.
 public:
  using Points = PointsView<ExecutionSpace>;
  using PressureView = ListView<ExecutionSpace, double>;

  /// Allocates all memory of steps; blocks. Throws std::invalid_argument for parameters out of range.
  FabricSolver(const ExecutionSpace& space, const Parameters& parameters, VertexForce vertex_force = {});
  FabricSolver(const FabricSolver&) = delete;  // captured steps refer to this object
  FabricSolver& operator=(const FabricSolver&) = delete;

  [[nodiscard]] const ExecutionSpace& space() const { return _instance.space(); }
  [[nodiscard]] int vertices() const { return _vertices; }

  /// Views of the state at the end of the steps enqueued so far. Kernels may write them between steps; call
  /// `enqueue_checkpoint` after it if a failure shall return to the state written.
  [[nodiscard]] State<ExecutionSpace> state() const;

  /// Dead forces on all vertices, (vertices, 3), N, which kernels may change between steps. Initially
  /// `Parameters::load`; Model::linear_vector adds the forces of its springs at rest. The first call may
  /// allocate and then blocks.
  [[nodiscard]] Points loads();

  /// Follower pressure at all vertices, (vertices), Pa, initially zero, which kernels may change between
  /// steps. It adds to `Parameters::follower_pressures`. The first call allocates and blocks.
  [[nodiscard]] PressureView pressures();

  /// Motion of the pinned axes that no expression of `Parameters::motions` moves, which kernels may change
  /// between steps. It is evaluated in every stage and at `upload`. Without it such an axis moves at its
  /// velocity in `state`, in every driver.
  ///
  /// The first call allocates, blocks, and gives up the persistent driver. It initialises the motion with the
  /// present positions, velocities and time. Throws std::logic_error if no such axis is pinned.
  [[nodiscard]] PrescribedMotion<ExecutionSpace> prescribed_motion();

  /// Replaces the functor from the next step on.
  void set_vertex_force(const VertexForce& vertex_force);

  /// Enqueues `steps` steps of `time_state().dt` and a checkpoint after every 256th step. Asynchronous but
  /// for a bound on the steps in flight of some 0.1 s, and at least 2048 steps. Returns false, and enqueues
  /// nothing more, once a failure is known on the host. The distribution of steps over calls changes no bit.
  ///
  /// It may be called while the caller captures the instance's stream into a CUDA graph, except with contact
  /// (std::logic_error). Each launch of that graph takes `steps` steps. From the first capture on, the solver
  /// takes no checkpoints of its own, and `time_state` is valid after `synchronize`. A captured graph is
  /// invalid after `set_time_state`, `set_vertex_force`, and the first calls of `loads`, `pressures` and
  /// `prescribed_motion`.
  bool enqueue_steps(std::int64_t steps);

  /// Enqueues the number of steps that ends nearest to `time`, s; none if that time has passed. Returns as
  /// `enqueue_steps`.
  bool advance_to(double time) { return enqueue_steps(_time.steps_to(time)); }

  /// Enqueues a copy of the state to the checkpoint, which has no effect after a failure.
  void enqueue_checkpoint() { save_checkpoint(-1); }

  /// Blocks until all steps are done. After a failure it restores the last checkpoint.
  void synchronize();

  /// First failure, if any. Blocks.
  [[nodiscard]] std::optional<StepFailure> failure();

  /// Sets positions, m, and velocities, m/s, and forgets a failure. Blocks. Throws std::invalid_argument for
  /// values that are not finite and spans of the wrong length.
  void upload(std::span<const Vector> positions, std::span<const Vector> velocities);

  /// Copies positions, m, and velocities, m/s, to the host. Blocks. Throws std::invalid_argument for spans of
  /// the wrong length.
  void download(std::span<Vector> positions, std::span<Vector> velocities);

  /// Step count, dt and time after the steps enqueued so far; after a failure has been reported, those of the
  /// restored state.
  [[nodiscard]] TimeState time_state() const { return _time; }

  /// Blocks. Throws std::invalid_argument unless dt is positive and the time finite.
  void set_time_state(const TimeState& time);

  /// The functions below block and are those of `Solver`.
  void forces(std::span<Vector> forces);
  [[nodiscard]] double fastest_frequency() {
    synchronize();
    const ListView<ExecutionSpace, double>& more = _load_stiffness;
    if (more.extent(0) > 0)
      launch_each("drogue::fabric::load_stiffness", _vertices,
                  LoadStiffnessFunctor<ExecutionSpace>{external_functor(_x, _v, 0.0, false), more});
    return with_model([&]<ConstitutiveModel law>() {
      double row = this->template largest_row<law>(more);
      // Elements that are slack now may be taut before the next call.
      if constexpr (law.tension_only)
        row = std::max(row, this->template largest_row<ConstitutiveModel{law.model}>(more));
      return std::sqrt(row);
    });
  }
  [[nodiscard]] double frequency_at_least();
  [[nodiscard]] double fastest_decay() const { return _decay; }
  void stress(StressMeasure measure, std::span<Stress> of_triangles);
  void vertex_stress(StressMeasure measure, std::span<Stress> of_vertices);
  [[nodiscard]] Totals totals() {
    synchronize();
    FabricViews<ExecutionSpace> dead_alone = _cloth;
    dead_alone.load = _dead;
    with_model([&]<ConstitutiveModel law>() {
      Kokkos::parallel_for("drogue::fabric::totals",
                           Kokkos::RangePolicy<ExecutionSpace>(space(), 0, _sums.front().extent(0)),
                           TotalsFunctor<ExecutionSpace, law>{dead_alone, _x, _v, _pull, _external.bending,
                                                              _sums.front(), _vertices});
    });
    for (std::size_t level = 1; level < _sums.size(); ++level)
      Kokkos::parallel_for("drogue::fabric::sum",
                           Kokkos::RangePolicy<ExecutionSpace>(space(), 0, _sums[level].extent(0)),
                           SumFunctor<ExecutionSpace>{_sums[level - 1], _sums[level]});
    const auto& mirror = _sum;
    device::copy(space(), mirror, _sums.back());
    space().fence("drogue::fabric::totals");
    Totals t{mirror(0, 0), mirror(0, 1) + _rest_energy, mirror(0, 2), mirror(0, 3), {}, {}, 0.0, 0.0};
    for (std::size_t axis = 0; axis < 3; ++axis)
      t.momentum[axis] = mirror(0, 4 + axis), t.angular_momentum[axis] = mirror(0, 7 + axis);
    if (!_contact) return t;
    std::vector<ContactWork> work(static_cast<std::size_t>(_vertices));
    _contact->work(work);
    for (const ContactWork& of_vertex : work) t.contact += of_vertex.normal, t.friction += of_vertex.friction;
    return t;
  }
  [[nodiscard]] const char* driver() const { return stepping::driver_name(_launcher.driver()); }
  void contact_work(std::span<ContactWork> of_vertices);
  void set_contact_work(std::span<const ContactWork> of_vertices);

 private:
  static constexpr int lanes = device::Access<
      std::conditional_t<device::is_host<ExecutionSpace>, device::HostPack<double>, double>>::lanes;

  static_assert(slice % lanes == 0, "lanes must not straddle slices");

  [[nodiscard]] Points points(const std::string& label) const {
    return Points(label, static_cast<std::size_t>(_padded));
  }
  [[nodiscard]] Points without_padding(const Points& of) const {
    return Kokkos::subview(of, Kokkos::make_pair(0, _vertices), Kokkos::ALL);
  }

  /// Launches a functor for each pack of vertices, with its own launch bounds.
  template <class Functor>
  void launch(const char* label, const Functor& functor) const {
    launch_each<typename Functor::Bounds>(label, _padded / lanes, functor);
  }
  template <class Bounds = Kokkos::LaunchBounds<>, class Functor>
  void launch_each(const char* label, int count, const Functor& functor) const {
    static_assert(Kokkos::SpaceAccessibility<ExecutionSpace,
                                             typename PointsView<ExecutionSpace>::memory_space>::accessible);
    const Kokkos::RangePolicy<ExecutionSpace, Bounds> each(space(), 0, count);
    // Light-weight functors are kernel arguments. Others are copied to a buffer that orders launches.
    Kokkos::parallel_for(
        label, Kokkos::Experimental::require(each, Kokkos::Experimental::WorkItemProperty::HintLightWeight),
        functor);
  }

  /// Calls `function.operator()<law>()` with the constitutive model of the fabric.
  template <class Function>
  decltype(auto) with_model(const Function& function) const {
    return dispatch_model(_parameters.material, function);
  }

  // ---- setup ----
  void make_vertices();
  void make_dead_loads();
  void make_loads();
  void make_surface();
  void make_motions();
  void make_sums();
  void make_stages();
  void make_persistent();
  /// Verlet steps alternate between two buffers, which a captured graph would not see.
  [[nodiscard]] static Driver requested_driver(const Parameters& p) {
    return p.integrator == Integrator::verlet ? Driver::plain : p.driver;
  }
  void rebuild_drivers();
  [[nodiscard]] Points rest_places() const;
  [[nodiscard]] ProgramsView<ExecutionSpace> programs(
      const std::vector<device::ExpressionProgram>& from) const {
    return list_view(space(), "drogue::fabric::programs", from);
  }

  // ---- steps ----
  struct UniformSteps;
  void enqueue(std::int64_t steps) {
    with_model([&]<ConstitutiveModel law>() { this->template enqueue_model_steps<law>(steps); });
  }
  void save_checkpoint(std::int64_t launches);
  [[nodiscard]] stepping::StageTime<ExecutionSpace> at_stage(double part) const {
    return {_monitor, _time, _parity, part};
  }
  [[nodiscard]] VertexForceTerm<VertexForce> vertex_force_term() const {
    return {_vertex_force, _time, _vertices};
  }
  /// Whether every stage is a kernel: other kernels need its state, or the execution space is a host, whose
  /// registers do not hold two stages at once.
  [[nodiscard]] bool goes_by_stages() const {
    return device::is_host<ExecutionSpace> || _has_external || moves_pins() ||
           _launcher.driver() == Driver::stages;
  }
  [[nodiscard]] ExternalFunctor<ExecutionSpace> external_functor(const Points& x, const Points& v,
                                                                 double part, bool damps) const {
    return {_external, _dead, x, v, _cloth.load, at_stage(part), damps};
  }
  /// Computes `_cloth.load`.
  void compute_external_forces(const Points& x, const Points& v, double part, bool damps) const {
    launch_each("drogue::fabric::external", _vertices, external_functor(x, v, part, damps));
  }
  [[nodiscard]] bool moves_pins() const { return _dirichlet || _prescribed_motion; }
  /// Sets the axes that expressions or the caller's Views move.
  void apply_dirichlet(const Points& x, const Points& v, double part, bool checks_divergence) const {
    if (_dirichlet)
      launch_each("drogue::fabric::dirichlet", static_cast<int>(_dirichlet->vertex.extent(0)),
                  DirichletFunctor<ExecutionSpace>{*_dirichlet, x, v, at_stage(part), checks_divergence});
    if (_prescribed_motion)
      launch_each("drogue::fabric::prescribed_motion", static_cast<int>(_pinned_axes.vertex.extent(0)),
                  PrescribedMotionFunctor<ExecutionSpace>{_pinned_axes, *_prescribed_motion, x, v,
                                                          at_stage(part), checks_divergence});
  }
  template <ConstitutiveModel law, bool last>
  void runge_kutta_half(const char* label) const {
    launch(label, RungeKuttaHalfFunctor<ExecutionSpace, law, last, VertexForce>{_cloth,
                                                                                _x,
                                                                                _v,
                                                                                _next,
                                                                                _other,
                                                                                {_velocity[0], _velocity[1]},
                                                                                _monitor,
                                                                                _time.dt,
                                                                                vertex_force_term()});
  }
  template <ConstitutiveModel law>
  void runge_kutta_stages() const;
  template <ConstitutiveModel law>
  void enqueue_runge_kutta_step() const;
  /// Enqueues a step by the plain or graph driver. The caller's capture contains the kernels themselves.
  template <ConstitutiveModel law>
  void launch_runge_kutta_step() {
    const auto enqueue_step = [this](const ExecutionSpace&) { enqueue_runge_kutta_step<law>(); };
    if (_loop.is_capturing())
      enqueue_step(space());
    else
      _launcher.launch(0, enqueue_step);
  }
  template <ConstitutiveModel law>
  void verlet(bool ends, bool begins);
  /// Takes steps in one launch. Checkpoints end launches, so that none has more than `checkpoint_interval`
  /// steps, which take a few milliseconds.
  template <ConstitutiveModel law>
  void step_persistent(std::int64_t steps) {
    if constexpr (device::PersistentKernel<ExecutionSpace>::available) {
      const bool captured = _loop.has_captured_steps();
      if (captured) {
        // A launch that is replayed finds its step count on the device, and messages of epoch 0.
        device::copy_bytes(space(), device::CopyKind::within, &_monitor.steps(1), &_monitor.steps(0),
                           sizeof(std::int64_t));
        _persistent->grid.clear_messages();
        _persistent->epoch = 0;
      }
      FabricViews<ExecutionSpace> cloth = _cloth;
      cloth.load = _dead;
      const std::int64_t before = captured ? -1 : _time.step;
      const auto with = [&]<bool loads>(const PersistentLoads<ExecutionSpace, loads>& load) {
        return PersistentSteps<ExecutionSpace, VertexForce, loads>{
            _persistent->patches, cloth, _x, _v, _monitor, _time.dt, before, steps, _persistent->epoch,
            vertex_force_term(),  load};
      };
      const auto& grid = _persistent->grid;
      if (_has_external)
        grid.template launch<most_ring_threads, 1>(
            PersistentRingsFunctor<ExecutionSpace, law, VertexForce, true>{
                with(PersistentLoads<ExecutionSpace, true>{_external, _time})});
      else if (_persistent->pairs)
        grid.template launch<most_pair_threads, 1>(PersistentPairsFunctor<ExecutionSpace, law, VertexForce>{
            with(PersistentLoads<ExecutionSpace, false>{})});
      else
        grid.template launch<most_ring_threads, 1>(PersistentRingsFunctor<ExecutionSpace, law, VertexForce>{
            with(PersistentLoads<ExecutionSpace, false>{})});
      _persistent->epoch += 4 * static_cast<std::uint64_t>(steps);
    }
  }
  template <ConstitutiveModel law>
  void enqueue_model_steps(std::int64_t steps);
  template <ConstitutiveModel law>
  void enqueue_contact_step();
  void restore_addresses();
  void reset_monitor();

  // ---- evaluation ----
  void forces_at(const Points& x, std::span<Vector> forces) const {
    if (_has_external) compute_external_forces(x, _v, 0.0, false);
    with_model([&]<ConstitutiveModel law>() {
      launch("drogue::fabric::force", ForceFunctor<ExecutionSpace, law>{_cloth, x, _next});
    });
    to_host(_next, forces);
  }
  template <ConstitutiveModel law>
  [[nodiscard]] double largest_row(const ListView<ExecutionSpace, double>& more) const;
  /// Stress of all triangles, and their tensors if `tensor` is not empty.
  void find_stress(StressMeasure measure, const StressView<ExecutionSpace>& to,
                   const TensorView<ExecutionSpace>& tensor) {
    if (_parameters.material.model == Model::linear_vector)
      throw std::invalid_argument("fabric solver: springs of vectors (Model I) have no stress");
    synchronize();
    if (!_triangles) _triangles.emplace(space(), triangle_list(_parameters.mesh, _parameters.material));
    with_model([&]<ConstitutiveModel law>() {
      Kokkos::parallel_for(
          "drogue::fabric::stress",
          Kokkos::RangePolicy<ExecutionSpace>(space(), 0,
                                              static_cast<int>(_parameters.mesh.triangles.size())),
          StressFunctor<ExecutionSpace, law>{*_triangles, _x, _cloth.moduli, measure, to, tensor});
    });
  }
  void stress_to_host(const StressView<ExecutionSpace>& from, std::span<Stress> to) const;
  void require_vertices(std::size_t count) const;
  void to_device(std::span<const Vector> from, const Points& to) const;
  void to_host(const Points& from, std::span<Vector> to) const;

  device::Instance<ExecutionSpace> _instance;
  Parameters _parameters;
  VertexForce _vertex_force;
  int _vertices, _padded;  ///< in whole slices
  double _decay;           ///< 1/s, upper bound of the rates of damping
  TimeState _time;
  FabricViews<ExecutionSpace> _cloth;
  External<ExecutionSpace> _external;
  bool _has_external = false;  ///< a kernel of its own computes loads
  bool _has_dashpots = false;
  std::optional<DirichletConditions<ExecutionSpace>> _dirichlet;
  std::optional<PrescribedMotion<ExecutionSpace>> _prescribed_motion;  ///< after the first request
  PinnedAxes<ExecutionSpace> _pinned_axes;                             ///< of the prescribed motion
  stepping::StepLoop<ExecutionSpace> _loop;
  stepping::StepLauncher<ExecutionSpace> _launcher;
  StepMonitor<ExecutionSpace> _monitor;
  stepping::Checkpoint<ExecutionSpace> _checkpoint;
  int _parity = 0;  ///< entry of `_monitor.steps` that counts the completed steps
  std::optional<StepFailure> _failure;
  Points _pull;                                   ///< forces of springs of vectors at rest, N
  double _rest_energy = 0.0;                      ///< J, of these springs
  Points _dead;                                   ///< loads, N; may be empty
  std::vector<TotalsView<ExecutionSpace>> _sums;  ///< levels of the sum, the last of one row
  typename TotalsView<ExecutionSpace>::HostMirror _sum;
  mutable typename Points::HostMirror _on_host;  ///< of a device, made at the first download
  ListView<ExecutionSpace, double> _load_stiffness;
  Points _x, _v, _next;
  Points _saved_x, _saved_v;
  Points _other, _velocity[3];  ///< of Runge and Kutta's method, the last one only by stages
  Points _dragged;              ///< of Verlet's method with dashpots
  std::optional<TriangleViews<ExecutionSpace>> _triangles;  ///< made at the first request of stress
  std::optional<PersistentDriver<ExecutionSpace>> _persistent;
  std::unique_ptr<ContactHandler<ExecutionSpace>> _contact;  ///< empty without contact
};

// ---- setup ----

template <class ExecutionSpace, class VertexForce>
FabricSolver<ExecutionSpace, VertexForce>::FabricSolver(const ExecutionSpace& space, const Parameters& p,
                                                        VertexForce vertex_force)
    : _instance(space),
      _parameters((check_parameters(p), p)),
      _vertex_force(vertex_force),
      _vertices(static_cast<int>(p.mesh.rest.size())),
      _padded((_vertices + slice - 1) / slice * slice),
      _decay(p.integrator == Integrator::rk4 ? p.damping : 0.0),
      _time{0, p.dt, 0, 0.0},
      _loop(_instance),
      _launcher(_instance, requested_driver(p)),
      _monitor(stepping::make_monitor<ExecutionSpace>(_loop.status_view())) {
  const RingAdjacency rings =
      ring_adjacency(has_triangles(p.material.model) ? p.mesh : Mesh{p.mesh.rest, {}, {}, {}, {}});
  if (has_triangles(p.material.model)) {
    _cloth.triangles = sliced_ell_views(space, rings, device::is_host<ExecutionSpace>);
    if constexpr (!device::is_host<ExecutionSpace>) _cloth.rest = rest_places();
  }
  _cloth.springs = sliced_ell_views(space, spring_adjacency(p.mesh, p.material));
  _cloth.moduli = moduli(p.material.membrane_modulus, p.material.poisson);
  _cloth.gravity = {p.gravity[0], p.gravity[1], p.gravity[2]};
  _cloth.damping = p.integrator == Integrator::rk4 ? p.damping : 0.0;
  make_vertices();
  make_dead_loads();
  make_loads();
  make_motions();
  if (_external.has_pressure() || _external.bending.first.extent(0) > 0)
    _load_stiffness = decltype(_load_stiffness)("drogue::fabric::load_stiffness", p.mass.size());
  make_sums();
  _x = points("drogue::fabric::positions");
  _v = points("drogue::fabric::velocities");
  _next = points("drogue::fabric::next");
  _saved_x = points("drogue::fabric::saved_positions");
  _saved_v = points("drogue::fabric::saved_velocities");
  reset_monitor();
  if (p.contact.asked_for())
    _contact = make_contact<ExecutionSpace>(p, {_instance, _cloth.inverse_mass, _cloth.fixed_dofs, _monitor});
  rebuild_drivers();
}

template <class ExecutionSpace, class VertexForce>
void FabricSolver<ExecutionSpace, VertexForce>::make_vertices() {
  const Parameters& p = _parameters;
  const auto n = static_cast<std::size_t>(_vertices);
  _cloth.inverse_mass =
      decltype(_cloth.inverse_mass)("drogue::fabric::inverse_mass", static_cast<std::size_t>(_padded));
  const auto inverse_mass = Kokkos::create_mirror_view(_cloth.inverse_mass);
  // Vertices that fill the last slice have no inverse mass and no freedom: they stay.
  _cloth.fixed_dofs =
      decltype(_cloth.fixed_dofs)("drogue::fabric::fixed_dofs", static_cast<std::size_t>(_padded));
  const auto fixed_dofs = Kokkos::create_mirror_view(_cloth.fixed_dofs);
  for (std::size_t i = 0; i < fixed_dofs.extent(0); ++i) {
    if (i < n) inverse_mass(i) = 1.0 / p.mass[i];
    fixed_dofs(i) = i >= n ? 7 : p.pinned.empty() ? 0 : p.pinned[i];
  }
  for (const Motion& motion : p.motions)
    for (const int i : motion.vertices)
      fixed_dofs(i) |= static_cast<std::uint8_t>(1U << static_cast<unsigned>(motion.axis));
  device::copy(space(), _cloth.inverse_mass, inverse_mass);
  device::copy(space(), _cloth.fixed_dofs, fixed_dofs);
  space().fence("drogue::fabric::vertices");
}

template <class ExecutionSpace, class VertexForce>
void FabricSolver<ExecutionSpace, VertexForce>::make_dead_loads() {
  const Parameters& p = _parameters;
  const auto n = static_cast<std::size_t>(_vertices);
  std::vector<Vector> load = rest_pull(p.mesh, p.material);
  if (!load.empty()) {
    _pull = points("drogue::fabric::pull");
    to_device(load, _pull);
    // Sum of k (X_j - X_i)^2 / 2 over the springs.
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t axis = 0; axis < 3; ++axis) _rest_energy += 0.5 * load[i][axis] * p.mesh.rest[i][axis];
  }
  if (load.empty())
    load = p.load;
  else if (!p.load.empty())
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t axis = 0; axis < 3; ++axis) load[i][axis] += p.load[i][axis];
  if (std::ranges::any_of(load, [](const Vector& v) { return v != Vector{}; })) {
    _dead = points("drogue::fabric::dead_load");
    to_device(load, _dead);
  }
  _cloth.load = _dead;
}

/// Positions at rest, shared with forces or loads if they have them.
template <class ExecutionSpace, class VertexForce>
PointsView<ExecutionSpace> FabricSolver<ExecutionSpace, VertexForce>::rest_places() const {
  if (_cloth.rest.extent(0) > 0) return _cloth.rest;
  if (_external.rest.extent(0) > 0) return _external.rest;
  const Points rest = points("drogue::fabric::rest_places");
  to_device(_parameters.mesh.rest, rest);
  return rest;
}

template <class ExecutionSpace, class VertexForce>
void FabricSolver<ExecutionSpace, VertexForce>::make_loads() {
  const Parameters& p = _parameters;
  _has_dashpots = p.relative_damping > 0.0;
  const double bending = p.material.bending_stiffness;
  if (bending > 0.0) _external.bending = sliced_ell_views(space(), bending_adjacency(p.mesh, bending));
  _has_external = !p.timed_loads.empty() || !p.follower_pressures.empty() || bending > 0.0 ||
                  (_has_dashpots && p.integrator == Integrator::rk4);
  if (_has_dashpots) {
    const DashpotAdjacency dashpots = dashpot_adjacency(p.mesh, p.mass, p.relative_damping);
    _external.dashpots = sliced_ell_views(space(), dashpots);
    // Gershgorin: both ends of a dashpot, each over its mass.
    std::vector<double> row(p.mass.size(), 0.0);
    for (std::size_t slice_number = 0; slice_number + 1 < dashpots.first.size(); ++slice_number)
      for (int k = dashpots.first[slice_number]; k < dashpots.first[slice_number + 1]; ++k)
        for (std::size_t lane = 0; lane < slice; ++lane) {
          const std::size_t i = slice_number * slice + lane;
          if (i < row.size())
            row[i] += 2.0 * dashpots.value[0][static_cast<std::size_t>(k) * slice + lane] / p.mass[i];
        }
    _decay += *std::ranges::max_element(row);
    if (p.integrator == Integrator::verlet) _dragged = points("drogue::fabric::dragged");
  }
  if (!_has_external) return;
  const std::size_t n = p.mass.size();
  _external.rest = rest_places();
  _cloth.load = points("drogue::fabric::load");
  std::vector<device::ExpressionProgram> strength;
  _external.direction =
      decltype(_external.direction)("drogue::fabric::load_directions", n, p.timed_loads.size());
  const auto direction = Kokkos::create_mirror_view(_external.direction);
  for (std::size_t k = 0; k < p.timed_loads.size(); ++k) {
    strength.push_back(p.timed_loads[k].strength);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t axis = 0; axis < 3; ++axis)
        direction(i, k, axis) = p.timed_loads[k].direction[i][axis];
  }
  device::copy(space(), _external.direction, direction);
  _external.load = programs(strength);
  if (p.follower_pressures.empty()) return;
  make_surface();
  strength.clear();
  _external.weight =
      decltype(_external.weight)("drogue::fabric::pressure_weights", n, p.follower_pressures.size());
  const auto weight = Kokkos::create_mirror_view(_external.weight);
  for (std::size_t k = 0; k < p.follower_pressures.size(); ++k) {
    const FollowerPressure& pressure = p.follower_pressures[k];
    strength.push_back(pressure.strength);
    for (std::size_t i = 0; i < n; ++i) weight(i, k) = pressure.weight.empty() ? 1.0 : pressure.weight[i];
  }
  device::copy(space(), _external.weight, weight);
  _external.pressure = programs(strength);
}

template <class ExecutionSpace, class VertexForce>
void FabricSolver<ExecutionSpace, VertexForce>::make_surface() {
  _external.surface = has_triangles(_parameters.material.model)
                          ? _cloth.triangles
                          : sliced_ell_views(space(), ring_adjacency(_parameters.mesh), false);
}

template <class ExecutionSpace, class VertexForce>
void FabricSolver<ExecutionSpace, VertexForce>::make_motions() {
  const Parameters& p = _parameters;
  if (p.motions.empty()) return;
  std::vector<device::ExpressionProgram> displacement;
  std::vector<int> vertex, axis, program;
  for (const Motion& motion : p.motions) {
    for (const int i : motion.vertices) {
      vertex.push_back(i);
      axis.push_back(motion.axis);
      program.push_back(static_cast<int>(displacement.size()));
    }
    displacement.push_back(motion.displacement);
  }
  const Points rest = rest_places();
  _dirichlet = DirichletConditions<ExecutionSpace>{
      rest, programs(displacement), list_view(space(), "drogue::fabric::moved_vertices", vertex),
      list_view(space(), "drogue::fabric::moved_axes", axis),
      list_view(space(), "drogue::fabric::moved_by", program)};
}

/// Allocates the levels of sums once: totals are computed often.
template <class ExecutionSpace, class VertexForce>
void FabricSolver<ExecutionSpace, VertexForce>::make_sums() {
  int rows = _vertices;
  do {
    rows = (rows + sum_radix - 1) / sum_radix;
    _sums.emplace_back("drogue::fabric::totals", static_cast<std::size_t>(rows));
  } while (rows > 1);
  _sum = Kokkos::create_mirror_view(_sums.back());
}

template <class ExecutionSpace, class VertexForce>
void FabricSolver<ExecutionSpace, VertexForce>::make_stages() {
  for (int stage = 0; stage < (goes_by_stages() ? 3 : 2); ++stage)
    if (_velocity[stage].extent(0) == 0) _velocity[stage] = points("drogue::fabric::stage_velocities");
  if (_other.extent(0) == 0) _other = points("drogue::fabric::stage_positions");
}

template <class ExecutionSpace, class VertexForce>
void FabricSolver<ExecutionSpace, VertexForce>::make_persistent() {
  if constexpr (device::PersistentKernel<ExecutionSpace>::available) {
    using Grid = device::PersistentKernel<ExecutionSpace>;
    const Parameters& p = _parameters;
    // Bending reaches beyond the halo, dashpots need the velocities of neighbours.
    if (!_launcher.may_be_persistent(p.driver) || _external.bending.first.extent(0) > 0 || _has_dashpots ||
        moves_pins() || _contact)
      return;
    const int teams = Grid::most_teams(_instance);
    if (teams == 0) return;
    const auto share = [&](int parts) { return (_vertices + parts - 1) / parts; };
    const int count = std::min(teams, share(p.patch > 0 ? p.patch : slice));
    if (share(count) > most_ring_threads) return;
    const bool rings = has_triangles(p.material.model) || _external.has_pressure();
    const Patches patches =
        make_patches(p.mesh.rest, ring_adjacency(rings ? p.mesh : Mesh{p.mesh.rest, {}, {}, {}, {}}),
                     spring_adjacency(p.mesh, p.material), count);
    const PatchViews<ExecutionSpace> views = patch_views(space(), patches);
    const bool pairs = patches.team <= most_pair_vertices && !_has_external;
    constexpr ConstitutiveModel any{Model::edge};  // all models need the same memory
    const std::size_t scratch = pairs ? PersistentPairsFunctor<ExecutionSpace, any>::scratch_bytes(views)
                                      : PersistentRingsFunctor<ExecutionSpace, any>::scratch_bytes(views);
    if (scratch > Grid::most_scratch_bytes(_instance)) return;
    const int threads = pairs ? team_threads(patches, patches.most_rows, most_pair_threads)
                              : team_threads(patches, 0, most_ring_threads);
    _persistent.emplace(PersistentDriver<ExecutionSpace>{
        {_instance, count, threads, scratch, static_cast<std::size_t>(patches.places)}, views, pairs});
    _launcher.use_persistent();
  }
}

template <class ExecutionSpace, class VertexForce>
void FabricSolver<ExecutionSpace, VertexForce>::rebuild_drivers() {
  if (_parameters.integrator != Integrator::rk4) return;
  _launcher = {_instance, requested_driver(_parameters)};
  _persistent.reset();
  make_stages();
  make_persistent();
}

// ---- state and loads ----

template <class ExecutionSpace, class VertexForce>
State<ExecutionSpace> FabricSolver<ExecutionSpace, VertexForce>::state() const {
  return {without_padding(_x), without_padding(_v)};
}

template <class ExecutionSpace, class VertexForce>
PointsView<ExecutionSpace> FabricSolver<ExecutionSpace, VertexForce>::loads() {
  if (_dead.extent(0) == 0) {
    synchronize();
    _dead = points("drogue::fabric::dead_load");
    if (!_has_external) _cloth.load = _dead;
    _launcher.discard_graphs();
  }
  return without_padding(_dead);
}

template <class ExecutionSpace, class VertexForce>
auto FabricSolver<ExecutionSpace, VertexForce>::pressures() -> PressureView {
  if (_external.pressure_values.extent(0) == 0) {
    synchronize();
    const auto n = static_cast<std::size_t>(_vertices);
    _external.pressure_values = PressureView("drogue::fabric::pressures", n);
    if (!_has_external) {
      _external.rest = rest_places();
      _cloth.load = points("drogue::fabric::load");
      _has_external = true;
    }
    if (_external.surface.first.extent(0) == 0) make_surface();
    if (_load_stiffness.extent(0) == 0)
      _load_stiffness = decltype(_load_stiffness)("drogue::fabric::load_stiffness", n);
    rebuild_drivers();
  }
  return _external.pressure_values;
}

template <class ExecutionSpace, class VertexForce>
PrescribedMotion<ExecutionSpace> FabricSolver<ExecutionSpace, VertexForce>::prescribed_motion() {
  if (!_prescribed_motion) {
    synchronize();
    const Parameters& p = _parameters;
    std::vector<std::uint8_t> axes = p.pinned;
    for (const Motion& motion : p.motions)
      for (const int i : motion.vertices)
        if (!axes.empty())
          axes[static_cast<std::size_t>(i)] &=
              static_cast<std::uint8_t>(~(1U << static_cast<unsigned>(motion.axis)));
    std::vector<int> vertex, axis;
    for (std::size_t i = 0; i < axes.size(); ++i)
      for (unsigned a = 0; a < 3; ++a)
        if ((axes[i] >> a & 1U) != 0U)
          vertex.push_back(static_cast<int>(i)), axis.push_back(static_cast<int>(a));
    if (vertex.empty()) throw std::logic_error("fabric solver: there are no pins to move");
    _pinned_axes = {rest_places(), list_view(space(), "drogue::fabric::pinned_vertices", vertex),
                    list_view(space(), "drogue::fabric::pinned_axes", axis)};
    const auto n = static_cast<std::size_t>(_vertices);
    _prescribed_motion = PrescribedMotion<ExecutionSpace>{
        Points("drogue::fabric::pin_displacements", n), Points("drogue::fabric::pin_velocities", n),
        Points("drogue::fabric::pin_accelerations", n),
        decltype(PrescribedMotion<ExecutionSpace>::time)("drogue::fabric::pin_time")};
    launch_each(
        "drogue::fabric::initial_motion", static_cast<int>(vertex.size()),
        InitialMotionFunctor<ExecutionSpace>{_pinned_axes, *_prescribed_motion, _x, _v, at_stage(0.0)});
    rebuild_drivers();
  }
  return *_prescribed_motion;
}

template <class ExecutionSpace, class VertexForce>
void FabricSolver<ExecutionSpace, VertexForce>::set_vertex_force(const VertexForce& vertex_force) {
  _vertex_force = vertex_force;
  _launcher.discard_graphs();
}

template <class ExecutionSpace, class VertexForce>
void FabricSolver<ExecutionSpace, VertexForce>::upload(std::span<const Vector> positions,
                                                       std::span<const Vector> velocities) {
  const auto within = [](const Vector& vector) {
    return std::abs(vector[0]) + std::abs(vector[1]) + std::abs(vector[2]) < divergence_limit;
  };
  if (!std::ranges::all_of(positions, within) || !std::ranges::all_of(velocities, within))
    throw std::invalid_argument("fabric solver: positions and velocities must be finite");
  if (_loop.has_captured_steps()) synchronize();
  to_device(positions, _x);
  to_device(velocities, _v);
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
  synchronize();
  to_host(_x, positions);
  to_host(_v, velocities);
}

template <class ExecutionSpace, class VertexForce>
void FabricSolver<ExecutionSpace, VertexForce>::require_vertices(std::size_t count) const {
  if (count != static_cast<std::size_t>(_vertices))
    throw std::invalid_argument("fabric solver: there must be one vector a vertex");
}

template <class ExecutionSpace, class VertexForce>
void FabricSolver<ExecutionSpace, VertexForce>::to_device(std::span<const Vector> from,
                                                          const Points& to) const {
  require_vertices(from.size());
  const auto mirror = Kokkos::create_mirror_view(to);
  for (std::size_t i = 0; i < mirror.extent(0); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis) mirror(i, axis) = i < from.size() ? from[i][axis] : 0.0;
  device::copy(space(), to, mirror);
  space().fence("drogue::fabric::to_device");
}

template <class ExecutionSpace, class VertexForce>
void FabricSolver<ExecutionSpace, VertexForce>::to_host(const Points& from, std::span<Vector> to) const {
  require_vertices(to.size());
  typename Points::HostMirror mirror = _on_host;
  if constexpr (device::is_host<ExecutionSpace>)
    mirror = from;
  else if (mirror.extent(0) == 0)
    mirror = _on_host = Kokkos::create_mirror(from);
  device::copy(space(), mirror, from);
  space().fence("drogue::fabric::to_host");
  for (std::size_t i = 0; i < to.size(); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis) to[i][axis] = mirror(i, axis);
}

// ---- steps ----

template <class ExecutionSpace, class VertexForce>
template <ConstitutiveModel law>
void FabricSolver<ExecutionSpace, VertexForce>::enqueue_runge_kutta_step() const {
  if (goes_by_stages()) return runge_kutta_stages<law>();
  if constexpr (!device::is_host<ExecutionSpace>) {
    runge_kutta_half<law, false>("drogue::fabric::rk4_begin");
    runge_kutta_half<law, true>("drogue::fabric::rk4_end");
  }
}

template <class ExecutionSpace, class VertexForce>
template <ConstitutiveModel law>
void FabricSolver<ExecutionSpace, VertexForce>::runge_kutta_stages() const {
  const Points at[] = {_x, _next, _other, _next}, next[] = {_next, _other, _next, _x};
  // Parts of the step before and after each stage; the last stage has counted the step.
  const double before[] = {0.0, 0.5, 0.5, 1.0}, after[] = {0.5, 0.5, 1.0, 0.0};
  for (int stage = 0; stage < 4; ++stage) {
    if (_has_external)
      compute_external_forces(at[stage], stage == 0 ? _v : _velocity[stage - 1], before[stage],
                              _has_dashpots);
    launch("drogue::fabric::rk4_stage",
           RungeKuttaFunctor<ExecutionSpace, law, VertexForce>{_cloth,
                                                               _x,
                                                               _v,
                                                               at[stage],
                                                               next[stage],
                                                               {_velocity[0], _velocity[1], _velocity[2]},
                                                               _monitor,
                                                               _time.dt,
                                                               stage,
                                                               vertex_force_term()});
    if (moves_pins())
      apply_dirichlet(next[stage], stage == 3 ? _v : _velocity[stage], after[stage], stage == 3);
  }
}

template <class ExecutionSpace, class VertexForce>
template <ConstitutiveModel law>
void FabricSolver<ExecutionSpace, VertexForce>::verlet(bool ends, bool begins) {
  if (_has_external) compute_external_forces(_x, _v, 0.0, false);
  launch("drogue::fabric::verlet", VerletFunctor<ExecutionSpace, law, VertexForce>{
                                       _cloth, _x, _v, _next, _monitor, _parameters.damping, _time.dt,
                                       _parity, ends, begins, !_has_dashpots, vertex_force_term()});
  if (!begins) return;
  if (_has_dashpots) {
    launch_each(
        "drogue::fabric::drag", _vertices,
        DashpotDampingFunctor<ExecutionSpace>{_cloth, _external.dashpots, _x, _v, _dragged, _next, _time.dt});
    std::swap(_v, _dragged);
  }
  std::swap(_x, _next);
  _parity = 1 - _parity;
  if (moves_pins()) apply_dirichlet(_x, _v, 0.0, true);
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
  if (_failure) return false;
  if (_contact && device::is_capturing(space()))
    throw std::logic_error("fabric solver: steps with contact cannot be captured");
  const bool sound =
      _loop.enqueue_steps(_time.step, steps, stepping::checkpoint_interval, UniformSteps{*this});
  restore_addresses();
  return sound;
}

template <class ExecutionSpace, class VertexForce>
template <ConstitutiveModel law>
void FabricSolver<ExecutionSpace, VertexForce>::enqueue_model_steps(std::int64_t steps) {
  if (_contact) {
    for (std::int64_t k = 0; k < steps; ++k) enqueue_contact_step<law>();
  } else if (_parameters.integrator == Integrator::verlet) {
    verlet<law>(false, true);
    for (std::int64_t k = 1; k < steps; ++k) verlet<law>(true, true);
    verlet<law>(true, false);
  } else if (_launcher.is_persistent()) {
    step_persistent<law>(steps);
  } else {
    for (std::int64_t k = 0; k < steps; ++k) launch_runge_kutta_step<law>();
  }
}

template <class ExecutionSpace, class VertexForce>
template <ConstitutiveModel law>
void FabricSolver<ExecutionSpace, VertexForce>::enqueue_contact_step() {
  _contact->begin_step(_x, _v);
  if (_parameters.integrator == Integrator::verlet) {
    verlet<law>(false, true);
    verlet<law>(true, false);
  } else {
    launch_runge_kutta_step<law>();
  }
  _contact->end_step(_x, _v);
}

/// Moves the state back to its stable addresses after an odd number of Verlet's steps, which alternate
/// between two buffers.
template <class ExecutionSpace, class VertexForce>
void FabricSolver<ExecutionSpace, VertexForce>::restore_addresses() {
  if (_parity == 0) return;
  const Points x = _x, v = _v;
  std::swap(_x, _next);
  if (_has_dashpots) std::swap(_v, _dragged);
  launch_each("drogue::fabric::restore_addresses", _padded,
              RestoreAddressesFunctor<ExecutionSpace>{_monitor, x, v, _x, _v});
  _parity = 0;
}

/// Enqueues a checkpoint that publishes `launches`, unless that is negative.
template <class ExecutionSpace, class VertexForce>
void FabricSolver<ExecutionSpace, VertexForce>::save_checkpoint(std::int64_t launches) {
  SavedState<ExecutionSpace> now{_x, _v, {}}, saved{_saved_x, _saved_v, {}};
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
    if (!_contact) return;
    const CheckpointedWork<ExecutionSpace> work = _contact->checkpointed_work();
    device::copy(space(), work.now, work.saved);
  });
  if (_loop.has_captured_steps()) _time.step = stepping::completed_steps(space(), _monitor, _parity);
  if (!first) return;
  _time.step = first->step - 1;
  _failure = StepFailure{_contact ? _contact->reason(first->step) : FailureReason::not_finite, first->index,
                         first->step, _time.time(), _time.dt};
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
  synchronize();
  _time = time;
  reset_monitor();
  if (moves_pins() && !_failure) apply_dirichlet(_x, _v, 0.0, true);
  enqueue_checkpoint();
  if (_contact) _contact->set_dt(_time.dt);
  _launcher.discard_graphs();
}

// ---- evaluation ----

template <class ExecutionSpace, class VertexForce>
void FabricSolver<ExecutionSpace, VertexForce>::forces(std::span<Vector> forces) {
  synchronize();
  forces_at(_x, forces);
}

template <class ExecutionSpace, class VertexForce>
template <ConstitutiveModel law>
double FabricSolver<ExecutionSpace, VertexForce>::largest_row(
    const ListView<ExecutionSpace, double>& more) const {
  double largest = 0.0;
  Kokkos::parallel_reduce(
      "drogue::fabric::frequency", Kokkos::RangePolicy<ExecutionSpace>(space(), 0, _vertices),
      FrequencyFunctor<ExecutionSpace, law>{_cloth, _x, more}, Kokkos::Max<double>(largest));
  return largest;
}

template <class ExecutionSpace, class VertexForce>
double FabricSolver<ExecutionSpace, VertexForce>::frequency_at_least() {
  synchronize();
  const auto n = static_cast<std::size_t>(_vertices);
  // M^-1/2 K M^-1/2 is symmetric; fixed degrees of freedom have no row in it.
  const auto inverse_mass = Kokkos::create_mirror_view(_cloth.inverse_mass);
  const auto fixed_dofs = Kokkos::create_mirror_view(_cloth.fixed_dofs);
  device::copy(space(), inverse_mass, _cloth.inverse_mass);
  device::copy(space(), fixed_dofs, _cloth.fixed_dofs);
  space().fence("drogue::fabric::masses");
  std::vector<double> root(3 * n);
  for (std::size_t k = 0; k < root.size(); ++k)
    root[k] = (fixed_dofs(k / 3) >> k % 3 & 1U) != 0U ? 0.0 : std::sqrt(inverse_mass(k / 3));
  // Short enough for linear forces, long enough for forces above round-off.
  const double displacement = 1e-5 * shortest_edge(_parameters.mesh);
  std::vector<Vector> now(n), v(n), ahead(n), behind(n);
  download(now, v);
  const Points trial = points("drogue::fabric::trial");
  const auto force_after = [&](double factor, std::span<const double> move, std::vector<Vector>& force) {
    for (std::size_t k = 0; k < root.size(); ++k)
      force[k / 3][k % 3] = now[k / 3][k % 3] + factor * root[k] * move[k];
    to_device(force, trial);
    forces_at(trial, force);
  };
  const auto apply = [&](std::span<const double> in, std::span<double> out) {
    double most = 0.0;
    for (std::size_t k = 0; k < root.size(); ++k) most = std::max(most, std::abs(root[k] * in[k]));
    const double factor = most > 0.0 ? displacement / most : 0.0;
    force_after(factor, in, ahead);
    force_after(-factor, in, behind);
    for (std::size_t k = 0; k < root.size(); ++k)
      out[k] = most > 0.0 ? root[k] * (behind[k / 3][k % 3] - ahead[k / 3][k % 3]) / (2.0 * factor) : 0.0;
  };
  return std::sqrt(std::max(0.0, largest_ritz_value(root.size(), 64, apply)));
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

template <class ExecutionSpace, class VertexForce>
void FabricSolver<ExecutionSpace, VertexForce>::stress(StressMeasure measure,
                                                       std::span<Stress> of_triangles) {
  if (of_triangles.size() != _parameters.mesh.triangles.size())
    throw std::invalid_argument("fabric solver: there must be one stress a triangle");
  const StressView<ExecutionSpace> found("drogue::fabric::stress", of_triangles.size());
  find_stress(measure, found, {});
  stress_to_host(found, of_triangles);
}

template <class ExecutionSpace, class VertexForce>
void FabricSolver<ExecutionSpace, VertexForce>::vertex_stress(StressMeasure measure,
                                                              std::span<Stress> of_vertices) {
  require_vertices(of_vertices.size());
  const StressView<ExecutionSpace> of_triangles("drogue::fabric::stress", _parameters.mesh.triangles.size()),
      found("drogue::fabric::vertex_stress", of_vertices.size());
  const TensorView<ExecutionSpace> tensor("drogue::fabric::stress_tensors",
                                          _parameters.mesh.triangles.size());
  find_stress(measure, of_triangles, tensor);
  Kokkos::parallel_for("drogue::fabric::vertex_stress",
                       Kokkos::RangePolicy<ExecutionSpace>(space(), 0, _vertices),
                       VertexStressFunctor<ExecutionSpace>{*_triangles, tensor, found});
  stress_to_host(found, of_vertices);
}

template <class ExecutionSpace, class VertexForce>
void FabricSolver<ExecutionSpace, VertexForce>::stress_to_host(const StressView<ExecutionSpace>& from,
                                                               std::span<Stress> to) const {
  const auto mirror = Kokkos::create_mirror_view(from);
  device::copy(space(), mirror, from);
  space().fence("drogue::fabric::stress_to_host");
  for (std::size_t i = 0; i < to.size(); ++i)
    to[i] = {mirror(i, 0),
             mirror(i, 1),
             {mirror(i, 2), mirror(i, 3), mirror(i, 4)},
             {mirror(i, 5), mirror(i, 6), mirror(i, 7)}};
}

// One translation unit per backend compiles the solver without a VertexForce.
#if defined(DROGUE_HAVE_SERIAL)
extern template class FabricSolver<Kokkos::Serial>;
#endif
#if defined(DROGUE_HAVE_OPENMP)
extern template class FabricSolver<Kokkos::OpenMP>;
#endif
#if defined(DROGUE_HAVE_CUDA)
extern template class FabricSolver<Kokkos::Cuda>;
#endif

}  // namespace drogue::fabric
