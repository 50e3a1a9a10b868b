#include "miniapps/springs/verify/study.hpp"

#include <algorithm>
#include <cmath>

#include "common/scene/node.hpp"
#include "kernels/fabric/host_threads.hpp"
#include "miniapps/framework/run_loop.hpp"
#include "miniapps/springs/simulation/simulation.hpp"
#include "miniapps/springs/verify/samples.hpp"
#include "miniapps/springs/verify/study_points.hpp"

namespace drogue::springs_app {
namespace {

constexpr study::Repeats repeats{5, 1.0};
constexpr int samples_by_default = 100;

/// Copy of a scene without fields, whose steps meet the sample times.
SpringsScene silent(SpringsScene scene) {
  Output& output = scene.output;
  output.fields.clear();
  output.restart_every = 0;
  if (output.times.empty() && scene.time.end_time > 0.0)
    for (int k = 0; k <= samples_by_default; ++k)
      output.times.push_back(scene.time.end_time * k / samples_by_default);
  return scene;
}

/// Adds the distance of `coarse` from `fine`, the next finer mesh of its scheme.
void add_cauchy(study::StudyRow& coarse, const study::StudyRow& fine) {
  for (const auto& [name, values] : coarse.series)
    if (name != "time")
      coarse.errors["cauchy_" + name] =
          mean_difference(coarse.series.at("time"), values, fine.series.at(name));
}

/// One run; the first fills in everything but the samples. Throws `Failure`.
ExitCode run_once(const SpringsScene& scene, device::Backend backend, const run::RunDirectory& directory,
                  framework::RepeatedRun& runs) {
  const bool first = runs.samples.empty();
  Simulation simulation(scene, {backend, false, true});
  framework::RunRequest request;
  request.files.directory = directory.path();
  request.files.title = scene.name;
  request.quiet = true;
  request.keeps_restart = false;
  if (first)
    request.at_output = [&] {
      const auto add = [&runs](const char* name, double value) { runs.series[name].push_back(value); };
      const StateTotals totals = simulation.totals();
      const std::vector<fabric::Vector> x = simulation.positions();
      add("time", simulation.now().time);
      add("kinetic", totals.kinetic);
      add("elastic", totals.elastic);
      if (scene.has_lines()) add("length", total_length(scene.mesh, x));
      if (scene.has_triangles()) add("area", total_area(scene.mesh, x));
    };
  run::ResultDocument result;
  simulation.start();
  const ExitCode code = framework::run_to_end(simulation, request, result);
  if (code != ExitCode::ok) return code;
  runs.samples.push_back(result.timing.compute_s);
  if (!first) return code;
  runs.steps = result.steps;
  simulation.verify(&directory, result);
  for (const auto& [name, error] : result.errors)
    if (!std::isfinite(error))
      throw Failure(ExitCode::verification_failed,
                    "verify." + name + " has no finite value on this mesh" +
                        (scene.output.probes.empty() ? "" : ": a probe may be at a pinned vertex"));
  runs.errors = result.errors;
  for (const run::Check& check : result.checks) runs.checks.push_back(check.name);
  return code;
}

/// Columns of study.csv, complete once a run has shown what its scene verifies.
void complete_columns(study::Columns& columns, const framework::RepeatedRun& runs) {
  if (!columns.errors.empty() || runs.code != ExitCode::ok) return;
  if (!runs.checks.empty()) columns.shown = columns.shown_title = runs.checks.front();
  columns.errors = runs.checks;
  for (const auto& [name, values] : runs.series)
    if (name != "time") columns.errors.push_back("cauchy_" + name);
}

}  // namespace

ScratchDirectory::ScratchDirectory(const std::filesystem::path& folder)
    : _folder(folder), _directory(folder, run::ExistingRun::overwrite) {}

ScratchDirectory::~ScratchDirectory() {
  std::error_code ignored;
  std::filesystem::remove_all(_folder, ignored);
}

framework::RepeatedRun run_repeatedly(const SpringsScene& scene, device::Backend backend,
                                      const study::Repeats& repeats, ScratchDirectory& scratch) {
  scratch.directory().begin();
  return framework::repeat_run(repeats, [&](framework::RepeatedRun& runs) {
    return run_once(scene, backend, scratch.directory(), runs);
  });
}

std::string check_study(const MiniAppOptions& options, const std::filesystem::path& file) {
  constexpr std::int64_t most = 65536;
  const std::vector<StudyPoint> points = study_points(file, options.set, options.study, most);
  if (const std::int64_t largest = largest_study_mesh(options.study); largest > most)
    return scene::sentence("study        on up to ", largest, " vertices; a mesh of more than ", most,
                           " is checked with so many\n");
  std::size_t largest = 0;
  for (const StudyPoint& point : points) largest = std::max(largest, point.scene.mesh.rest.size());
  return scene::sentence("study        ", points.size(), " runs on up to ", largest, " vertices\n");
}

ExitCode run_study(const MiniAppOptions& options, const std::filesystem::path& file) {
  const SpringsScene base = read_springs_scene(file, options.set);
  // Read all first: an invalid scene must not end a study that has run for hours.
  const std::vector<StudyPoint> points = study_points(file, options.set, options.study);
  int threads = 1;
  for (const StudyPoint& point : points)
    threads = std::max(threads, fabric::host_threads(point.scene.mesh.rest.size()));
  framework::StudySession session(options, "drogue-springs", base.name, print_springs_scene(base), threads);
  ScratchDirectory scratch(session.directory().path() / "point");
  study::Columns columns{.settings = {"model", "mass", "integrator"},
                         .mesh = "vertices",
                         .errors = {},
                         .shown = "",
                         .shown_title = ""};
  const auto run_point = [&](std::size_t i, std::vector<study::StudyRow>& rows) {
    const StudyPoint& point = points[i];
    framework::RepeatedRun runs = run_repeatedly(silent(point.scene), session.backend(), repeats, scratch);
    if (runs.code == ExitCode::interrupted) return false;
    complete_columns(columns, runs);
    study::StudyRow row = framework::study_row(std::move(runs));
    row.label = point.label;
    row.settings = {point.model, point.mass, point.integrator};
    row.mesh = static_cast<std::int64_t>(point.scene.mesh.rest.size());
    rows.push_back(std::move(row));
    if (rows.size() < 2) return true;
    study::StudyRow &coarse = rows[rows.size() - 2], &fine = rows.back();
    if (coarse.label == fine.label && coarse.code == ExitCode::ok && fine.code == ExitCode::ok)
      add_cauchy(coarse, fine);
    return true;
  };
  return session.run(columns, points.size(), run_point);
}

}  // namespace drogue::springs_app
