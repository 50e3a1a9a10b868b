#include "miniapps/parachute/verify/study.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/program/failure.hpp"
#include "common/scene/node.hpp"
#include "common/study/axes.hpp"
#include "kernels/flow/host_threads.hpp"
#include "miniapps/framework/ensemble.hpp"
#include "miniapps/framework/run_loop.hpp"
#include "miniapps/parachute/scene/run_size.hpp"
#include "miniapps/parachute/simulation/simulation.hpp"
#include "miniapps/parachute/verify/ensemble.hpp"

namespace drogue::parachute_app {
namespace {

const study::Columns columns = {.settings = {"advection", "time_scheme", "diffusion", "pressure"},
                                .mesh = "cells",
                                .errors = {"l1_velocity", "l2_velocity", "linf_velocity", "l2_pressure",
                                           "order_l2_velocity", "order_l2_pressure", "divergence"},
                                .shown = "l2_velocity",
                                .shown_title = "L2 velocity"};

const std::vector<study::WordAxis> word_axes = {
    {"advections", {"central", "weno-js", "weno-z"}},
    {"times", {"ab2", "rk3"}},
    {"diffusions", {"explicit", "crank-nicolson"}},
    {"pressures", {"auto", "fft", "diagonalization", "hypre-pfmg"}}};

/// Cells along the longest axis.
int longest(const flow::Parameters& p) { return *std::ranges::max_element(p.cells); }

/// `--set` of the grid with `cells` along its longest axis and nearly the proportions of the scene. Axes with
/// more than one cell keep at least the number that a solver needs. Of a grid with a core, the width of its
/// cells is scaled, so that the number of cells is nearly that. Throws `Failure` (usage) for given faces.
std::string scaled_grid(const FlowScene& scene, std::int64_t cells) {
  const flow::Parameters& p = scene.parameters;
  if (scene.faces) throw Failure(ExitCode::usage, "--study with meshes needs grid.cells or grid.core");
  std::string list;
  if (scene.core) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double scale = p.cells[axis] == 1 ? 1.0 : longest(p) / static_cast<double>(cells);
      list += (list.empty() ? "[" : ", ") + scene::real_text(scene.spacing[axis] * scale);
    }
    return "grid.spacing=" + list + "]";
  }
  for (const int n : p.cells) {
    const double scaled = static_cast<double>(n) * static_cast<double>(cells) / longest(p);
    const std::int64_t rounded = n == 1 ? 1 : std::max<std::int64_t>(std::llround(scaled), 4);
    list += (list.empty() ? "[" : ", ") + std::to_string(rounded);
  }
  return "grid.cells=" + list + "]";
}

/// Assignments of one point, without those of the command line. An empty value keeps that of the scene.
std::vector<std::string> point_of(const FlowScene& base, const std::string& advection,
                                  const std::string& time, const std::string& diffusion,
                                  const std::string& pressure, std::int64_t cells) {
  std::vector<std::string> sets;
  const bool is_weno = advection.starts_with("weno-");
  const std::pair<const char*, std::string> values[] = {{"advection", is_weno ? "weno5" : advection},
                                                        {"weno", is_weno ? advection.substr(5) : ""},
                                                        {"time", time},
                                                        {"diffusion", diffusion},
                                                        {"pressure", pressure}};
  for (const auto& [key, value] : values)
    if (!value.empty()) sets.push_back(std::string("flow.") + key + "=\"" + value + "\"");
  if (cells > 0) sets.push_back(scaled_grid(base, cells));
  return sets;
}

/// Scene of a point. Throws `Failure` (usage), which names --study, if the point is invalid.
FlowScene scene_of(const std::filesystem::path& file, const MiniAppOptions& options,
                   const std::vector<std::string>& point) {
  std::vector<std::string> sets = options.set;
  sets.insert(sets.end(), point.begin(), point.end());
  try {
    return read_flow_scene(file, sets, SchemeSource::scene, framework::InitialCheck::some_cells);
  } catch (const Failure& failure) {
    std::string reason = failure.what(), values;
    for (const std::string& assignment : point) {
      values += (values.empty() ? "" : ", ") + assignment;
      // The user gave no such option.
      const std::string option = "--set " + assignment + ": ";
      if (reason.starts_with(option)) reason.erase(0, option.size());
    }
    throw Failure(ExitCode::usage, "--study " + options.study + " (" + values + "): " + reason);
  }
}

