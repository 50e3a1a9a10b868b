#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "common/program/signals.hpp"
#include "miniapps/springs/verify/study.hpp"
#include "miniapps/springs/verify/study_points.hpp"
#include "perf/work_precision/solution.hpp"

namespace drogue::perf {

namespace {

constexpr study::Repeats springs_repeats{10, 0.2};

struct SpringsProblem {
  const char* scene;
  const char* check;         ///< name of the check whose error is recorded
  std::string axes;          ///< argument of `drogue-springs --study`
  std::size_t most_on_host;  ///< number of vertices; a core takes minutes for larger meshes
};

const std::string of_strings = ",masses=area:equal,integrators=rk4:verlet";
/// Models of edge springs lack a closed form of the drum's tension and the Poisson ratio of Hencky's problem.
const std::string of_cloth = ",models=quadratic:biquadratic" + of_strings;

const std::vector<SpringsProblem> springs_problems = {
    {"drum", "frequency", "meshes=61:217:817:3169:12481" + of_cloth, 20'000},
    {"hencky", "hencky", "meshes=61:217:817:3169:12481" + of_cloth, 4'000},
    {"catenary", "catenary", "meshes=7:13:26:51:101:201" + of_strings, 20'000}};
const std::vector<SpringsProblem> quick_springs_problems = {
    {"drum", "frequency", "meshes=61:122" + of_cloth, 20'000},
    {"catenary", "catenary", "meshes=13:26" + of_strings, 20'000}};

/// Scene without outputs, whose times would shorten steps. Probes record equally many rows on every mesh,
/// because the time step is proportional to the edge length.
springs_app::SpringsScene silent_scene(springs_app::SpringsScene scene) {
  scene.output.fields.clear();
  scene.output.times.clear();
  const double edges = std::sqrt(static_cast<double>(scene.mesh.rest.size()));
  scene.output.history_every = scene.verify.frequency ? static_cast<int>(std::lround(0.5 * edges)) : 0;
  return scene;
}

Solution springs_solution(const SpringsProblem& problem, device::Backend backend,
                          const springs_app::StudyPoint& point, const framework::RepeatedRun& run) {
  Solution s = solution_of(run, problem.check);
  s.problem = problem.scene;
  s.backend = backend;
  s.label = point.label;
  s.scheme = {{"model", point.model}, {"mass", point.mass}, {"integrator", point.integrator}};
  s.cells = static_cast<std::int64_t>(point.scene.mesh.rest.size());
  return s;
}

}  // namespace

bool springs_work_precision(const Selection& selection, const SolutionSink& sink) {
  springs_app::ScratchDirectory scratch(std::filesystem::temp_directory_path() /
                                        ("drogue-perf-" + std::to_string(getpid())));
  for (const SpringsProblem& problem : selection.quick ? quick_springs_problems : springs_problems) {
    if (!selection.wants(problem.scene)) continue;
    const auto file = springs_app::scene_folder() / (std::string(problem.scene) + ".toml");
    for (const springs_app::StudyPoint& point : springs_app::study_points(file, {}, problem.axes))
      for (const device::Backend backend : selection.backends) {
        const bool host = backend != device::Backend::cuda;
        if (host && point.scene.mesh.rest.size() > problem.most_on_host) continue;
        const framework::RepeatedRun run =
            run_repeatedly(silent_scene(point.scene), backend, springs_repeats, scratch);
        if (run.code == ExitCode::interrupted || interrupted()) return false;
        sink(springs_solution(problem, backend, point, run));
      }
  }
  return true;
}

}  // namespace drogue::perf
