#include "miniapps/parachute/scene/codecs.hpp"
#include "miniapps/parachute/scene/scene_keys.hpp"

namespace drogue::parachute_app {
namespace {

using scene::Choices;
using scene::Table;

const std::vector<std::string> verified_place_and_time = {"x", "y", "z", "t"};

const Choices<int> side_choices = {{"x_low", 0},  {"x_high", 1}, {"y_low", 2},
                                   {"y_high", 3}, {"z_low", 4},  {"z_high", 5}};

void declare_target(Table& table, Target& target, const std::string& unit, const std::string& tolerance) {
  table.value("value", scene::real_codec(target.value), "Expected value").unit(unit).required();
  table.value("tolerance", scene::real_codec(target.tolerance), tolerance).at_least(0.0).required();
}

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

/// Canopy and interval of a `CanopyMean` or a `CanopyLeak`.
template <class Interval>
void declare_interval(Table& table, Interval& mean) {
  table.value("canopy", scene::integer_codec(mean.canopy), "Number of the [[canopy]], from 0").range(0, 1e6);
  table.value("from", scene::real_codec(mean.from), "Begin of the interval")
      .unit("s")
      .at_least(0.0)
      .required();
  table.value("to", scene::real_codec(mean.to), "End of the interval").unit("s").above(0.0).required();
}

void declare_canopy_mean(Table& table, CanopyMean& mean, const std::string& unit) {
  declare_interval(table, mean);
  declare_target(table, mean.target, unit, "Largest relative deviation that passes");
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
  table.tables(
      "drag", verify.drags, [](Table& drag, CanopyMean& value) { declare_canopy_mean(drag, value, "1"); },
      "Mean drag coefficients 2 F / (rho U^2 S0) of canopies over rows, S0 the area of the flat cloth");
  table.tables(
      "terminal_speed", verify.terminal_speeds,
      [](Table& speed, CanopyMean& value) { declare_canopy_mean(speed, value, "m/s"); },
      "Mean speeds of the fluid far upstream relative to payloads over rows of the history");
  table.tables(
      "projected_area", verify.projected_areas,
      [](Table& area, CanopyMean& value) { declare_canopy_mean(area, value, "m^2"); },
      "Mean areas of the shadows of canopies along z over rows of the history");
  table.tables(
      "leak", verify.leaks,
      [](Table& leak, CanopyLeak& value) {
        declare_interval(leak, value);
        leak.value("tolerance", scene::real_codec(value.tolerance),
                   "Largest ratio of the mean that passes; what flows in and out of a canopy that breathes "
                   "cancels")
            .at_least(0.0)
            .required();
        leak.value("rms_tolerance", scene::real_codec(value.rms_tolerance),
                   "Largest ratio of the root mean square that passes")
            .at_least(0.0);
      },
      "Mean flow through canopies over mean speed far upstream and mean projected area, means over rows");
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

void declare_component(Table& table, int& body, int& axis) {
  table.value("body", scene::integer_codec(body), "Number of the [[body]], from 0").range(0, 1e6).required();
  table.value("axis", scene::choice_codec(axis, axis_choices), "Component").required();
}

/// `unit`: of the reference.
void declare_window(Table& table, ForceWindow& window, const std::string& reference,
                    const std::string& unit) {
  declare_component(table, window.body, window.axis);
  table
      .value("from", scene::real_codec(window.from),
             "Time of the first row of the history that counts; the last one counts always")
      .unit("s")
      .at_least(0.0);
  table.value("reference", scene::real_codec(window.reference), reference).unit(unit).above(0.0);
  declare_target(table, window.target, "", "Largest relative deviation that passes");
}

void declare_oscillation(Table& table, Oscillation& oscillation) {
  table
      .value(
          "column", scene::text_codec(oscillation.column),
          "Column of history.csv: the displacement of a body with a mount, or a coordinate of the payload of "
          "a canopy or of the tip of a flag, such as canopy_0_payload_z")
      .required();
  table
      .value("from", scene::real_codec(oscillation.from),
             "Time of the first row of the history that counts; the last one counts always")
      .unit("s")
      .at_least(0.0);
  const std::string deviation = "Largest relative deviation that passes";
  table.optional_table(
      "frequency", oscillation.frequency,
      [deviation](Table& target, Target& value) { declare_target(target, value, "1/s", deviation); },
      "The frequency at which the column crosses its mean upwards");
  table.optional_table(
      "amplitude", oscillation.amplitude,
      [deviation](Table& target, Target& value) { declare_target(target, value, "m", deviation); },
      "Half of the difference of the largest and the least value, each by a parabola through three rows");
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
  const std::string deviation = "Largest relative deviation that passes";
  table.optional_table(
      "kinetic_energy", verify.kinetic_energy,
      [deviation](Table& target, Target& value) { declare_target(target, value, "J", deviation); },
      "The kinetic energy at the end");
  table.optional_table(
      "dissipation_peak", verify.dissipation_peak,
      [deviation](Table& peak, DissipationPeak& value) {
        declare_target(peak, value.target, "W", deviation);
        peak.value("time", scene::real_codec(value.time), "Expected time").unit("s");
        peak.value("time_tolerance", scene::real_codec(value.time_tolerance),
                   "Largest deviation of it that passes")
            .unit("s")
            .at_least(0.0)
            .when([&value] { return value.time.has_value(); }, "with time", "time")
            .required();
      },
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
  table.tables(
      "flow_rate", verify.flow_rates,
      [deviation](Table& rate, FlowRate& value) {
        rate.value("side", scene::choice_codec(value.side, side_choices), "Side of the domain").required();
        declare_target(rate, value.target, "m^3/s", deviation);
      },
      "Flow rates out of the domain through sides at the end");
  table.tables(
      "force", verify.forces,
      [deviation](Table& force, BodyForce& value) {
        declare_component(force, value.body, value.axis);
        declare_target(force, value.target, "N", deviation);
      },
      "Forces of the fluid on bodies at the end");
  table.tables(
      "mean_force", verify.mean_forces,
      [](Table& window, ForceWindow& value) {
        declare_window(window, value,
                       "Force that the mean is divided by: half of density, squared speed and area for the "
                       "drag coefficient",
                       "N");
      },
      "Means of the forces of the fluid on bodies over the rows of the history from a time on");
  table.tables(
      "frequency", verify.frequencies,
      [](Table& window, ForceWindow& value) {
        declare_window(window, value,
                       "Time that the frequency is multiplied by: width over speed for the Strouhal number",
                       "s");
      },
      "Frequencies at which forces of the fluid on bodies cross their mean upwards in rows of the history");
  table.tables("oscillation", verify.oscillations, declare_oscillation,
               "Frequencies and amplitudes of places of sheets in rows of the history");
  declare_canopy_checks(table, verify);
  table.tables("profile", verify.profiles, declare_profile, "Velocities along lines at the end");
  for (const char* of_fluid :
       {"exact", "divergence", "momentum", "energy_growth", "speed_growth", "kinetic_energy",
        "dissipation_peak", "kinetic_energy_curve", "dissipation_curve", "flow_rate", "force", "mean_force",
        "frequency", "drag", "terminal_speed", "leak", "force_balance", "profile"})
    table.at(of_fluid).when(with_fluid(scene), fluid_condition, "");
  table
      .value("energy_drift", scene::real_codec(verify.energy_drift),
             "Largest change of the kinetic, elastic and potential energy in rows of the history that "
             "passes, relative to the largest sum of the first two")
      .at_least(0.0)
      .when([&scene] { return !scene.has_fluid(); }, "without [fluid]", "");
}

}  // namespace drogue::parachute_app
