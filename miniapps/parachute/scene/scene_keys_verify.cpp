#include "miniapps/parachute/scene/codecs.hpp"
#include "miniapps/parachute/scene/scene_keys.hpp"

namespace drogue::parachute_app {
namespace {

using scene::Table;

const std::vector<std::string> verified_place_and_time = {"x", "y", "z", "t"};

void declare_exact(Table& table, ExactSolution& exact) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    table
        .value(axis_names[axis],
               scene::real_or_expression_codec(exact.velocity[axis], verified_place_and_time),
               std::string("Velocity along ") + axis_names[axis])
        .unit("m/s")
        .required();
  table
      .value("pressure", scene::real_or_expression_codec(exact.pressure, verified_place_and_time),
             "Pressure, up to a constant unless a side is an outflow")
      .unit("Pa");
}

void declare_norms(Table& table, Verify& verify) {
  const auto has_velocity = [&verify] { return verify.exact.has_value(); };
  const auto has_pressure = [&verify] { return verify.exact && !verify.exact->pressure.empty(); };
  const std::pair<const char*, const char*> norms[] = {
      {"l1", "Mean absolute error"}, {"l2", "Root-mean-square error"}, {"linf", "Largest error"}};
  for (const auto& [norm, meaning] : norms) {
    const std::string velocity = std::string(norm) + "_velocity", pressure = std::string(norm) + "_pressure";
    table
        .value(velocity, scene::real_codec(verify.tolerances, velocity),
               std::string(meaning) + " of the velocity that passes")
        .unit("m/s")
        .at_least(0.0)
        .when(has_velocity, "with exact, which names what to compare with", "exact");
    table
        .value(pressure, scene::real_codec(verify.tolerances, pressure),
               std::string(meaning) + " of the pressure that passes")
        .unit("Pa")
        .at_least(0.0)
        .when(has_pressure, "with exact.pressure, which names what to compare with", "exact");
  }
}

void declare_extremum(Table& table, Extremum& extremum) {
  table.value("value", scene::real_codec(extremum.value), "Expected velocity").unit("m/s").required();
  table.value("tolerance", scene::real_codec(extremum.tolerance), "Largest deviation that passes")
      .unit("m/s")
      .at_least(0.0)
      .required();
  table.value("at", scene::real_codec(extremum.at), "Expected coordinate").unit("m");
  table.value("at_tolerance", scene::real_codec(extremum.at_tolerance), "Largest deviation of it that passes")
      .unit("m")
      .at_least(0.0)
      .when([&extremum] { return extremum.at.has_value(); }, "with at", "at")
      .required();
}

void declare_profile(Table& table, Profile& profile) {
  table.value("component", scene::choice_codec(profile.component, axis_choices), "Component of the velocity")
      .required();
  table.value("along", scene::choice_codec(profile.along, axis_choices), "Axis that the line is parallel to")
      .required();
  table.value("through", vector_codec(profile.through), "Point of the line").unit("m").required();
  table
      .value("points", points_codec(profile.points),
             "Coordinates along the line, m, and the expected velocities there")
      .unit("m/s");
  table
      .value("tolerance", scene::real_codec(profile.tolerance),
             "Largest deviation from the points that passes")
      .unit("m/s")
      .at_least(0.0)
      .when([&profile] { return !profile.points.empty(); }, "with points", "points")
      .required();
  table.optional_table("minimum", profile.minimum, declare_extremum, "The least velocity");
  table.optional_table("maximum", profile.maximum, declare_extremum, "The largest velocity");
}

void declare_curve(Table& table, Curve& curve, const std::string& unit, const std::string& quantity) {
  table.value("points", points_codec(curve.points), "Times, s, and the expected " + quantity)
      .unit(unit)
      .required();
  table
      .value("tolerance", scene::real_codec(curve.tolerance),
             "Largest deviation from one of them that passes, relative to the largest of them")
      .at_least(0.0)
      .required();
}

void declare_leak(Table& table, CanopyLeak& leak) {
  table.value("canopy", scene::integer_codec(leak.canopy), "Number of the [[canopy]], from 0").range(0, 1e6);
  table.value("from", scene::real_codec(leak.from), "Begin of the interval")
      .unit("s")
      .at_least(0.0)
      .required();
  table.value("to", scene::real_codec(leak.to), "End of the interval").unit("s").above(0.0).required();
  table
      .value("tolerance", scene::real_codec(leak.tolerance),
             "Largest ratio of the mean that passes; what flows in and out of a canopy that breathes cancels")
      .at_least(0.0)
      .required();
  table
      .value("rms_tolerance", scene::real_codec(leak.rms_tolerance),
             "Largest ratio of the root mean square that passes")
      .at_least(0.0);
}

void declare_dissipation_peak(Table& table, DissipationPeak& peak) {
  table.value("value", scene::real_codec(peak.value), "Expected value").unit("W").required();
  table.value("tolerance", scene::real_codec(peak.tolerance), "Largest relative deviation that passes")
      .at_least(0.0)
      .required();
  table.value("time", scene::real_codec(peak.time), "Expected time").unit("s");
  table.value("time_tolerance", scene::real_codec(peak.time_tolerance), "Largest deviation of it that passes")
      .unit("s")
      .at_least(0.0)
      .when([&peak] { return peak.time.has_value(); }, "with time", "time")
      .required();
}

void declare_peak_force(Table& table, CanopyPeak& peak) {
  table.value("canopy", scene::integer_codec(peak.canopy), "Number of the [[canopy]], from 0").range(0, 1e6);
  table
      .value("force", scene::interval_codec(peak.force[0], peak.force[1]),
             "Least and largest force that pass")
      .unit("N")
      .required();
  table.value("time", optional_pair_codec(peak.time), "Least and largest time of it that pass").unit("s");
}

void declare_canopy_checks(Table& table, Verify& verify) {
  table.tables("leak", verify.leaks, declare_leak,
               "Mean flow through canopies over mean speed far upstream and mean projected area, means over "
               "rows");
  table.tables("peak_force", verify.peak_forces, declare_peak_force,
               "Largest forces of the lines on payloads after any step");
  table
      .value("force_balance", scene::real_codec(verify.force_balance),
             "Largest difference of the total force on the grid from that of the sheets on the fluid that "
             "passes, relative to the sum of the magnitudes, at rows of the history")
      .at_least(0.0);
  table
      .value("intersections", scene::real_codec(verify.intersections),
             "Largest number of intersections of sheets and lines with sheets that passes, at rows of the "
             "history")
      .at_least(0.0);
}

/// Names keys of earlier versions, which were statistics of columns.
void declare_former_keys(Table& table) {
  const auto former = [&table](const char* name, const char* column, const char* statistic,
                               const char* more = "") {
    table.former(name, std::string("[[verify.history]] with column = ") + column + ", statistic = \"" +
                           statistic + "\"" + more + "; from, to, value and tolerance stay");
  };
  const char* const of_body = "\"body_0_force_x\", of the former body and axis";
  former("kinetic_energy", "\"kinetic_energy\"", "last");
  former("flow_rate", "\"outflow_x_low\", of the former side", "last");
  former("force", of_body, "last");
  former("mean_force", of_body, "mean");
  former("frequency", of_body, "frequency", " and the inverse of the former reference");
  former("oscillation", "its column", "frequency", " or \"amplitude\"");
  former("drag", "\"canopy_0_drag_coefficient\", of the former canopy", "mean");
  former("terminal_speed", "\"canopy_0_airspeed\", of the former canopy", "mean");
  former("projected_area", "\"canopy_0_projected_area\", of the former canopy", "mean");
}

}  // namespace

