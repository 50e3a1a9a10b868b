#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>

#include "kernels/device/copy.hpp"
#include "kernels/flow/advection/momentum.hpp"
#include "kernels/flow/projection/projection.hpp"
#include "kernels/linear/poisson/diagonalization.hpp"
#include "kernels/linear/poisson/fourier.hpp"
#include "kernels/stepping/step_launcher.hpp"
#include "kernels/stepping/step_loop.hpp"

namespace drogue::flow {

/// First kernel of an advance.
template <class ExecutionSpace>
struct BeginAdvanceFunctor {
  ControlView<ExecutionSpace> control;
  typename stepping::StepLoop<ExecutionSpace>::StatusView status;
  StepConstants constants;
  stepping::AdvanceRequest request;
  std::int64_t output_step;

  KOKKOS_FUNCTION void operator()(int) const {
    Control& c = control();
    Progress now = c.now;
    stepping::StepTrial trial = c.trial;
    if (stepping::begin_advance(now, trial, request, output_step, constants.max_steps))
      prepare_step(now, trial, constants);
    c.next_rate = 0;
    c.first_failure = no_failure;
    stepping::publish_status(now, trial, 0, status());
    c.trial = trial;
  }
};

/// Last kernel of a step: accepts it or stops the run.
template <class ExecutionSpace>
struct FinishStepFunctor {
  ControlView<ExecutionSpace> control;
  typename stepping::StepLoop<ExecutionSpace>::StatusView status;
  StepConstants constants;

  KOKKOS_FUNCTION void operator()(int) const {
    Control& c = control();
    Progress now = c.now;
    stepping::StepTrial trial = c.trial;
    if (trial.stop == Stop::running) {
      if (c.first_failure != no_failure) {
        trial.stop = Stop::failed;
      } else {
        now.last_dt = trial.dt;
        now.dt_min = now.step == 0 || trial.dt < now.dt_min ? trial.dt : now.dt_min;
        now.dt_max = trial.dt > now.dt_max ? trial.dt : now.dt_max;
        now.rate = c.next_rate;
        stepping::advance_time(now, trial);
        if (stepping::continues(now, trial, constants.max_steps)) prepare_step(now, trial, constants);
        c.next_rate = 0;
      }
    }
    stepping::publish_status(now, trial, 0, status());
    c.now = now;
    c.trial = trial;
  }
};

/// Incompressible flow on a staggered grid, on the caller's instance of an execution space, for coupling to other
/// kernels. Second order in space and time (Chorin 1968; Kim and Moin 1985 for the staggered projection).
///
/// All work is enqueued on the instance given to the constructor. On CUDA the instance must have a stream of its own.
template <class ExecutionSpace>
class FlowSolver {
 public:
  using Views = List<ExecutionSpace>;
  using Poisson = std::variant<linear::FourierSolver<ExecutionSpace>, linear::DiagonalizationSolver<ExecutionSpace>>;

  FlowSolver(const device::Instance<ExecutionSpace>& instance, const Parameters& parameters, bool diagonalize = false)
      : _instance(&instance),
        _parameters(parameters),
        _grid(make_grid(parameters)),
        _loop(instance),
        _launcher(instance, parameters.driver) {
    const ExecutionSpace& space = instance.space();
    const auto field = [&](const std::string& label) {
      // Packs may load beyond the last cell.
      return Views(label, static_cast<std::size_t>(3 * _grid.component + 64));
    };
    _velocity = field("drogue::flow::velocity");
    _predicted = field("drogue::flow::predicted_velocity");
    _rate = field("drogue::flow::rate");
    _pressure = Views("drogue::flow::pressure", static_cast<std::size_t>(_grid.cells()));
    _control = ControlView<ExecutionSpace>("drogue::flow::control");
    linear::PoissonProblem problem;
    double diffusive_rate = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      problem.cells[axis] = parameters.cells[axis];
      problem.spacing[axis] = _grid.h[axis];
      for (std::size_t end = 0; end < 2; ++end) {
        const Boundary& side = parameters.boundary[2 * axis + end];
        _boundary.kind[2 * axis + end] = side.kind;
        for (std::size_t c = 0; c < 3; ++c) _boundary.velocity[2 * axis + end][c] = side.velocity[c];
      }
      const auto end = [&](std::size_t side) {
        return parameters.boundary[side].kind == BoundaryKind::outflow ? linear::EndCondition::dirichlet
                                                                       : linear::EndCondition::neumann;
      };
      problem.axes[axis] = {parameters.boundary[2 * axis].kind == BoundaryKind::periodic, end(2 * axis),
                            end(2 * axis + 1)};
      if (_grid.n[axis] > 1) diffusive_rate += 4.0 * _grid.inverse_h[axis] * _grid.inverse_h[axis];
    }
    if (linear::FourierSolver<ExecutionSpace>::supports(problem) && !diagonalize)
      _poisson.emplace(std::in_place_type<linear::FourierSolver<ExecutionSpace>>, space, problem);
    else
      _poisson.emplace(std::in_place_type<linear::DiagonalizationSolver<ExecutionSpace>>, space, problem);
    for (std::size_t axis = 0; axis < 3; ++axis)
      _acceleration[axis] = (parameters.body_force[axis] +
                             parameters.pressure_drop[axis] / (parameters.high[axis] - parameters.low[axis])) /
                            parameters.density;
    const double nu = parameters.viscosity / parameters.density;
    _constants = {parameters.cfl, parameters.fixed_dt, parameters.max_dt,
                  nu > 0.0 ? 1.0 / (nu * diffusive_rate) : std::numeric_limits<double>::infinity(),
                  parameters.max_steps};
    space.fence("drogue::flow::solver: allocated");
  }

