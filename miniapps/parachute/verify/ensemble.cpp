#include "miniapps/parachute/verify/ensemble.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "common/program/failure.hpp"
#include "common/scene/node.hpp"
#include "kernels/fabric/host_threads.hpp"
#include "kernels/flow/host_threads.hpp"
#include "miniapps/parachute/scene/functions.hpp"
#include "miniapps/parachute/scene/run_size.hpp"
#include "miniapps/parachute/verify/flight.hpp"

namespace drogue::parachute_app {
namespace {

using scene::real_text;

constexpr double displacement = 0.02;    // of the shortest edge
constexpr double relative_speed = 1e-3;  // of the sines in the initial velocity
constexpr int seeds_of_a_canopy = 1000;
constexpr double largest_growth = 1.1;  // as of grid.growth

std::string list_text(const std::array<double, 3>& values) {
  return "[" + real_text(values[0]) + ", " + real_text(values[1]) + ", " + real_text(values[2]) + "]";
}

void add_grid(const FlowScene& scene, double factor, std::vector<std::string>& sets) {
  const flow::Parameters& p = scene.parameters;
  if (scene.faces) throw Failure(ExitCode::usage, "--study with cells needs grid.cells or grid.core");
  std::array<double, 3> widths{};
  std::string cells;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    widths[axis] = p.cells[axis] == 1 ? scene.spacing[axis] : scene.spacing[axis] / factor;
    const long long count = p.cells[axis] == 1 ? 1 : std::llround(p.cells[axis] * factor);
    cells += (axis == 0 ? "[" : ", ") + std::to_string(count);
  }
  if (!scene.core) {
    sets.push_back("grid.cells=" + cells + "]");
    return;
  }
  sets.push_back("grid.spacing=" + list_text(widths));
  // Cells outside the core are F times as narrow, too.
  sets.push_back("grid.growth=" + real_text(std::min(largest_growth, std::pow(scene.growth, 1.0 / factor))));
}

/// Assignments of a grid with `factor` times as many cells along each axis.
std::vector<std::string> refinement(const FlowScene& scene, double factor) {
  std::vector<std::string> sets;
  if (factor == 1.0) return sets;
  if (scene.has_fluid()) add_grid(scene, factor, sets);
  const flow::Parameters& p = scene.parameters;
  if (p.fixed_dt > 0.0)
    sets.push_back("run.dt=" + real_text(p.fixed_dt / factor));
  else if (p.max_dt > 0.0)
    sets.push_back("run.max_dt=" + real_text(p.max_dt / factor));
  const auto add_edges = [&](const char* array, const auto& sheets, const auto& has_edge) {
    for (std::size_t i = 0; i < sheets.size(); ++i)
      if (has_edge(sheets[i]))
        sets.push_back(scene::element(array, i) +
                       ".edge_length=" + real_text(sheets[i].edge_length / factor));
  };
  const auto always = [](const auto&) { return true; };
  add_edges("canopy", scene.canopies, always);
  add_edges("flag", scene.flags, always);
  add_edges("body", scene.bodies, [](const Body& body) { return body.kind != BodyKind::file; });
  return sets;
}

/// Assignments that displace the cloth of canopies at the start.
std::vector<std::string> displaced_cloth(const FlowScene& scene, double finest, int seed) {
  double shortest = scene.canopies.front().edge_length;
  for (const Canopy& canopy : scene.canopies) shortest = std::min(shortest, canopy.edge_length);
  std::vector<std::string> sets;
  for (std::size_t i = 0; i < scene.canopies.size(); ++i) {
    const double given = scene.canopies[i].perturbation.amplitude,
                 amplitude = given > 0.0 ? given : displacement * shortest / std::max(1.0, finest);
    sets.push_back(scene::element("canopy", i) + ".perturbation={amplitude=" + real_text(amplitude) +
                   ", seed=" + std::to_string(seed + seeds_of_a_canopy * static_cast<int>(i)) + "}");
  }
  return sets;
}

/// Speed of the stream in the middle of the domain at the end, m/s; 1 for none.
double speed_at_end(const FlowScene& scene) {
  double speed = 0.0;
  for (const double component : SpaceTimeVector(scene.velocity)(middle_of(scene.parameters), scene.end_time))
    speed = std::hypot(speed, component);
  return speed > 0.0 ? speed : 1.0;
}

/// Text of a component of the initial velocity, without a start from rest in t, which this may not name.
std::string initial_text(const FlowScene& scene, std::size_t axis) {
  const std::string& text = scene.initial_velocity()[axis];
  const SpaceTimeFunction function(text);
  const flow::Parameters& p = scene.parameters;
  const double value = function(p.low, 0.0);
  for (const double part : {0.13, 0.37, 0.61, 0.83}) {
    std::array<double, 3> place{};
    for (std::size_t k = 0; k < 3; ++k)
      place[k] = std::lerp(p.low[k], p.high[k], part + 0.05 * static_cast<double>(k));
    if (function(place, 0.0) != value) return text;
  }
  return real_text(value);
}

/// Assignment of an initial velocity with sines whose divergence is 0, each along the next axis with several
/// cells.
std::vector<std::string> other_velocity(const FlowScene& scene, int seed) {
  const flow::Parameters& p = scene.parameters;
  std::mt19937 engine(static_cast<std::uint32_t>(seed));
  const double speed = relative_speed * speed_at_end(scene);
  std::string list;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double phase = static_cast<double>(engine()) / std::mt19937::max();
    std::size_t along = (axis + 1) % 3;
    if (p.cells[along] == 1) along = (axis + 2) % 3;
    std::string text = initial_text(scene, axis);
    if (p.cells[axis] > 1 && p.cells[along] > 1)
      text = "(" + text + ")+" + real_text(speed) + "*sin(2*pi*((" + axis_names[along] + "-(" +
             real_text(p.low[along]) + "))/" + real_text(p.high[along] - p.low[along]) + "+" +
             real_text(phase) + "))";
    list += (axis == 0 ? "[\"" : ", \"") + text + "\"";
  }
  return {"initial.velocity=" + list + "]"};
}

