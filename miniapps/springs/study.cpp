#include "miniapps/springs/study.hpp"

#include <algorithm>

#include "common/study/repeats.hpp"
#include "common/study/study.hpp"
#include "kernels/device/ledger.hpp"
#include "miniapps/springs/app.hpp"
#include "miniapps/springs/samples.hpp"
#include "miniapps/springs/simulation.hpp"
#include "miniapps/springs/study_points.hpp"
#include "miniapps/springs/verify.hpp"

namespace drogue::springs_app {
namespace {

constexpr study::Repeats repeats{5, 1.0};
constexpr int samples_by_default = 100;

/// Where the runs write what they are verified by; gone at the end of the study.
class Scratch {
 public:
  explicit Scratch(const std::filesystem::path& study)
      : _path(study / "point"), _directory(_path, run::ExistingRun::overwrite) {}
  ~Scratch() {
    std::error_code ignored;
    std::filesystem::remove_all(_path, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

  [[nodiscard]] run::RunDirectory& directory() { return _directory; }

 private:
  std::filesystem::path _path;
  run::RunDirectory _directory;
};

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

/// One run; the first fills the row. `checks` receives the names of what was verified. Throws Failure.
ExitCode run_once(const SpringsScene& scene, device::Backend backend, const run::RunDirectory& directory,
                  study::Row& row, std::vector<std::string>& checks) {
  const bool first = row.samples.empty();
  RunSettings settings{backend, false, true, {}, {}};
  if (first)
    settings.at_output = [&](const Row& now, const std::vector<fabric::Vector>& x) {
      const auto add = [&row](const char* name, double value) { row.series[name].push_back(value); };
      add("time", now.time);
      add("kinetic", now.kinetic);
      add("elastic", now.elastic);
      if (scene.has_lines()) add("length", total_length(scene.mesh, x));
      if (scene.has_triangles()) add("area", total_area(scene.mesh, x));
    };
  Simulation simulation(scene, settings);
  run::ResultDocument result;
  const ExitCode code = simulation.run(directory, result);
  if (code != ExitCode::ok) return code;
  row.samples.push_back(result.timing.compute_s);
  if (!first) return code;
  row.steps = result.steps;
  verify(scene, simulation.final_state(), directory.file("history.csv"), result);
  row.errors = result.errors;
  for (const run::Check& check : result.checks) checks.push_back(check.name);
  return code;
}

/// False after a signal.
bool run_row(const SpringsScene& scene, device::Backend backend, const run::RunDirectory& directory,
             study::Row& row, std::vector<std::string>& checks) {
  try {
    while (!repeats.reached(row.samples))
      if (run_once(scene, backend, directory, row, checks) == ExitCode::interrupted) return false;
  } catch (const Failure& failure) {
    row.code = failure.code();
    row.message = failure.what();
    row.series.clear();
  }
  return true;
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
  device::start_ledger();
  run::ResultDocument facts = run::new_result("drogue-springs", base.name);
  describe_device(facts, backend);

  Scratch scratch(out);
  study::Columns columns{{"model", "mass", "integrator"}, "vertices", {}, "", ""};
  const auto run_point = [&](std::size_t i, std::vector<study::Row>& rows) {
    const StudyPoint& point = points[i];
    study::Row row;
    row.label = point.label;
    row.settings = {point.model, point.mass, point.integrator};
    row.mesh = static_cast<std::int64_t>(point.scene.mesh.rest.size());
    std::vector<std::string> checks;
    scratch.directory().begin();
    if (!run_row(silent(point.scene), backend, scratch.directory(), row, checks)) return false;
    if (columns.errors.empty() && row.code == ExitCode::ok) {  // what scenes verify is known once one has run
      if (!checks.empty()) columns.shown = columns.shown_title = checks.front();
      columns.errors = checks;
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
