#include "perf/work_precision/cavity.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "common/program/signals.hpp"
#include "miniapps/parachute/verify/study.hpp"
#include "perf/pressure/pressure.hpp"
#include "perf/problems/streams.hpp"
#include "perf/work_precision/flow_scheme.hpp"

namespace drogue::perf {

namespace {

constexpr study::Repeats cavity_repeats{5, 0.2};

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

}  // namespace

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
        framework::RepeatedRun run = run_cavity(scene, backend);
        if (run.code == ExitCode::interrupted || interrupted()) return false;
        Solution s;
        s.problem = cavity_problem;
        s.backend = backend;
        scheme.describe(s);
        s.cells = n;
        s.samples = std::move(run.samples);
        s.steps = run.steps;
        s.code = run.code;
        s.message = std::move(run.message);
        if (s.code == ExitCode::ok) s.error = run.errors.at("extreme");
        s.sound = s.code == ExitCode::ok && std::isfinite(s.error) && run.others.at("divergence") < 1e-6;
        sink(s);
      }
  }
  return true;
}

}  // namespace drogue::perf
