#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "common/scene/nearest.hpp"
#include "common/scene/node.hpp"
#include "common/scene/read.hpp"
#include "miniapps/parachute/scene/functions.hpp"
#include "miniapps/parachute/scene/scene_check.hpp"

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

void check_flow_rates(const Table& root, const FlowScene& scene) {
  for (std::size_t i = 0; i < scene.verify.flow_rates.size(); ++i) {
    const FlowRate& rate = scene.verify.flow_rates[i];
    const std::string path = "verify.flow_rate[" + std::to_string(i) + "]";
    const BoundaryKind kind = scene.parameters.boundary[static_cast<std::size_t>(rate.side)].kind;
    if (kind != BoundaryKind::inflow && kind != BoundaryKind::outflow)
      contradict(root, path + ".side",
                 path + ".side: nothing flows through a side that is neither inflow nor outflow");
    if (rate.target.value == 0.0)
      contradict(root, path + ".value", path + ".value must not be 0: the tolerance is relative");
  }
}

/// Checks the body and the value of a check of forces.
void check_component(const Table& root, const FlowScene& scene, const std::string& path, int body,
                     const Target& target) {
  if (body >= static_cast<int>(scene.bodies.size()))
    contradict(root, path + ".body",
               path + ".body = " + std::to_string(body) + ": the number of bodies is " +
                   std::to_string(scene.bodies.size()) + ", and the first one is 0");
  if (target.value == 0.0)
    contradict(root, path + ".value", path + ".value must not be 0: the tolerance is relative");
}

void check_forces(const Table& root, const FlowScene& scene) {
  const auto path_of = [](const std::string& name, std::size_t i) {
    return "verify." + name + "[" + std::to_string(i) + "]";
  };
  for (std::size_t i = 0; i < scene.verify.forces.size(); ++i)
    check_component(root, scene, path_of("force", i), scene.verify.forces[i].body,
                    scene.verify.forces[i].target);
  const auto check_windows = [&](const std::string& name, const std::vector<ForceWindow>& windows) {
    for (std::size_t i = 0; i < windows.size(); ++i) {
      const std::string path = path_of(name, i), key = path + ".from";
      check_component(root, scene, path, windows[i].body, windows[i].target);
      require_rows(root, scene, path);
      if (windows[i].from >= scene.end_time)
        contradict(root, key,
                   key + " = " + scene::real_text(windows[i].from) +
                       " s must be before run.end_time = " + scene::real_text(scene.end_time) + " s");
    }
  };
  check_windows("mean_force", scene.verify.mean_forces);
  check_windows("frequency", scene.verify.frequencies);
}

/// Columns with places of sheets.
std::vector<std::string> place_columns(const FlowScene& scene) {
  std::vector<std::string> columns;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    if (scene.bodies[i].mount) columns.push_back(displacement_column(i));
  for (std::size_t i = 0; i < scene.canopies.size(); ++i)
    for (const char* axis : axis_names) columns.push_back("canopy_" + std::to_string(i) + "_payload_" + axis);
  for (std::size_t i = 0; i < scene.flags.size(); ++i)
    for (const char* axis : {"x", "y"}) columns.push_back("flag_" + std::to_string(i) + "_tip_" + axis);
  return columns;
}

void check_oscillations(const Table& root, const FlowScene& scene) {
  const std::vector<std::string> columns = place_columns(scene);
  for (std::size_t i = 0; i < scene.verify.oscillations.size(); ++i) {
    const Oscillation& oscillation = scene.verify.oscillations[i];
    const std::string path = "verify.oscillation[" + std::to_string(i) + "]";
    if (columns.empty())
      contradict(root, path, path + " needs a [[body]] with a mount, a [[canopy]] or a [[flag]]");
    if (std::ranges::find(columns, oscillation.column) == columns.end())
      contradict(root, path + ".column",
                 path + ".column = \"" + oscillation.column + "\" has no place of a sheet; " +
                     scene::suggestion(oscillation.column, columns));
    require_rows(root, scene, path);
    if (oscillation.from >= scene.end_time)
      contradict(root, path + ".from",
                 path + ".from = " + scene::real_text(oscillation.from) +
                     " s must be before run.end_time = " + scene::real_text(scene.end_time) + " s");
    if (!oscillation.frequency && !oscillation.amplitude)
      contradict(root, path, path + " needs frequency or amplitude");
    const auto check_value = [&](const std::string& name, const std::optional<Target>& target) {
      if (target && !(target->value > 0.0))
        contradict(root, path + "." + name + ".value",
                   path + "." + name + ".value must be positive: the tolerance is relative");
    };
    check_value("frequency", oscillation.frequency);
    check_value("amplitude", oscillation.amplitude);
  }
}

