#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>

#include "common/program/signals.hpp"
#include "common/study/repeats.hpp"
#include "kernels/flow/solver.hpp"
#include "perf/pressure/pressure.hpp"
#include "perf/problems/streams.hpp"
#include "perf/work_precision/cavity.hpp"
#include "perf/work_precision/flow_scheme.hpp"

namespace drogue::perf {

namespace {

constexpr study::Repeats flow_repeats{20, 0.2};
constexpr double flow_end_time = 1.0;    // s
constexpr double flow_viscosity = 0.01;  // m^2/s

/// Two-dimensional vortices of Taylor and Green in a periodic cube of 2 pi m, which drift with a uniform
/// stream.
struct FlowProblem {
  const char* name;
  double drift[2];  ///< m/s
};

/// The advection of vortices at rest is a gradient, which the pressure balances: errors of time integration
/// vanish. Drifting ones need accurate advection.
constexpr FlowProblem flow_problems[] = {{"drifting-vortices", {1.0, 0.5}}, {"resting-vortices", {0.0, 0.0}}};

/// Velocity along x at a time, m/s.
double exact_velocity(const FlowProblem& problem, double x, double y, double time) {
  const double decay = std::exp(-2.0 * flow_viscosity * time);
  return problem.drift[0] +
         decay * std::sin(x - problem.drift[0] * time) * std::cos(y - problem.drift[1] * time);
}

/// Velocity along y at a time, m/s.
double exact_velocity_y(const FlowProblem& problem, double x, double y, double time) {
  const double decay = std::exp(-2.0 * flow_viscosity * time);
  return problem.drift[1] -
         decay * std::cos(x - problem.drift[0] * time) * std::sin(y - problem.drift[1] * time);
}

/// Values of a velocity component on its faces, m/s: a plane, repeated along z.
std::vector<double> exact_field(const FlowProblem& problem, int n, int component, double time) {
  const double h = 2.0 * std::numbers::pi / n;
  const auto plane = static_cast<std::size_t>(n) * static_cast<std::size_t>(n);
  std::vector<double> values(plane * static_cast<std::size_t>(n), 0.0);
  if (component == 2) return values;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i)
      values[static_cast<std::size_t>(j * n + i)] =
          component == 0 ? exact_velocity(problem, i * h, (j + 0.5) * h, time)
                         : exact_velocity_y(problem, (i + 0.5) * h, j * h, time);
  for (std::size_t i = plane; i < values.size(); ++i) values[i] = values[i - plane];
  return values;
}

flow::Parameters flow_parameters(const FlowScheme& scheme, int n) {
  flow::Parameters p = streams::parameters({n, n, n}, streams::Sides::periodic);
  p.viscosity = flow_viscosity;
  scheme.apply(p);
  return p;
}

/// Numbers of cells per axis. Hosts take minutes on finer grids, and hypre computes on the host everywhere.
std::vector<int> flow_grids(device::Backend backend, const FlowScheme& scheme, bool quick) {
  if (quick) return {16, 32};
  if (scheme.pressure == flow::PressureSolver::hypre_pfmg) return {16, 32, 64};
  return backend == device::Backend::cuda ? std::vector{32, 64, 128, 256} : std::vector{16, 32, 64};
}

/// Solver with the time that it took to the end time in each run.
class FlowRuns {
 public:
  FlowRuns(const FlowProblem& problem, device::Backend backend, const flow::Parameters& p)
      : _solver(flow::create_solver(backend, p)),
        _backend(backend),
        _parameters(p),
        _problem(problem),
        _n(p.cells[0]) {
    for (std::size_t c = 0; c < 3; ++c) _start[c] = exact_field(problem, _n, static_cast<int>(c), 0.0);
  }

  /// Runs from the initial state to the end time and returns the duration, s; negative after a failed step.
  double run() {
    // An iterative solver begins with its last solution. From there it may not converge where the right-hand
    // side is round-off, as that of the first projection is.
    if (_parameters.pressure_solver == flow::PressureSolver::hypre_pfmg)
      _solver = flow::create_solver(_backend, _parameters);
    for (std::size_t c = 0; c < 3; ++c) _solver->upload(static_cast<flow::StateField>(c), _start[c]);
    _solver->start();
    const auto begin = std::chrono::steady_clock::now();
    const flow::Stop stop =
        _solver->advance(flow_end_time, -1, [](const flow::Status&) { return !interrupted(); });
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return stop == flow::Stop::target ? seconds : -1.0;
  }

  /// Largest error of the velocity along x, m/s.
  [[nodiscard]] double error() {
    std::vector<double> u(_start[0].size());
    _solver->download(flow::StateField::velocity_x, u);
    const std::vector<double> truth = exact_field(_problem, _n, 0, flow_end_time);
    double largest = 0.0;
    for (std::size_t i = 0; i < u.size(); ++i) {
      const double error = std::abs(u[i] - truth[i]);
      largest = std::isfinite(error) ? std::max(largest, error) : std::numeric_limits<double>::infinity();
    }
    return largest;
  }

  /// Description of the step that failed.
  [[nodiscard]] std::string failure() {
    const flow::StepFailure failure = _solver->failure();
    return std::string(flow::failure_text(failure.reason)) + " in step " + std::to_string(failure.step);
  }
  [[nodiscard]] std::int64_t steps() { return _solver->progress().step; }
  /// RMS of the divergence, 1/s.
  [[nodiscard]] double divergence() { return _solver->totals().divergence_rms; }

 private:
  std::unique_ptr<flow::Solver> _solver;
  device::Backend _backend;
  flow::Parameters _parameters;
  FlowProblem _problem;
  int _n;
  std::array<std::vector<double>, 3> _start;
};

Solution flow_solution(const FlowProblem& problem, device::Backend backend, const FlowScheme& scheme, int n) {
  Solution s;
  s.problem = problem.name;
  s.backend = backend;
  scheme.describe(s);
  s.cells = n;
  FlowRuns runs(problem, backend, flow_parameters(scheme, n));
  // The first run on a GPU captures the step.
  const bool captures =
      backend == device::Backend::cuda && scheme.pressure != flow::PressureSolver::hypre_pfmg;
  double seconds = captures ? runs.run() : 0.0;
  while (seconds >= 0.0 && !flow_repeats.reached(s.samples))
    if (seconds = runs.run(); seconds >= 0.0) s.samples.push_back(seconds);
  s.steps = runs.steps();
  if (seconds < 0.0) {
    s.samples.clear();
    s.code = ExitCode::numerical_failure;
    s.message = runs.failure();
    return s;
  }
  s.error = runs.error();
  s.sound = std::isfinite(s.error) && runs.divergence() < 1e-6;
  return s;
}

}  // namespace

bool flow_work_precision(const Selection& selection, const SolutionSink& sink) {
  for (const FlowProblem& problem : flow_problems) {
    if (!selection.wants(problem.name)) continue;
    for (const FlowScheme& scheme : flow_schemes(selection.quick))
      for (const device::Backend backend : selection.backends)
        for (const int n : flow_grids(backend, scheme, selection.quick)) {
          const linear::PoissonProblem pressure =
              streams::pressure_problem({n, n, n}, streams::Sides::periodic);
          if (!pressure::is_available(backend, pressure, scheme.pressure)) continue;
          const Solution solution = flow_solution(problem, backend, scheme, n);
          if (interrupted()) return false;
          sink(solution);
        }
  }
  return !selection.wants(cavity_problem) || cavity_work_precision(selection, sink);
}

}  // namespace drogue::perf