void declare_verify(Table& table, FlowScene& scene) {
  Verify& verify = scene.verify;
  table.optional_table("exact", verify.exact, declare_exact,
                       "Exact solution, compared at the end of the run");
  declare_norms(table, verify);
  table
      .value("divergence", scene::real_codec(verify.divergence),
             "Largest root-mean-square divergence that passes")
      .unit("1/s")
      .at_least(0.0);
  table
      .value("momentum", scene::real_codec(verify.momentum),
             "Largest change of the momentum that passes, relative to sqrt(2 mass energy)")
      .at_least(0.0);
  table
      .value("energy_growth", scene::real_codec(verify.energy_growth),
             "Largest rise of the kinetic energy above its least value in the steps before that passes, "
             "relative to the initial energy")
      .at_least(0.0);
  table
      .value("speed_growth", scene::real_codec(verify.speed_growth),
             "Largest speed after any step over the initial one, less 1, that passes")
      .at_least(0.0);
  table.optional_table("dissipation_peak", verify.dissipation_peak, declare_dissipation_peak,
                       "The largest rate at which the kinetic energy falls in a step");
  table.tables(
      "kinetic_energy_curve", verify.kinetic_energy_curves,
      [](Table& curve, Curve& value) { declare_curve(curve, value, "J", "kinetic energies"); },
      "Kinetic energies at times, by cubic interpolation between the rows of the history");
  table.tables(
      "dissipation_curve", verify.dissipation_curves,
      [](Table& curve, Curve& value) {
        declare_curve(curve, value, "W", "rates at which the kinetic energy falls");
      },
      "Rates at which the kinetic energy falls, by the derivative of that interpolation");
  declare_canopy_checks(table, verify);
  table.tables("profile", verify.profiles, declare_profile, "Velocities along lines at the end");
  for (const char* of_fluid :
       {"exact", "divergence", "momentum", "energy_growth", "speed_growth", "dissipation_peak",
        "kinetic_energy_curve", "dissipation_curve", "leak", "force_balance", "profile"})
    table.at(of_fluid).when(with_fluid(scene), fluid_condition, "");
  table
      .value("energy_drift", scene::real_codec(verify.energy_drift),
             "Largest change of the kinetic, elastic and potential energy in rows of the history that "
             "passes, relative to the largest sum of the first two")
      .at_least(0.0)
      .when([&scene] { return !scene.has_fluid(); }, "without [fluid]", "");
  framework::declare_history_checks(table, verify.history);
  declare_former_keys(table);
}

}  // namespace drogue::parachute_app
