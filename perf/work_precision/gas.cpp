#include "common/program/signals.hpp"
#include "common/program/stopwatch.hpp"
#include "kernels/reference/gas/muscl_hancock.hpp"
#include "miniapps/gas/verify/study.hpp"
#include "perf/work_precision/solution.hpp"

namespace drogue::perf {

namespace {

struct Problem {
  const char* scene;
  std::int64_t coarsest;
  int meshes;  ///< each with twice the cells of the previous one
};

const std::vector<Problem> problems = {
    {"entropy-wave", 20, 5}, {"sod", 100, 5}, {"leblanc", 100, 5}, {"shu-osher", 100, 5}, {"blast", 100, 5}};
const std::vector<Problem> quick_problems = {{"entropy-wave", 20, 2}, {"sod", 50, 2}};

constexpr study::Repeats repeats{20, 0.2};

std::vector<gas::Parameters> schemes(gas::Parameters p, bool quick) {
  using enum gas::Splitting;
  // These settings of the scenes serve their tolerances; the benchmark uses the same ones for all.
  p.fixed_dt = 0.0;
  p.positivity = gas::Positivity::automatic;
  p.weno_power = 1;
  std::vector<gas::Parameters> all;
  for (const gas::Weno weno : {gas::Weno::js, gas::Weno::z, gas::Weno::m, gas::Weno::teno5})
    for (const gas::Splitting splitting : {lf_stencil, lf_global, lf_single})
      for (const gas::TimeScheme time : {gas::TimeScheme::ssprk3, gas::TimeScheme::ssprk43})
        for (const gas::Precision precision : {gas::Precision::full, gas::Precision::split}) {
          if (quick && (splitting != lf_stencil || time != gas::TimeScheme::ssprk3)) continue;
          p.weno = weno, p.splitting = splitting, p.time_scheme = time, p.precision = precision;
          p.cfl = time == gas::TimeScheme::ssprk3 ? 0.6 : 1.2;
          all.push_back(p);
        }
  return all;
}

/// Comparison scheme at CFL 0.8, timed as the solvers: from the initial state in memory to the end time.
framework::RepeatedRun muscl_hancock_run(const gas_app::GasScene& scene,
                                         const gas_app::ExactSolution& exact) {
  gas::Parameters p = scene.parameters;
  p.cfl = 0.8;
  const gas_app::InitialState initial(scene);
  const reference::GasRun start = reference::start_run(p, [&](double x) {
    const gas_app::Primitive w = initial(x);
    return reference::Primitive{w.rho, w.u, w.p};
  });
  framework::RepeatedRun runs;
  while (!repeats.reached(runs.samples)) {
    reference::GasRun run = start;
    const Stopwatch stopwatch;
    reference::muscl_hancock(run, p, scene.end_time);
    runs.samples.push_back(stopwatch.seconds());
    if (run.failed) {
      framework::RepeatedRun failed;
      failed.code = ExitCode::numerical_failure;
      failed.message = "a state is not physical";
      return failed;
    }
    runs.steps = run.steps;
    runs.errors["l1_density"] = reference::l1_density(run, p, [&](double x) { return exact(x).rho; });
  }
  return runs;
}

Solution gas_solution(const Problem& problem, device::Backend backend, const gas_app::SchemeNames& scheme,
                      int weno_power, std::int64_t cells, framework::RepeatedRun run) {
  Solution s = solution_of(run, "l1_density");
  s.problem = problem.scene;
  s.backend = backend;
  s.label = scheme.label;
  s.scheme = {{"weno", scheme.weno},
              {"weno_power", weno_power},
              {"splitting", scheme.splitting},
              {"time_scheme", scheme.time},
              {"precision", scheme.precision}};
  s.cells = cells;
  s.sound = s.sound && run.others["conservation"] <= 1e-11;
  return s;
}

}  // namespace

bool gas_work_precision(const Selection& selection, const SolutionSink& sink) {
  const std::vector<device::Backend>& backends = selection.backends;
  for (const Problem& problem : selection.quick ? quick_problems : problems) {
    if (!selection.wants(problem.scene)) continue;
    gas_app::GasScene scene =
        gas_app::read_gas_scene(gas_app::scene_folder() / (std::string(problem.scene) + ".toml"));
    std::optional<gas_app::Reference> finer = gas_app::Reference{};
    if (*scene.verify.exact == gas_app::Exact::reference) finer = run_reference(scene, backends.back(), true);
    if (!finer) return false;
    const gas_app::ExactSolution exact = exact_solution(scene, scene.end_time, *finer);
    for (int mesh = 0; mesh < problem.meshes; ++mesh) {
      scene.parameters.cells = problem.coarsest << mesh;
      sink(gas_solution(problem, device::Backend::serial,
                        {"muscl-hancock", "muscl-hancock", "", "", "double"}, 1, scene.parameters.cells,
                        muscl_hancock_run(scene, exact)));
      for (const gas::Parameters& p : schemes(scene.parameters, selection.quick))
        for (const device::Backend backend : backends) {
          gas_app::GasScene point = scene;
          point.parameters = p;
          framework::RepeatedRun run = run_repeatedly(point, backend, exact, repeats);
          if (run.code == ExitCode::interrupted || interrupted()) return false;
          sink(gas_solution(problem, backend, gas_app::scheme_names(p), p.weno_power, p.cells,
                            std::move(run)));
        }
    }
  }
  return true;
}

}  // namespace drogue::perf
