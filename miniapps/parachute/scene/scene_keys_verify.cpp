#include "miniapps/parachute/scene/codecs.hpp"
#include "miniapps/parachute/scene/scene_keys.hpp"

namespace drogue::parachute_app {
namespace {

using scene::Condition, scene::not_negative, scene::positive, scene::Table, scene::with_given;

void declare_exact(Table& table, ExactSolution& exact) {
  const std::vector<std::string> variables = {"x", "y", "z", "t"};
  for (std::size_t axis = 0; axis < 3; ++axis)
    table.value(axis_names[axis], scene::real_or_expression_codec(exact.velocity[axis], variables),
                std::string("Velocity along ") + axis_names[axis], {.unit = "m/s", .required = true});
  table.value("pressure", scene::real_or_expression_codec(exact.pressure, variables),
              "Pressure, up to a constant unless a side is an outflow", {.unit = "Pa"});
}

void declare_norms(Table& table, Verify& verify) {
  const Condition velocity = {[&verify] { return verify.exact.has_value(); },
                              "with exact, which names what to compare with", "exact"},
                  pressure = {[&verify] { return verify.exact && !verify.exact->pressure.empty(); },
                              "with exact.pressure, which names what to compare with", "exact"};
  const std::pair<std::string, std::string> norms[] = {
      {"l1", "Mean absolute error"}, {"l2", "Root-mean-square error"}, {"linf", "Largest error"}};
  for (const auto& [norm, meaning] : norms) {
    const auto declare = [&](const std::string& field, const std::string& unit, const Condition& when) {
      const std::string name = norm + "_" + field;
      table.value(name, scene::real_codec(verify.tolerances, name),
                  meaning + " of the " + field + " that passes",
                  {.unit = unit, .range = not_negative, .when = when});
    };
    declare("velocity", "m/s", velocity);
    declare("pressure", "Pa", pressure);
  }
}

/// An expected number that may be absent, and then its tolerance.
void declare_optional(Table& table, const std::string& name, std::optional<double>& value,
                      std::optional<double>& tolerance, const std::string& help, const std::string& unit) {
  table.value(name, value, help, {.unit = unit});
  table.value(name + "_tolerance", tolerance, "Largest deviation of it that passes",
              {.unit = unit, .range = not_negative, .when = with_given(name, value), .required = true});
}

void declare_extremum(Table& table, Extremum& extremum) {
  table.value("value", extremum.value, "Expected velocity", {.unit = "m/s", .required = true});
  table.value("tolerance", extremum.tolerance, "Largest deviation that passes",
              {.unit = "m/s", .range = not_negative, .required = true});
  declare_optional(table, "at", extremum.at, extremum.at_tolerance, "Expected coordinate", "m");
}

void declare_profile(Table& table, Profile& profile) {
  table.value("component", profile.component, axis_choices, "Component of the velocity", {.required = true});
  table.value("along", profile.along, axis_choices, "Axis that the line is parallel to", {.required = true});
  table.value("through", profile.through, "Point of the line", {.unit = "m", .required = true});
  table.value("points", points_codec(profile.points),
              "Coordinates along the line, m, and the expected velocities there", {.unit = "m/s"});
  table.value(
      "tolerance", profile.tolerance, "Largest deviation from the points that passes",
      {.unit = "m/s", .range = not_negative, .when = with_given("points", profile.points), .required = true});
  table.optional_table("minimum", profile.minimum, declare_extremum, "The least velocity");
  table.optional_table("maximum", profile.maximum, declare_extremum, "The largest velocity");
}

void declare_curve(Table& table, Curve& curve, const std::string& unit, const std::string& quantity) {
  table.value("points", points_codec(curve.points), "Times, s, and the expected " + quantity,
              {.unit = unit, .required = true});
  table.value("tolerance", curve.tolerance,
              "Largest deviation from one of them that passes, relative to the largest of them",
              {.range = not_negative, .required = true});
}

void declare_leak(Table& table, CanopyLeak& leak) {
  table.value("canopy", leak.canopy, "Number of the [[canopy]], from 0", {.range = scene::between(0, 1e6)});
  table.value("from", leak.from, "Begin of the interval",
              {.unit = "s", .range = not_negative, .required = true});
  table.value("to", leak.to, "End of the interval", {.unit = "s", .range = positive, .required = true});
  table.value(
      "tolerance", leak.tolerance,
      "Largest ratio of the mean that passes; what flows in and out of a canopy that breathes cancels",
      {.range = not_negative, .required = true});
  table.value("rms_tolerance", leak.rms_tolerance, "Largest ratio of the root mean square that passes",
              {.range = not_negative});
}

void declare_dissipation_peak(Table& table, DissipationPeak& peak) {
  table.value("value", peak.value, "Expected value", {.unit = "W", .required = true});
  table.value("tolerance", peak.tolerance, "Largest relative deviation that passes",
              {.range = not_negative, .required = true});
  declare_optional(table, "time", peak.time, peak.time_tolerance, "Expected time", "s");
}

void declare_peak_force(Table& table, CanopyPeak& peak) {
  table.value("canopy", peak.canopy, "Number of the [[canopy]], from 0", {.range = scene::between(0, 1e6)});
  table.value("force", scene::interval_codec(peak.force[0], peak.force[1]),
              "Least and largest force that pass", {.unit = "N", .required = true});
  table.value("time", peak.time, "Least and largest time of it that pass", {.unit = "s"});
}

/// Names keys of earlier versions, which were statistics of columns.
void declare_former_keys(Table& table) {
  const std::string of_body = "\"body_0_force_x\", of the former body and axis";
  const std::array<std::string, 3> former[] = {
      {"kinetic_energy", "\"kinetic_energy\"", "\"last\""},
      {"flow_rate", "\"outflow_x_low\", of the former side", "\"last\""},
      {"force", of_body, "\"last\""},
      {"mean_force", of_body, "\"mean\""},
      {"frequency", of_body, "\"frequency\" and the inverse of the former reference"},
      {"oscillation", "its column", "\"frequency\" or \"amplitude\""},
      {"drag", "\"canopy_0_drag_coefficient\", of the former canopy", "\"mean\""},
      {"terminal_speed", "\"canopy_0_airspeed\", of the former canopy", "\"mean\""},
      {"projected_area", "\"canopy_0_projected_area\", of the former canopy", "\"mean\""}};
  for (const auto& [name, column, statistic] : former)
    table.former(name, "[[verify.history]] with column = " + column + ", statistic = " + statistic +
                           "; from, to, value and tolerance stay");
}

}  // namespace

void declare_verify(Table& table, FlowScene& scene) {
  Verify& verify = scene.verify;
  const Condition fluid = with_fluid(scene);
  table.optional_table("exact", verify.exact, declare_exact, "Exact solution, compared at the end of the run",
                       {.when = fluid});
  declare_norms(table, verify);
  table.value("divergence", verify.divergence, "Largest root-mean-square divergence that passes",
              {.unit = "1/s", .range = not_negative, .when = fluid});
  table.value("momentum", verify.momentum,
              "Largest change of the momentum that passes, relative to sqrt(2 mass energy)",
              {.range = not_negative, .when = fluid});
  table.value("energy_growth", verify.energy_growth,
              "Largest rise of the kinetic energy above its least value in the steps before that passes, "
              "relative to the initial energy",
              {.range = not_negative, .when = fluid});
  table.value("speed_growth", verify.speed_growth,
              "Largest speed after any step over the initial one, less 1, that passes",
              {.range = not_negative, .when = fluid});
  table.optional_table("dissipation_peak", verify.dissipation_peak, declare_dissipation_peak,
                       "The largest rate at which the kinetic energy falls in a step", {.when = fluid});
  table.tables("kinetic_energy_curve", verify.kinetic_energy_curves,
               [](Table& curve, Curve& value) { declare_curve(curve, value, "J", "kinetic energies"); },
               "Kinetic energies at times, by cubic interpolation between the rows of the history",
               {.when = fluid});
  table.tables("dissipation_curve", verify.dissipation_curves,
               [](Table& curve, Curve& value) {
                 declare_curve(curve, value, "W", "rates at which the kinetic energy falls");
               },
               "Rates at which the kinetic energy falls, by the derivative of that interpolation",
               {.when = fluid});
  table.tables("leak", verify.leaks, declare_leak,
               "Mean flow through canopies over mean speed far upstream and mean projected area, means over "
               "rows",
               {.when = fluid});
  table.tables("peak_force", verify.peak_forces, declare_peak_force,
               "Largest forces of the lines on payloads after any step");
  table.value("force_balance", verify.force_balance,
              "Largest difference of the total force on the grid from that of the sheets on the fluid that "
              "passes, relative to the sum of the magnitudes, at rows of the history",
              {.range = not_negative, .when = fluid});
  table.value("intersections", verify.intersections,
              "Largest number of intersections of sheets and lines with sheets that passes, at rows of the "
              "history",
              {.range = not_negative});
  table.tables("profile", verify.profiles, declare_profile, "Velocities along lines at the end",
               {.when = fluid});
  table.value(
      "energy_drift", verify.energy_drift,
      "Largest change of the kinetic, elastic and potential energy in rows of the history that "
      "passes, relative to the largest sum of the first two",
      {.range = not_negative, .when = {[&scene] { return !scene.has_fluid(); }, "without [fluid]", "fluid"}});
  framework::declare_history_checks(table, verify.history);
  declare_former_keys(table);
}

}  // namespace drogue::parachute_app