void check_canopy_number(const Table& root, const FlowScene& scene, const std::string& path, int canopy) {
  if (scene.canopies.empty()) contradict(root, path + ".canopy", path + " needs a [[canopy]]");
  if (canopy >= static_cast<int>(scene.canopies.size()))
    contradict(root, path + ".canopy",
               path + ".canopy = " + std::to_string(canopy) + ": the number of canopies is " +
                   std::to_string(scene.canopies.size()) + ", and the first one is 0");
}

/// Checks canopy and interval of a `CanopyMean` or a `CanopyLeak`.
template <class Interval>
void check_canopy_interval(const Table& root, const FlowScene& scene, const std::string& path,
                           const Interval& mean) {
  check_canopy_number(root, scene, path, mean.canopy);
  if (!(mean.from < mean.to && mean.to <= scene.end_time))
    contradict(root, path + ".to",
               path + ".to = " + scene::real_text(mean.to) +
                   " s must lie between from and run.end_time = " + scene::real_text(scene.end_time) + " s");
  for (const std::string& component : scene.velocity)
    if (!SpaceTimeFunction(component).constant())
      contradict(root, path, path + " needs a fluid.velocity that does not vary");
  require_rows(root, scene, path);
}

/// Ratios to the speed far upstream need one: the fluid must not rest relative to the payload all the time.
void check_speed(const Table& root, const FlowScene& scene, const std::string& path, int canopy) {
  for (const std::string& component : scene.velocity)
    if (SpaceTimeFunction(component).constant() != 0.0) return;
  const auto of = static_cast<std::size_t>(canopy);
  const bool is_drum = scene.canopies[of].kind == CanopyKind::drum;
  const auto owner = static_cast<std::size_t>(scene.canopies[of].payload.shared.value_or(canopy));
  if (!is_drum && !(scene.canopies[owner].has_lines() && scene.canopies[owner].payload.fixed)) return;
  const std::string name = "canopy[" + std::to_string(is_drum ? of : owner) + "]";
  contradict(root, path,
             path +
                 " is relative to the speed of the fluid far upstream, which is 0: fluid.velocity is 0 and " +
                 (is_drum ? name + ".kind is \"drum\", whose rim rests" : name + ".payload.fixed is true") +
                 "; give fluid.velocity");
}

void check_canopy_means(const Table& root, const FlowScene& scene, const std::string& key,
                        const std::vector<CanopyMean>& means) {
  for (std::size_t i = 0; i < means.size(); ++i) {
    const std::string path = "verify." + key + "[" + std::to_string(i) + "]";
    if (means[i].target.value == 0.0)
      contradict(root, path + ".value", path + ".value must not be 0: the tolerance is relative");
    check_canopy_interval(root, scene, path, means[i]);
  }
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
  check_canopy_means(root, scene, "drag", verify.drags);
  for (std::size_t i = 0; i < verify.drags.size(); ++i)
    check_speed(root, scene, "verify.drag[" + std::to_string(i) + "]", verify.drags[i].canopy);
  check_canopy_means(root, scene, "terminal_speed", verify.terminal_speeds);
  check_canopy_means(root, scene, "projected_area", verify.projected_areas);
  for (std::size_t i = 0; i < verify.leaks.size(); ++i) {
    const std::string path = "verify.leak[" + std::to_string(i) + "]";
    check_canopy_interval(root, scene, path, verify.leaks[i]);
    check_speed(root, scene, path, verify.leaks[i].canopy);
  }
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
  if (verify.dissipation_peak && verify.dissipation_peak->target.value == 0.0)
    contradict(root, "verify.dissipation_peak.value",
               "verify.dissipation_peak.value must not be 0: the tolerance is relative");
  if (verify.kinetic_energy && verify.kinetic_energy->value == 0.0)
    contradict(root, "verify.kinetic_energy.value",
               "verify.kinetic_energy.value must not be 0: the tolerance is relative");
  check_curves(root, scene, "kinetic_energy_curve", verify.kinetic_energy_curves);
  check_curves(root, scene, "dissipation_curve", verify.dissipation_curves);
  check_flow_rates(root, scene);
  check_forces(root, scene);
  check_oscillations(root, scene);
  check_canopy_checks(root, scene);
  check_profiles(root, scene);
}

}  // namespace drogue::parachute_app
