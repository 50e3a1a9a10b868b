#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "common/scene/node.hpp"
#include "common/scene/read.hpp"
#include "miniapps/parachute/scene/functions.hpp"
#include "miniapps/parachute/scene/scene_check.hpp"
#include "miniapps/parachute/simulation/history_columns.hpp"

namespace drogue::parachute_app {
namespace {

using flow::BoundaryKind;
using scene::contradict;
using scene::Table;

bool is_forced(const flow::Parameters& p) {
  const auto acts = [](double force) { return force != 0.0; };
  return std::ranges::any_of(p.body_force, acts) || std::ranges::any_of(p.pressure_drop, acts);
}

/// Checks that follow the run need rows of the history.
void require_rows(const Table& root, const FlowScene& scene, const std::string& key) {
  if (scene.output.history_every == 0)
    contradict(root, key, key + " needs rows of the history; output.history_every is 0");
}

void check_momentum(const Table& root, const FlowScene& scene) {
  const flow::Parameters& p = scene.parameters;
  const auto open = std::ranges::find_if(
      p.boundary, [](const flow::Boundary& side) { return side.kind != BoundaryKind::periodic; });
  if (open != p.boundary.end())
    contradict(root, "verify.momentum",
               std::string("verify.momentum: the side ") +
                   side_names[static_cast<std::size_t>(open - p.boundary.begin())] +
                   " is not periodic, so that the momentum changes");
  if (is_forced(p))
    contradict(root, "verify.momentum",
               "verify.momentum: flow.body_force or flow.pressure_drop changes the momentum");
  if (scene.has_sheets())
    contradict(root, "verify.momentum",
               "verify.momentum: the forces of a [[body]] or a [[canopy]] change the momentum of the fluid");
}

void check_curves(const Table& root, const FlowScene& scene, const std::string& key,
                  const std::vector<Curve>& curves) {
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const std::string path = "verify." + key + "[" + std::to_string(i) + "]", points = path + ".points";
    require_rows(root, scene, path);
    if (!(curves[i].scale() > 0.0))
      contradict(root, points, points + ": a value must not be 0: the tolerance is relative to the largest");
    for (const auto& [time, value] : curves[i].points)
      if (!(time >= 0.0 && time <= scene.end_time))
        contradict(root, points,
                   points + ": the time " + scene::real_text(time) +
                       " s is not between 0 and run.end_time = " + scene::real_text(scene.end_time) + " s");
  }
}

void check_canopy_number(const Table& root, const FlowScene& scene, const std::string& path, int canopy) {
  if (scene.canopies.empty()) contradict(root, path + ".canopy", path + " needs a [[canopy]]");
  if (canopy >= static_cast<int>(scene.canopies.size()))
    contradict(root, path + ".canopy",
               path + ".canopy = " + std::to_string(canopy) + ": the number of canopies is " +
                   std::to_string(scene.canopies.size()) + ", and the first one is 0");
}

/// Ratios to the speed far upstream need one.
void require_airspeed(const Table& root, const FlowScene& scene, const std::string& path,
                      std::size_t canopy) {
  const std::string reason = scene.lack_of_airspeed(canopy);
  if (!reason.empty())
    contradict(root, path, path + " is relative to the speed of the fluid far upstream, " + reason);
}

void check_leaks(const Table& root, const FlowScene& scene) {
  for (std::size_t i = 0; i < scene.verify.leaks.size(); ++i) {
    const CanopyLeak& leak = scene.verify.leaks[i];
    const std::string path = "verify.leak[" + std::to_string(i) + "]";
    check_canopy_number(root, scene, path, leak.canopy);
    if (!(leak.from < leak.to && leak.to <= scene.end_time))
      contradict(root, path + ".to",
                 path + ".to = " + scene::real_text(leak.to) +
                     " s must lie between from and run.end_time = " + scene::real_text(scene.end_time) +
                     " s");
    require_airspeed(root, scene, path, static_cast<std::size_t>(leak.canopy));
    require_rows(root, scene, path);
  }
}

/// Names the reason where a scene lacks a column since it has no stream.
void check_history(const Table& root, const FlowScene& scene) {
  const std::vector<framework::HistoryCheck>& checks = scene.verify.history;
  if (checks.empty()) return;
  for (std::size_t i = 0; i < checks.size(); ++i)
    for (std::size_t canopy = 0; canopy < scene.canopies.size(); ++canopy)
      for (const char* column : {"_airspeed", "_drag_coefficient"})
        if (checks[i].column == "canopy_" + std::to_string(canopy) + column)
          require_airspeed(root, scene, "verify.history[" + std::to_string(i) + "]", canopy);
  framework::require_measurable(root, checks, scene.output, {scene.end_time, "run.end_time"},
                                history_columns(scene));
}

/// Energy is conserved unless parts of the cloth are cut off or collide.
void check_energy_drift(const Table& root, const FlowScene& scene) {
  if (!scene.verify.energy_drift) return;
  const std::string key = "verify.energy_drift";
  require_rows(root, scene, key);
  if (scene.contact) contradict(root, key, key + ": contact of cloth with itself dissipates energy");
  for (std::size_t i = 0; i < scene.canopies.size(); ++i) {
    const Canopy& canopy = scene.canopies[i];
    const std::string name = "canopy[" + std::to_string(i) + "]";
    if (canopy.payload.release || (canopy.reefing && canopy.reefing->cut))
      contradict(root, key, key + ": lines of " + name + " are cut, and lose their energy");
  }
}

void check_canopy_checks(const Table& root, const FlowScene& scene) {
  const Verify& verify = scene.verify;
  check_leaks(root, scene);
  if (verify.intersections) {
    if (!scene.contact)
      contradict(root, "verify.intersections", "verify.intersections needs coupling.contact = true");
    require_rows(root, scene, "verify.intersections");
  }
  for (std::size_t i = 0; i < verify.peak_forces.size(); ++i) {
    const std::string path = "verify.peak_force[" + std::to_string(i) + "]";
    check_canopy_number(root, scene, path, verify.peak_forces[i].canopy);
    if (!scene.canopies[static_cast<std::size_t>(verify.peak_forces[i].canopy)].has_lines())
      contradict(root, path + ".canopy", path + ".canopy: this canopy has no lines");
    if (const auto& time = verify.peak_forces[i].time; time && !((*time)[0] < (*time)[1]))
      contradict(root, path + ".time", path + ".time: the first number must be the smaller");
  }
  check_energy_drift(root, scene);
  if (!verify.force_balance) return;
  if (scene.canopies.empty())
    contradict(root, "verify.force_balance", "verify.force_balance needs a [[canopy]]");
  require_rows(root, scene, "verify.force_balance");
}

void check_profiles(const Table& root, const FlowScene& scene) {
  const flow::Parameters& p = scene.parameters;
  for (std::size_t i = 0; i < scene.verify.profiles.size(); ++i) {
    const Profile& profile = scene.verify.profiles[i];
    const std::string path = "verify.profile[" + std::to_string(i) + "]";
    const auto along = static_cast<std::size_t>(profile.along);
    if (profile.points.empty() && !profile.minimum && !profile.maximum)
      contradict(root, path, path + " needs points, minimum or maximum");
    constexpr int least_cells = 4;
    if (p.cells[along] < least_cells)
      contradict(root, path + ".along",
                 path + ".along = \"" + axis_names[along] + "\": this axis has fewer than 4 cells");
    const auto inside = [&](std::size_t axis, double x) { return x >= p.low[axis] && x <= p.high[axis]; };
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (axis != along && !inside(axis, profile.through[axis]))
        contradict(root, path + ".through",
                   path + ".through[" + std::to_string(axis) +
                       "] = " + scene::real_text(profile.through[axis]) + " is outside of the domain");
    for (const auto& [where, value] : profile.points)
      if (!inside(along, where))
        contradict(root, path + ".points",
                   path + ".points: the coordinate " + scene::real_text(where) + " is outside of the domain");
  }
}

/// The solution is evaluated at the end of the run.
void check_exact(const Table& root, const FlowScene& scene) {
  const auto check = [&](const std::string& key, const std::string& text, flow::StateField field) {
    const std::vector<double> values =
        evaluate(SpaceTimeFunction(text), lattice_of(scene.parameters, field), scene.end_time);
    if (!std::ranges::all_of(values, [](double value) { return std::isfinite(value); }))
      contradict(root, key,
                 key + " = " + scene::shortened(text) + " is not finite on the grid at run.end_time = " +
                     scene::real_text(scene.end_time) + " s");
  };
  for (std::size_t axis = 0; axis < 3; ++axis)
    check(std::string("verify.exact.") + axis_names[axis], scene.verify.exact->velocity[axis],
          velocity_field(axis));
  if (!scene.verify.exact->pressure.empty())
    check("verify.exact.pressure", scene.verify.exact->pressure, flow::StateField::pressure);
}

}  // namespace

void check_verify(const Table& root, const FlowScene& scene) {
  const Verify& verify = scene.verify;
  if (verify.exact) check_exact(root, scene);
  if (verify.momentum) check_momentum(root, scene);
  if (verify.dissipation_peak && verify.dissipation_peak->value == 0.0)
    contradict(root, "verify.dissipation_peak.value",
               "verify.dissipation_peak.value must not be 0: the tolerance is relative");
  check_curves(root, scene, "kinetic_energy_curve", verify.kinetic_energy_curves);
  check_curves(root, scene, "dissipation_curve", verify.dissipation_curves);
  check_history(root, scene);
  check_canopy_checks(root, scene);
  check_profiles(root, scene);
}

}  // namespace drogue::parachute_app
