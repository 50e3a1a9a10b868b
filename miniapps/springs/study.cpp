#include "miniapps/springs/study.hpp"

#include <algorithm>

#include "common/study/study.hpp"
#include "kernels/device/profiling_counters.hpp"
#include "miniapps/springs/app.hpp"
#include "miniapps/springs/repeated_run.hpp"
#include "miniapps/springs/samples.hpp"
#include "miniapps/springs/simulation.hpp"
#include "miniapps/springs/study_points.hpp"

namespace drogue::springs_app {
namespace {

constexpr study::Repeats repeats{5, 1.0};
constexpr int samples_by_default = 100;

/// Writes no fields; its steps meet the times of its samples.
SpringsScene silent(SpringsScene scene) {
  Output& output = scene.output;
  output.fields.clear();
  output.restart_every = 0;
  if (output.times.empty() && scene.time.end_time > 0.0)
    for (int k = 0; k <= samples_by_default; ++k)
      output.times.push_back(scene.time.end_time * k / samples_by_default);
  return scene;
}

/// How far `coarse` is from `fine`, the next finer mesh of its scheme.
void add_cauchy(study::Row& coarse, const study::Row& fine) {
  for (const auto& [name, values] : coarse.series)
    if (name != "time")
      coarse.errors["cauchy_" + name] =
          mean_difference(coarse.series.at("time"), values, fine.series.at(name));
}

}  // namespace

ExitCode run_study(const MiniAppOptions& options, const std::filesystem::path& file) {
  const SpringsScene base = read_springs_scene(file, options.set);
  // All of them, so that none is found wrong after others have run.
  const std::vector<StudyPoint> points = study_points(file, options.set, options.study);
  const device::Backend backend = choose_backend(options.backend);
  const std::filesystem::path out =
      options.out.empty() ? std::filesystem::path("out") / (base.name + "-study") : options.out;
  run::RunDirectory directory(out,
                              options.overwrite ? run::ExistingRun::overwrite : run::ExistingRun::refuse);
  directory.begin();
  directory.write_scene(print_springs_scene(base));
  const auto runtime = start_kokkos(options.kokkos);
  device::start_profiling();
  run::ResultDocument facts = run::new_result("drogue-springs", base.name);
  facts.describe_device(std::string(device::name(backend)), device::device_facts());

  Scratch scratch(out / "point");
  study::Columns columns{{"model", "mass", "integrator"}, "vertices", {}, "", ""};
  const auto run_point = [&](std::size_t i, std::vector<study::Row>& rows) {
    const StudyPoint& point = points[i];
    study::Row row;
    row.label = point.label;
    row.settings = {point.model, point.mass, point.integrator};
    row.mesh = static_cast<std::int64_t>(point.scene.mesh.rest.size());
    RepeatedRun runs = run_repeatedly(silent(point.scene), backend, repeats, scratch);
    if (runs.code == ExitCode::interrupted) return false;
    row.samples = std::move(runs.samples);
    row.steps = runs.steps;
    row.errors = std::move(runs.errors);
    row.series = std::move(runs.series);
    row.code = runs.code;
    row.message = runs.message;
    if (columns.errors.empty() && row.code == ExitCode::ok) {  // what scenes verify is known once one has run
      if (!runs.checks.empty()) columns.shown = columns.shown_title = runs.checks.front();
      columns.errors = runs.checks;
      for (const auto& [name, values] : row.series)
        if (name != "time") columns.errors.push_back("cauchy_" + name);
    }
    rows.push_back(std::move(row));
    if (rows.size() < 2) return true;
    study::Row &coarse = rows[rows.size() - 2], &fine = rows.back();
    if (coarse.label == fine.label && coarse.code == ExitCode::ok && fine.code == ExitCode::ok)
      add_cauchy(coarse, fine);
    return true;
  };
  return study::run_points(directory, facts, columns, points.size(), run_point, options.quiet);
}

}  // namespace drogue::springs_app
