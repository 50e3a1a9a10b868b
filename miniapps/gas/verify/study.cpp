#include "miniapps/gas/verify/study.hpp"

#include <algorithm>
#include <utility>

#include "common/scene/node.hpp"
#include "common/study/axes.hpp"
#include "kernels/gas/host_threads.hpp"
#include "miniapps/framework/run_loop.hpp"
#include "miniapps/gas/simulation/simulation.hpp"

namespace drogue::gas_app {

namespace {

const study::Columns columns = {.settings = {"weno", "weno_power", "splitting", "time_scheme", "precision"},
                                .mesh = "cells",
                                .errors = {"l1_density", "l1_velocity", "l1_pressure", "conservation"},
                                .shown = "l1_density",
                                .shown_title = "L1 density"};

study::Axes parse(const std::string& text) {
  return study::parse_axes(text, {"cells", 8, 28},
                           {{"schemes", {"js", "z", "z2", "m", "teno5"}},
                            {"splittings", {"lf-global", "lf-single", "lf-stencil"}},
                            {"times", {"ssprk3", "ssprk43"}},
                            {"precisions", {"double", "split"}}});
}

/// `--set` assignments of every point of the study. An empty value sets nothing.
std::vector<std::vector<std::string>> assignments(const study::Axes& axes, const MiniAppOptions& options) {
  const auto meshes = axes.meshes.empty() ? std::vector<std::int64_t>{0} : axes.meshes;
  std::vector<std::vector<std::string>> points;
  for (const std::string& scheme : axes.of("schemes"))
    for (const std::string& splitting : axes.of("splittings"))
      for (const std::string& time : axes.of("times"))
        for (const std::string& precision : axes.of("precisions"))
          for (const std::int64_t cells : meshes) {
            std::vector<std::string> sets = options.set;
            const auto set = [&sets](const char* key, const std::string& value) {
              if (!value.empty()) sets.push_back(std::string(key) + "=\"" + value + '"');
            };
            if (cells > 0) sets.push_back("mesh.cells=" + std::to_string(cells));
            set("scheme.weno", scheme == "z2" ? "z" : scheme);
            if (scheme.starts_with('z'))
              sets.push_back(std::string("scheme.weno_power=") + (scheme == "z2" ? "2" : "1"));
            set("scheme.splitting", splitting);
            set("scheme.time", time);
            set("scheme.precision", precision);
            points.push_back(std::move(sets));
          }
  return points;
}

/// Scenes of all points: an invalid one must not end a study that has run for hours.
std::vector<GasScene> scenes_of(const MiniAppOptions& options, const std::filesystem::path& file,
                                const GasScene& base) {
  const study::Axes axes = parse(options.study);
  if (!base.verify.exact)
    throw Failure(ExitCode::usage, "--study needs a scene with [verify] exact, to measure errors against");
  std::vector<GasScene> scenes;
  for (const auto& sets : assignments(axes, options))
    scenes.push_back(read_gas_scene(file, sets, SchemeSource::scene, framework::InitialCheck::some_cells));
  return scenes;
}

study::StudyRow row_of(const gas::Parameters& p, framework::RepeatedRun run) {
  const SchemeNames names = scheme_names(p);
  study::StudyRow row = framework::study_row(std::move(run));
  row.label = names.label;
  row.settings = {names.weno, std::int64_t{p.weno_power}, names.splitting, names.time, names.precision};
  row.mesh = p.cells;
  return row;
}

}  // namespace

SchemeNames scheme_names(const gas::Parameters& p) {
  SchemeNames names;
  names.weno = weno_name(p.weno);
  names.splitting = splitting_name(p.splitting);
  names.time = p.time_scheme == gas::TimeScheme::ssprk3 ? "ssprk3" : "ssprk43";
  names.precision = precision_name(p);
  names.label = names.weno + (p.weno == gas::Weno::z && p.weno_power == 2 ? "2" : "");
  if (names.splitting != "lf-stencil") names.label += " " + names.splitting;
  if (names.time != "ssprk3") names.label += " " + names.time;
  if (names.precision != "double") names.label += " " + names.precision;
  return names;
}

framework::RepeatedRun run_repeatedly(const GasScene& scene, device::Backend backend,
                                      const ExactSolution& exact, const study::Repeats& repeats) {
  GasScene silent = scene;
  silent.output = {};  // steps shortened to meet unwritten outputs would only cost time
  silent.output.restart_every = 0;
  return framework::repeat_run(repeats, [&](framework::RepeatedRun& runs) {
    Simulation simulation(silent, {backend, false, true});
    run::ResultDocument result;
    simulation.start();
    if (framework::run_to_end(simulation, {{}, true, true, {}}, result) == ExitCode::interrupted)
      return ExitCode::interrupted;
    runs.samples.push_back(result.timing.compute_s);
    if (runs.samples.size() > 1) return ExitCode::ok;
    runs.steps = result.steps;
    runs.errors = error_norms(simulation.solver(), silent.parameters, exact);
    runs.others["conservation"] = simulation.conservation();
    return ExitCode::ok;
  });
}

std::string check_study(const MiniAppOptions& options, const std::filesystem::path& file) {
  const std::vector<GasScene> scenes = scenes_of(options, file, read_gas_scene(file, options.set));
  std::int64_t cells = 0;
  for (const GasScene& scene : scenes) cells = std::max(cells, scene.parameters.cells);
  return scene::sentence("study        ", scenes.size(), " runs on up to ", cells, " cells\n");
}

ExitCode run_study(const MiniAppOptions& options, const std::filesystem::path& file) {
  const GasScene base = read_gas_scene(file, options.set);
  const std::vector<GasScene> scenes = scenes_of(options, file, base);
  int threads = 1;
  for (const GasScene& scene : scenes) threads = std::max(threads, gas::host_threads(scene.parameters));
  framework::StudySession session(options, "drogue-gas", base.name, print_gas_scene(base), threads);

  std::optional<Reference> reference = Reference{};
  if (*base.verify.exact == Exact::reference)
    reference = run_reference(base, session.backend(), options.quiet);
  if (!reference) return ExitCode::interrupted;
  const ExactSolution exact = exact_solution(base, base.end_time, *reference);
  const auto run_point = [&](std::size_t i, std::vector<study::StudyRow>& rows) {
    framework::RepeatedRun run = run_repeatedly(scenes[i], session.backend(), exact, {5, 1.0});
    if (run.code == ExitCode::interrupted) return false;
    rows.push_back(row_of(scenes[i].parameters, std::move(run)));
    return true;
  };
  return session.run(columns, scenes.size(), run_point);
}

}  // namespace drogue::gas_app
