#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "common/program/signals.hpp"
#include "common/program/stopwatch.hpp"
#include "kernels/flow/solver.hpp"
#include "miniapps/parachute/verify/study.hpp"
#include "perf/pressure/pressure.hpp"
#include "perf/problems/streams.hpp"
#include "perf/work_precision/solution.hpp"

namespace drogue::perf {

namespace {

/// Scheme of a flow solver: a curve of a work-precision diagram.
struct FlowScheme {
  flow::Advection advection;
  flow::TimeScheme time;
  flow::PressureSolver pressure;
  flow::Diffusion diffusion;

  /// Sets the scheme, and the CFL number: 0.5 with AB2, 1 with RK3, which is stable with longer steps.
  void apply(flow::Parameters& p) const {
    p.advection = advection;
    p.time_scheme = time;
    p.pressure_solver = pressure;
    p.diffusion = diffusion;
  }

  /// Sets the label of a solution and the facts of its record.
  void describe(Solution& s) const;
};

void FlowScheme::describe(Solution& s) const {
  const std::string advection_name = parachute_app::name_of(advection),
                    time_name = parachute_app::name_of(time),
                    diffusion_name = parachute_app::name_of(diffusion),
                    pressure_name = parachute_app::name_of(pressure);
  s.label = advection_name + " " + time_name + " " + pressure_name;
  if (diffusion_name != "explicit") s.label += " " + diffusion_name;
  s.scheme = {{"advection", advection_name},
              {"time_scheme", time_name},
              {"pressure", pressure_name},
              {"diffusion", diffusion_name}};
}

/// All combinations of advection, time scheme and direct pressure solver, implicit diffusion with AB2, and
/// hypre with WENO-Z. `quick` selects WENO-Z, the central scheme and transforms.
std::vector<FlowScheme> flow_schemes(bool quick) {
  using enum flow::PressureSolver;
  std::vector<FlowScheme> schemes;
  for (const flow::Advection advection :
       {flow::Advection::weno_z, flow::Advection::weno_js, flow::Advection::central})
    for (const flow::PressureSolver pressure : {fft, diagonalization, hypre_pfmg}) {
      if (quick && (advection == flow::Advection::weno_js || pressure != fft)) continue;
      // Slow, and its errors are those of the others.
      if (pressure == hypre_pfmg && advection != flow::Advection::weno_z) continue;
      for (const flow::TimeScheme time : {flow::TimeScheme::ab2, flow::TimeScheme::rk3})
        schemes.push_back({advection, time, pressure, flow::Diffusion::explicit_});
      // Implicit diffusion never takes an iterative solver.
      if (pressure != hypre_pfmg)
        schemes.push_back({advection, flow::TimeScheme::ab2, pressure, flow::Diffusion::crank_nicolson});
    }
  return schemes;
}

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

/// Values of a velocity component on its faces at a time, m/s: a plane, repeated along z.
std::vector<double> exact_field(const FlowProblem& problem, int n, int component, double time) {
  const double h = 2.0 * std::numbers::pi / n, decay = std::exp(-2.0 * flow_viscosity * time);
  const auto plane = static_cast<std::size_t>(n) * static_cast<std::size_t>(n);
  std::vector<double> values(plane * static_cast<std::size_t>(n), 0.0);
  if (component == 2) return values;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const double x = (component == 0 ? i : i + 0.5) * h - problem.drift[0] * time,
                   y = (component == 0 ? j + 0.5 : j) * h - problem.drift[1] * time;
      values[static_cast<std::size_t>(j * n + i)] =
          component == 0 ? problem.drift[0] + decay * std::sin(x) * std::cos(y)
                         : problem.drift[1] - decay * std::cos(x) * std::sin(y);
    }
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

/// Largest difference of the values, infinite unless all are finite.
double largest_difference(const std::vector<double>& values, const std::vector<double>& truth) {
  double largest = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double error = std::abs(values[i] - truth[i]);
    largest = std::isfinite(error) ? std::max(largest, error) : std::numeric_limits<double>::infinity();
  }
  return largest;
}

Solution vortex_solution(const FlowProblem& problem, device::Backend backend, const FlowScheme& scheme,
                         int n) {
  const bool iterates = scheme.pressure == flow::PressureSolver::hypre_pfmg;
  const flow::Parameters p = flow_parameters(scheme, n);
  std::unique_ptr<flow::Solver> solver = flow::create_solver(backend, p);
  std::array<std::vector<double>, 3> start;
  for (std::size_t c = 0; c < 3; ++c) start[c] = exact_field(problem, n, static_cast<int>(c), 0.0);
  // Duration of a run from the initial state to the end time, s; negative after a failed step.
  const auto run = [&] {
    // An iterative solver begins with its last solution. From there it may not converge where the right-hand
    // side is round-off, as that of the first projection is.
    if (iterates) solver = flow::create_solver(backend, p);
    for (std::size_t c = 0; c < 3; ++c) solver->upload(flow::velocity_name(c), start[c]);
    solver->start();
    const Stopwatch stopwatch;
    const flow::Stop stop =
        solver->advance(flow_end_time, -1, [](const flow::Status&) { return !interrupted(); });
    const double seconds = stopwatch.seconds();
    return stop == flow::Stop::target ? seconds : -1.0;
  };
  Solution s;
  s.problem = problem.name;
  s.backend = backend;
  scheme.describe(s);
  s.cells = n;
  // The first run on a GPU captures the step.
  double seconds = backend == device::Backend::cuda && !iterates ? run() : 0.0;
  while (seconds >= 0.0 && !flow_repeats.reached(s.samples))
    if (seconds = run(); seconds >= 0.0) s.samples.push_back(seconds);
  s.steps = solver->progress().step;
  if (seconds < 0.0) {
    const flow::StepFailure failure = solver->failure();
    s.samples.clear();
    s.code = ExitCode::numerical_failure;
    s.message = std::string(flow::failure_text(failure.reason)) + " in step " + std::to_string(failure.step);
    return s;
  }
  std::vector<double> u(start[0].size());
  solver->download("velocity_x", u);
  s.error = largest_difference(u, exact_field(problem, n, 0, flow_end_time));
  s.sound = std::isfinite(s.error) && solver->totals().divergence_rms < 1e-6;
  return s;
}

constexpr study::Repeats cavity_repeats{5, 0.2};

/// Name of the problem and of the shipped scene.
constexpr const char* cavity_problem = "cavity";

/// Largest deviation of an extreme velocity on a centre line from that of Marchi, Suero and Araki 2009, m/s.
/// The deviations of places and of single points are checks of the scene only.
double largest_deviation(const run::ResultDocument& result) {
  double largest = 0.0;
  for (const run::Check& check : result.checks)
    if ((check.name.ends_with("_minimum") || check.name.ends_with("_maximum")) && !(check.value <= largest))
      largest = check.value;
  return largest;
}

framework::RepeatedRun run_cavity(const parachute_app::FlowScene& scene, device::Backend backend) {
  return parachute_app::repeat_scene(
      scene, backend, cavity_repeats, [](parachute_app::Simulation& simulation, run::ResultDocument& result) {
        simulation.verify(nullptr, result);
        return std::map<std::string, double>{{"extreme", largest_deviation(result)}};
      });
}

/// Cells per axis. Explicit diffusion takes a number of steps that grows with the square.
std::vector<int> cavity_grids(device::Backend backend, const FlowScheme& scheme, bool quick) {
  if (quick) return {16, 32};
  const bool transforms = scheme.pressure == flow::PressureSolver::fft;
  if (backend == device::Backend::cuda) return {16, 32, 64, 128};
  return transforms ? std::vector{16, 32, 64} : std::vector{16, 32};
}

bool cavity_work_precision(const Selection& selection, const SolutionSink& sink) {
  const parachute_app::FlowScene shipped =
      parachute_app::read_flow_scene(parachute_app::scene_folder() / (std::string(cavity_problem) + ".toml"));
  for (const FlowScheme& scheme : flow_schemes(selection.quick)) {
    // Its errors are those of the others, and a run is some ten thousand solves.
    if (scheme.pressure == flow::PressureSolver::hypre_pfmg) continue;
    for (const device::Backend backend : selection.backends)
      for (const int n : cavity_grids(backend, scheme, selection.quick)) {
        const std::array<int, 3> cells = {n, n, 1};
        if (!pressure::is_available(backend, streams::pressure_problem(cells, streams::Sides::walls),
                                    scheme.pressure))
          continue;
        parachute_app::FlowScene scene = shipped;
        scene.parameters.cells = cells;
        scene.output = {};
        scheme.apply(scene.parameters);
        // Neither implicit diffusion nor fluid at rest limits the first step. The lid crosses a cell of 1/n m
        // at 1 m/s.
        if (scheme.diffusion == flow::Diffusion::crank_nicolson) scene.parameters.max_dt = 0.5 / n;
        const framework::RepeatedRun run = run_cavity(scene, backend);
        if (run.code == ExitCode::interrupted || interrupted()) return false;
        Solution s = solution_of(run, "extreme");
        s.problem = cavity_problem;
        s.backend = backend;
        scheme.describe(s);
        s.cells = n;
        s.sound = s.sound && run.others.at("divergence") < 1e-6;
        sink(s);
      }
  }
  return true;
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
          const Solution solution = vortex_solution(problem, backend, scheme, n);
          if (interrupted()) return false;
          sink(solution);
        }
  }
  return !selection.wants(cavity_problem) || cavity_work_precision(selection, sink);
}

}  // namespace drogue::perf