/// Assignments without those on fields and their times, which apply only together, and no run writes.
std::vector<std::string> sets_without_fields(std::vector<std::string> sets) {
  std::erase_if(sets, [](const std::string& assignment) {
    return assignment.starts_with("output.fields") || assignment.starts_with("output.times");
  });
  return sets;
}

/// Reads a scene as a point of the study. An error names --study.
FlowScene read_point(const std::filesystem::path& file, const MiniAppOptions& options,
                     const std::vector<std::string>& sets) {
  try {
    return read_flow_scene(file, sets, SchemeSource::scene, framework::InitialCheck::some_cells);
  } catch (const Failure& failure) {
    throw Failure(ExitCode::usage, "--study " + options.study + ": " + failure.what());
  }
}

/// The scene of the command line with further assignments.
FlowScene member_scene(const std::filesystem::path& file, const MiniAppOptions& options,
                       const std::vector<std::string>& point) {
  if (point.empty()) return read_flow_scene(file, options.set);
  std::vector<std::string> sets = options.set;
  sets.insert(sets.end(), point.begin(), point.end());
  return read_point(file, options, sets);
}

int threads_of(const FlowScene& scene) {
  if (scene.has_fluid()) return flow::host_threads(scene.parameters, 1);
  return fabric::host_threads(make_all_sheets({}, scene.canopies, 1.0, 1.0).positions.size());
}

/// Cells along an axis of a scene over those of another, in the core: the mean over the axes.
double finer_by(const FlowScene& scene, const FlowScene& base) {
  if (!scene.has_fluid()) return base.canopies.front().edge_length / scene.canopies.front().edge_length;
  double sum = 0.0, count = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (base.parameters.cells[axis] == 1) continue;
    sum += core_width(base.parameters, axis) / core_width(scene.parameters, axis);
    count += 1.0;
  }
  return sum / count;
}