  [[nodiscard]] const MacGrid& grid() const { return _grid; }
  [[nodiscard]] const Views& velocity() const { return _velocity; }
  [[nodiscard]] const Views& pressure() const { return _pressure; }
  [[nodiscard]] const char* driver() const { return stepping::driver_name(_launcher.driver()); }

  /// Makes the field in `velocity` (boundary faces and ghost cells are set) the initial state at time 0. Blocks.
  void start(double rate) {
    const ExecutionSpace& space = _instance->space();
    launch_ghosts(space, _grid, _boundary, _velocity);
    auto mirror = Kokkos::create_mirror_view(_control);
    mirror() = Control{};
    mirror().trial.stop = Stop::pause;
    mirror().trial.launches = _loop.launches();
    mirror().first_failure = no_failure;
    mirror().now.rate = Kokkos::bit_cast<std::uint64_t>(rate);
    Kokkos::deep_copy(space, _control, mirror);
    space.fence("drogue::flow::start");
    _loop.status_view()().step = 0;
  }

  Stop advance(double target, std::int64_t pause_step, const Poll& poll) {
    return _loop.advance({target, pause_step}, Steps{*this}, poll);
  }

  /// Enqueues the kernels of one step. Asynchronous.
  void enqueue_step(const ExecutionSpace& space) const {
    const double nu = _parameters.viscosity / _parameters.density;
    MomentumSetup<ExecutionSpace> setup{
        _grid, _velocity, _velocity, _predicted, _rate, _control, nu,
        {_acceleration[0], _acceleration[1], _acceleration[2]}, 1e-40, {}};
    if (_parameters.time_scheme == TimeScheme::ab2) {
      setup.weights = {0.0, 1.0, 1.0, true};
      stage<true>(space, setup, _velocity, 1.0);
    } else {
      setup.weights = {0.0, 1.0, 1.0, false};
      stage<false>(space, setup, _rate, 1.0);
      setup.stage = _rate;
      setup.weights = {0.75, 0.25, 0.25, false};
      stage<false>(space, setup, _rate, 0.25);
      setup.weights = {1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0, false};
      stage<false>(space, setup, _velocity, 2.0 / 3.0);
    }
    Kokkos::parallel_for("drogue::flow::finish_step", one(space),
                         FinishStepFunctor<ExecutionSpace>{_control, _loop.status_view(), _constants});
  }

 private:
  struct Steps {
    FlowSolver& solver;
    void begin(const stepping::AdvanceRequest& request, std::int64_t output_step) {
      Kokkos::parallel_for("drogue::flow::begin_advance", one(solver._instance->space()),
                           BeginAdvanceFunctor<ExecutionSpace>{solver._control, solver._loop.status_view(),
                                                               solver._constants, request, output_step});
    }
    [[nodiscard]] bool holds_many_steps(int) const { return false; }
    void enqueue(int variant, std::int64_t) {
      solver._launcher.launch(variant, [this](const ExecutionSpace& space) { solver.enqueue_step(space); });
    }
  };

  static auto one(const ExecutionSpace& space) { return Kokkos::RangePolicy<ExecutionSpace>(space, 0, 1); }

  template <bool adams_bashforth>
  void stage(const ExecutionSpace& space, const MomentumSetup<ExecutionSpace>& setup, const Views& result,
             double fraction) const {
    switch (_parameters.advection) {
      case Advection::central:
        launch_momentum<Advection::central, adams_bashforth>(space, setup);
        break;
      case Advection::weno_js:
        launch_momentum<Advection::weno_js, adams_bashforth>(space, setup);
        break;
      case Advection::weno_z:
        launch_momentum<Advection::weno_z, adams_bashforth>(space, setup);
        break;
    }
    const ProjectionSetup<ExecutionSpace> projection{_grid, _boundary, _predicted, result, _pressure, _control,
                                                     fraction};
    launch_divergence(space, projection);
    std::visit([&](const auto& poisson) { poisson.enqueue_solve(_pressure); }, *_poisson);
    launch_correction(space, projection);
    launch_ghosts(space, _grid, _boundary, result);
  }

  const device::Instance<ExecutionSpace>* _instance;
  Parameters _parameters;
  MacGrid _grid;
  BoundaryConditions _boundary{};
  StepConstants _constants{};
  std::array<double, 3> _acceleration{};  ///< m/s^2
  Views _velocity, _predicted, _rate, _pressure;
  ControlView<ExecutionSpace> _control;
  std::optional<Poisson> _poisson;
  stepping::StepLoop<ExecutionSpace> _loop;
  stepping::StepLauncher<ExecutionSpace> _launcher;
};

}  // namespace drogue::flow
