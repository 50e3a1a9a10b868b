#include <algorithm>
#include <cmath>

#include "miniapps/parachute/scene/functions.hpp"
#include "miniapps/parachute/scene/scene_check.hpp"
#include "miniapps/parachute/simulation/history_columns.hpp"

namespace drogue::parachute_app {
namespace {

using scene::Place;

void check_momentum(const Place& verify, const FlowScene& scene) {
  const flow::Parameters& p = scene.parameters;
  using Vector = std::array<double, 3>;
  for (std::size_t side = 0; side < 6; ++side)
    verify.refuse_if(p.boundary[side].kind != flow::BoundaryKind::periodic, "momentum", ": the side ",
                     side_names[side], " is not periodic, so that the momentum changes");
  verify.refuse_if(p.body_force != Vector{} || p.pressure_drop != Vector{}, "momentum",
                   ": flow.body_force or flow.pressure_drop changes the momentum");
  verify.refuse_if(scene.has_sheets(), "momentum",
                   ": the forces of a [[body]] or a [[canopy]] change the momentum of the fluid");
}

void check_curves(const Place& verify, const FlowScene& scene, const char* key,
                  const std::vector<Curve>& curves) {
  for (const auto& [at, curve] : verify.each(key, curves)) {
    at.refuse_if(!(curve.scale() > 0.0), "points",
                 ": a value must not be 0: the tolerance is relative to the largest");
    for (const auto& [time, value] : curve.points)
      at.refuse_if(!(time >= 0.0 && time <= scene.end_time), "points", ": the time ", time,
                   " s is not between 0 and run.end_time = ", scene.end_time, " s");
  }
}

void check_canopy_number(const Place& at, const FlowScene& scene, int canopy) {
  if (scene.canopies.empty()) at.contradict("canopy", at.path(), " needs a [[canopy]]");
  at.refuse_if(canopy >= static_cast<int>(scene.canopies.size()), "canopy", " = ", canopy,
               ": the number of canopies is ", scene.canopies.size(), ", and the first one is 0");
}

/// Ratios to the speed far upstream need one.
void require_airspeed(const Place& at, const FlowScene& scene, std::size_t canopy) {
  const std::string reason = scene.lack_of_airspeed(canopy);
  at.refuse_if(!reason.empty(), "", " is relative to the speed of the fluid far upstream, ", reason);
}

void check_leaks(const Place& verify, const FlowScene& scene) {
  for (const auto& [at, leak] : verify.each("leak", scene.verify.leaks)) {
    check_canopy_number(at, scene, leak.canopy);
    at.refuse_if(!(leak.from < leak.to && leak.to <= scene.end_time), "to", " = ", leak.to,
                 " s must lie between from and run.end_time = ", scene.end_time, " s");
    require_airspeed(at, scene, static_cast<std::size_t>(leak.canopy));
  }
}

/// Names the reason where a scene lacks a column since it has no stream.
void check_history(const Place& root, const FlowScene& scene) {
  const std::vector<framework::HistoryCheck>& checks = scene.verify.history;
  if (checks.empty()) return;
  for (const auto& [at, check] : root.each("verify.history", checks))
    for (std::size_t canopy = 0; canopy < scene.canopies.size(); ++canopy)
      for (const char* column : {"_airspeed", "_drag_coefficient", "_rate_of_descent"})
        if (check.column == "canopy_" + std::to_string(canopy) + column) require_airspeed(at, scene, canopy);
  framework::require_measurable(root, checks, scene.output, {scene.end_time, "run.end_time"},
                                history_columns(scene));
}

void check_peak_forces(const Place& verify, const FlowScene& scene) {
  for (const auto& [at, peak] : verify.each("peak_force", scene.verify.peak_forces)) {
    check_canopy_number(at, scene, peak.canopy);
    at.refuse_if(!scene.canopies[static_cast<std::size_t>(peak.canopy)].has_lines(), "canopy",
                 ": this canopy has no lines");
    at.refuse_if(peak.time && !((*peak.time)[0] < (*peak.time)[1]), "time",
                 ": the first number must be the smaller");
  }
}

/// Energy is conserved unless parts of the cloth are cut off or collide.
void check_energy_drift(const Place& verify, const FlowScene& scene) {
  const std::string key = "energy_drift";
  verify.refuse_if(scene.contact, key, ": contact of cloth with itself dissipates energy");
  for (std::size_t i = 0; i < scene.canopies.size(); ++i) {
    const Canopy& canopy = scene.canopies[i];
    verify.refuse_if(canopy.payload.release || (canopy.reefing && canopy.reefing->cut), key, ": lines of ",
                     scene::element("canopy", i), " are cut, and lose their energy");
  }
}

void check_profiles(const Place& verify, const FlowScene& scene) {
  constexpr int least_cells = 4;
  const flow::Parameters& p = scene.parameters;
  const auto outside = [&](std::size_t axis, double x) { return !(x >= p.low[axis] && x <= p.high[axis]); };
  for (const auto& [at, profile] : verify.each("profile", scene.verify.profiles)) {
    const auto along = static_cast<std::size_t>(profile.along);
    at.refuse_if(profile.points.empty() && !profile.minimum && !profile.maximum, "",
                 " needs points, minimum or maximum");
    at.refuse_if(p.cells[along] < least_cells, "along", " = \"", axis_names[along],
                 "\": this axis has fewer than 4 cells");
    for (std::size_t axis = 0; axis < 3; ++axis)
      at.refuse_if(axis != along && outside(axis, profile.through[axis]), "through", "[", axis,
                   "] = ", profile.through[axis], " is outside of the domain");
    for (const auto& [where, value] : profile.points)
      at.refuse_if(outside(along, where), "points", ": the coordinate ", where, " is outside of the domain");
  }
}

/// The solution is evaluated at the end of the run.
void check_exact(const Place& exact, const FlowScene& scene, framework::InitialCheck cells) {
  const auto check = [&](const std::string& key, const std::string& text, std::size_t normal) {
    const Lattice lattice = lattice_of(scene.parameters, normal);
    const std::vector<double> values =
        evaluate(SpaceTimeFunction(text), lattice, scene.end_time, stride_of_check(cells, lattice));
    exact.refuse_if(!std::ranges::all_of(values, [](double value) { return std::isfinite(value); }), key,
                    " = ", scene::shortened(text),
                    " is not finite on the grid at run.end_time = ", scene.end_time, " s");
  };
  for (std::size_t axis = 0; axis < 3; ++axis)
    check(axis_names[axis], scene.verify.exact->velocity[axis], axis);
  if (!scene.verify.exact->pressure.empty()) check("pressure", scene.verify.exact->pressure, flow::at_cells);
}

}  // namespace

void check_verify(const Place& root, const FlowScene& scene, framework::InitialCheck check) {
  const Verify& wanted = scene.verify;
  const Place verify = root.at("verify");
  if (wanted.exact) check_exact(verify.at("exact"), scene, check);
  if (wanted.momentum) check_momentum(verify, scene);
  verify.refuse_if(wanted.dissipation_peak && wanted.dissipation_peak->value == 0.0, "dissipation_peak.value",
                   " must not be 0: the tolerance is relative");
  check_curves(verify, scene, "kinetic_energy_curve", wanted.kinetic_energy_curves);
  check_curves(verify, scene, "dissipation_curve", wanted.dissipation_curves);
  check_history(root, scene);
  for (const char* key : {"kinetic_energy_curve", "dissipation_curve", "leak", "force_balance",
                          "intersections", "energy_drift"})
    verify.refuse_if(verify.given(key) && scene.output.history_every == 0, key,
                     " needs rows of the history; output.history_every is 0");
  check_leaks(verify, scene);
  verify.refuse_if(wanted.intersections && !scene.contact, "intersections", " needs coupling.contact = true");
  check_peak_forces(verify, scene);
  if (wanted.energy_drift) check_energy_drift(verify, scene);
  verify.refuse_if(wanted.force_balance && scene.canopies.empty(), "force_balance", " needs a [[canopy]]");
  check_profiles(verify, scene);
}

}  // namespace drogue::parachute_app