/// A study with the scene of each of its grids.
struct Plan {
  framework::Ensemble ensemble;
  std::vector<FlowScene> scenes;
};

Plan plan_of(const MiniAppOptions& options, const std::filesystem::path& file) {
  const FlowScene base = member_scene(file, options, {});
  Plan plan;
  framework::Ensemble& ensemble = plan.ensemble;
  ensemble.program = "drogue-parachute";
  ensemble.scene = base.name;
  ensemble.printed = print_flow_scene(base);
  ensemble.end_time = base.end_time;
  ensemble.axes = study::parse_ensemble(options.study);
  ensemble.title = flight_title;
  ensemble.resolve = [file, options](const framework::EnsembleRun& run) {
    const FlowScene scene = read_point(file, options, run.sets);
    return framework::ResolvedScene{print_flow_scene(scene), scene_identity(scene)};
  };
  const std::vector<double> wanted = ensemble.axes.factors;
  for (const double factor : wanted)
    plan.scenes.push_back(member_scene(file, options, refinement(base, factor)));
  ensemble.notices = plan.scenes.back().notices;
  for (std::size_t grid = wanted.size(); grid-- > 0;) {
    const FlowScene& scene = plan.scenes[grid];
    ensemble.useful_threads = std::max(ensemble.useful_threads, threads_of(scene));
    ensemble.axes.factors[grid] = finer_by(scene, base);
    const std::vector<std::string> finer = refinement(base, wanted[grid]);
    for (int seed = 1; seed <= ensemble.axes.runs; ++seed) {
      framework::EnsembleRun& run = ensemble.runs.emplace_back();
      run.member.folder = "cells-" + scene::rough_text(wanted[grid]) + "/seed-" + std::to_string(seed);
      run.member.grid = grid;
      run.member.seed = seed;
      run.sets = sets_without_fields(options.set);
      run.sets.insert(run.sets.end(), finer.begin(), finer.end());
      const std::vector<std::string> start =
          base.canopies.empty() ? other_velocity(base, seed) : displaced_cloth(base, wanted.back(), seed);
      run.sets.insert(run.sets.end(), start.begin(), start.end());
      run.sets.insert(run.sets.end(), {"output.fields=[]", "output.restart_every=0"});
      if (seed == 1) (void)read_point(file, options, run.sets);  // refuses what would fail in every run
    }
  }
  return plan;
}

}  // namespace

framework::Ensemble ensemble_of(const MiniAppOptions& options, const std::filesystem::path& file) {
  return plan_of(options, file).ensemble;
}

std::string ensemble_report(const MiniAppOptions& options, const std::filesystem::path& file) {
  const auto [ensemble, scenes] = plan_of(options, file);
  std::string text = "study        " + std::to_string(ensemble.runs.size()) + " runs, " +
                     std::to_string(ensemble.axes.runs) + " on each grid, " +
                     std::to_string(framework::jobs_of(options, ensemble)) + " at once here\n";
  RunTime all;
  for (const FlowScene& scene : scenes) {
    if (!scene.has_fluid()) return text;
    const RunTime one = run_time(scene);
    if (one.two_cores == 0.0)
      return text + "             time not known: it depends on the speed of the fluid\n";
    all.two_cores += ensemble.axes.runs * one.two_cores;
    all.h200 += ensemble.axes.runs * one.h200;
    text +=
        scene::sentence("             ", scene.parameters.cells[0], " x ", scene.parameters.cells[1], " x ",
                        scene.parameters.cells[2], " cells, a run about ", duration_text(one.two_cores),
                        " on two cores, ", duration_text(one.h200), " on one H200\n");
  }
  return text + scene::sentence("             all about ", duration_text(all.two_cores), " on two cores, ",
                                duration_text(all.h200), " on one H200, one after another\n");
}

}  // namespace drogue::parachute_app