/// Scenes of all points: an invalid one must not end a study that has run for hours.
std::vector<FlowScene> scenes_of(const MiniAppOptions& options, const std::filesystem::path& file,
                                 const FlowScene& base) {
  const study::Axes axes = study::parse_axes(options.study, {"cells", 4, 12}, word_axes);
  if (!base.verify.exact) throw Failure(ExitCode::usage, "--study needs verify.exact to compute errors");
  std::vector<std::int64_t> meshes = axes.meshes;
  if (meshes.empty()) meshes.push_back(0);
  std::vector<FlowScene> scenes;
  for (const std::string& advection : axes.of("advections"))
    for (const std::string& time : axes.of("times"))
      for (const std::string& diffusion : axes.of("diffusions"))
        for (const std::string& pressure : axes.of("pressures"))
          for (const std::int64_t cells : meshes) {
            FlowScene scene =
                scene_of(file, options, point_of(base, advection, time, diffusion, pressure, cells));
            scene.output = {};  // steps shortened to meet outputs that are not written would only cost time
            scenes.push_back(std::move(scene));
          }
  return scenes;
}

bool is_ensemble(const MiniAppOptions& options) {
  return study::is_ensemble(options.study, study::names_of(word_axes));
}

framework::RepeatedRun run_point(const FlowScene& scene, device::Backend backend) {
  return repeat_scene(scene, backend, {3, 1.0},
                      [](Simulation& simulation, run::ResultDocument&) { return simulation.error_norms(); });
}

study::StudyRow row_of(const FlowScene& scene, framework::RepeatedRun runs) {
  const flow::Parameters& p = scene.parameters;
  const std::string advection = name_of(p.advection), time = name_of(p.time_scheme),
                    diffusion = name_of(p.diffusion), pressure = name_of(p.pressure_solver);
  study::StudyRow row = framework::study_row(std::move(runs));
  row.settings = {advection, time, diffusion, pressure};
  row.label = advection + " " + time;
  if (diffusion != "explicit") row.label += " " + diffusion;
  if (pressure != "auto") row.label += " " + pressure;
  row.mesh = longest(p);
  return row;
}

/// Adds the observed orders between `row` and `coarser`.
void add_orders(const study::StudyRow& coarser, study::StudyRow& row) {
  if (coarser.label != row.label || coarser.mesh >= row.mesh) return;
  const double refinement = static_cast<double>(row.mesh) / static_cast<double>(coarser.mesh);
  for (const char* name : {"l2_velocity", "l2_pressure"}) {
    if (!coarser.errors.contains(name) || !row.errors.contains(name)) continue;
    const double order = std::log(coarser.errors.at(name) / row.errors.at(name)) / std::log(refinement);
    if (std::isfinite(order)) row.others[std::string("order_") + name] = order;
  }
}

}  // namespace

framework::RepeatedRun repeat_scene(
    const FlowScene& scene, device::Backend backend, const study::Repeats& repeats,
    const std::function<std::map<std::string, double>(Simulation&, run::ResultDocument&)>& errors_of) {
  return framework::repeat_run(repeats, [&](framework::RepeatedRun& runs) {
    Simulation simulation(scene, {backend, false, true});
    simulation.start();
    run::ResultDocument result;
    const framework::RunRequest request{{}, true, true, {}};
    const ExitCode code = framework::run_to_end(simulation, request, result);
    if (code == ExitCode::interrupted) return code;
    if (runs.samples.empty()) {
      runs.errors = errors_of(simulation, result);
      runs.others["divergence"] = simulation.divergence();
      runs.steps = result.steps;
    }
    runs.samples.push_back(result.timing.compute_s);
    return code;
  });
}

std::string check_study(const MiniAppOptions& options, const std::filesystem::path& file) {
  if (is_ensemble(options)) return ensemble_report(options, file);
  const std::vector<FlowScene> scenes = scenes_of(options, file, read_flow_scene(file, options.set));
  const FlowScene& largest = *std::ranges::max_element(scenes, {}, &FlowScene::cells);
  const auto [x, y, z] = largest.parameters.cells;
  return scene::sentence("study        ", scenes.size(), " runs on up to ", x, " x ", y, " x ", z, " cells, ",
                         scene::rough_text(run_size(largest).bytes / 1048576.0), " MiB for their arrays\n");
}

ExitCode run_study(const MiniAppOptions& options, const std::filesystem::path& file) {
  if (is_ensemble(options)) {
    framework::run_ensemble(options, file, ensemble_of(options, file));
    return ExitCode::ok;
  }
  const FlowScene base = read_flow_scene(file, options.set);
  const std::vector<FlowScene> scenes = scenes_of(options, file, base);
  int threads = 1;
  for (const FlowScene& scene : scenes) threads = std::max(threads, flow::host_threads(scene.parameters, 1));
  framework::StudySession session(options, "drogue-parachute", base.name, print_flow_scene(base), threads);
  return session.run(columns, scenes.size(), [&](std::size_t i, std::vector<study::StudyRow>& rows) {
    framework::RepeatedRun runs = run_point(scenes[i], session.backend());
    if (runs.code == ExitCode::interrupted) return false;
    study::StudyRow row = row_of(scenes[i], std::move(runs));
    if (!rows.empty()) add_orders(rows.back(), row);
    rows.push_back(std::move(row));
    return true;
  });
}

}  // namespace drogue::parachute_app
