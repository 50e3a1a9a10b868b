#include "miniapps/parachute/verify/flight.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "miniapps/parachute/scene/run_size.hpp"
#include "miniapps/parachute/simulation/history_columns.hpp"
#include "tests/support/held_canopy.hpp"

namespace drogue::parachute_app {
namespace {

const std::vector<std::string> falling = {"canopy[0].payload={mass=90}", "coupling.gravity=[0,0,-9.81]"};

/// Solver of cloth that has seen a largest force.
struct Watched {
  fabric::PeakPull peak;
  void watch_pulls(const std::vector<fabric::Pull>&) {}
  [[nodiscard]] std::vector<fabric::PeakPull> peak_pulls() const { return {peak}; }
};

PeakPulls peaks_of(fabric::PeakPull peak) {
  PeakPulls peaks(1, true);
  Watched solver{peak};
  peaks.update(solver);
  return peaks;
}

/// History of 401 rows in 4 s in which all columns are 0, but for those given as functions of t.
run::History history_of(const FlowScene& scene,
                        const std::map<std::string, std::function<double(double)>>& columns) {
  run::History history;
  for (const run::Column& column : history_columns(scene)) history[column.name].resize(401);
  for (int k = 0; k <= 400; ++k) {
    const double t = 0.01 * k;
    history["time"].push_back(t);
    for (const auto& [name, value] : columns) history.at(name)[static_cast<std::size_t>(k)] = value(t);
  }
  return history;
}

std::map<std::string, double> described(const FlowScene& scene, const run::History& history,
                                        fabric::PeakPull peak = {}) {
  run::ResultDocument result;
  describe_flights(scene, peaks_of(peak), history, result);
  std::map<std::string, double> values;
  for (const run::Metrics::Group& group : result.metrics.groups())
    for (const auto& [name, value] : group.values) values[group.name + "." + name] = std::get<double>(value);
  return values;
}

const double nominal = std::numbers::pi / 4.0 * 8.534 * 8.534;

TEST(Flight, OfAHeldCanopyHasDragAndOpening) {
  const FlowScene scene = SceneFile().read();
  // C_D0 0.8 after the opening; the area grows from 5 to 25 m^2 within 1 s.
  const double force = 0.8 * 0.5 * 1.25 * 100.0 * nominal;
  const auto values = described(
      scene,
      history_of(scene, {{"canopy_0_force_z", [&](double t) { return t < 1.5 ? 9.9 * force : force; }},
                         {"canopy_0_projected_area", [](double t) { return 5.0 + 20.0 * std::min(t, 1.0); }},
                         {"canopy_0_airspeed", [](double) { return 10.0; }},
                         {"canopy_0_leak", [](double) { return 2.5; }}}),
      {9000.0, 0.7125});
  EXPECT_EQ(values.at("canopy_0.from"), 2.0);
  EXPECT_NEAR(values.at("canopy_0.drag_coefficient"), 0.8, 1e-12);
  EXPECT_NEAR(values.at("canopy_0.drag_coefficient_error"), 0.0, 1e-12);
  EXPECT_NEAR(values.at("canopy_0.drag_coefficient_free_air"), 0.8 / (1.0 + 1.85 * 0.8 * nominal / 1296.0),
              1e-12);
  EXPECT_NEAR(values.at("canopy_0.inflated_diameter_ratio"), std::sqrt(25.0 / nominal), 1e-12);
  EXPECT_NEAR(values.at("canopy_0.leak"), 0.01, 1e-12);
  EXPECT_NEAR(values.at("canopy_0.opening_time"), 1.0, 1e-9);
  EXPECT_EQ(values.at("canopy_0.peak_line_force"), 9000.0);
  EXPECT_EQ(values.at("canopy_0.peak_line_force_time"), 0.7125) << "between rows";
  EXPECT_FALSE(values.contains("canopy_0.rate_of_descent"));
  EXPECT_FALSE(values.contains("canopy_0.drift"));
}

TEST(Flight, OfAFallingPayloadHasRateOfDescentAndDrift) {
  const FlowScene scene = SceneFile().read(falling);
  // Falls with 6 m/s through air that rises with 10 m/s in the frame of the scene: the payload rises with 4
  // m/s.
  const double force = 0.7 * 0.5 * 1.25 * 36.0 * nominal;
  const run::History history =
      history_of(scene, {{"canopy_0_payload_velocity_z", [](double t) { return 4.0 + std::sin(100.0 * t); }},
                         {"canopy_0_payload_velocity_x", [](double t) { return t < 3.0 ? 3.0 : -3.0; }},
                         {"canopy_0_force_z", [&](double) { return force; }}});
  const auto values = described(scene, history);
  EXPECT_NEAR(values.at("canopy_0.rate_of_descent"), 6.0, 1e-2);
  EXPECT_LT(values.at("canopy_0.rate_of_descent_error"), 0.05);
  EXPECT_NEAR(values.at("canopy_0.drift"), 3.0, 0.02) << "mean speed, whatever its direction";
  EXPECT_NEAR(values.at("canopy_0.drag_coefficient"), 0.7, 0.01);
  EXPECT_FALSE(values.contains("canopy_0.rate_of_descent_free_air")) << "it glides";
  FlowScene guided = scene;
  guided.canopies[0].payload.guided = true;
  const auto on_axis = described(guided, history);
  const double ratio =
      std::pow(on_axis.at("canopy_0.rate_of_descent_free_air") / on_axis.at("canopy_0.rate_of_descent"), 2);
  EXPECT_NEAR(ratio, 1.0 + 1.85 * 0.7 * nominal / 1296.0, 1e-3);
  EXPECT_FALSE(values.contains("canopy_0.opening_time")) << "its area is 0";
  EXPECT_FALSE(values.contains("canopy_0.peak_line_force")) << "none was recorded";
}

TEST(Flight, CorrectsNoBlockageThatIsTooLarge) {
  const FlowScene scene = SceneFile().read();
  const auto has_free_air = [&](double drag) {
    const double force = drag * 0.5 * 1.25 * 100.0 * nominal;
    return described(scene, history_of(scene, {{"canopy_0_force_z", [&](double) { return force; }}}))
        .contains("canopy_0.drag_coefficient_free_air");
  };
  const double largest = 0.3 * 1296.0 / (1.85 * nominal);
  EXPECT_TRUE(has_free_air(0.99 * largest));
  EXPECT_FALSE(has_free_air(1.01 * largest));
}

TEST(Flight, WarnsOfALeanBeyondTheRoomInTheCore) {
  // 7 m of lines: 5.7 m to each side at 30 degrees, 6.9 m at 57, of 7.6 m less two cells.
  const FlowScene scene = SceneFile().read(
      {"grid={core=[[-7.6,7.6],[-7.6,7.6],[-9,8]], spacing=0.4, domain=[[-18,18],[-18,18],[-18,18]], "
       "boundary={x=\"slip\", y=\"slip\", z=[\"inflow\", \"outflow\"]}}"});
  ASSERT_TRUE(scene.notices.empty()) << scene.notices.front();
  const auto warnings = [&](double lean) {
    run::ResultDocument result;
    describe_flights(
        scene, peaks_of({}),
        history_of(scene, {{"canopy_0_lean", [&](double t) { return t > 0.5 && t < 1.0 ? lean : 3.0; }}}),
        result);
    EXPECT_EQ(result.metrics.real("canopy_0", "largest_lean"), lean);
    return result.warnings;
  };
  EXPECT_TRUE(warnings(33.0).empty()) << "it has room";
  ASSERT_EQ(warnings(57.0).size(), 1U);
  EXPECT_TRUE(warnings(57.0).front().starts_with("grid.core leaves canopy[0] 6.8")) << warnings(57.0).front();
  EXPECT_NE(warnings(57.0).front().find("one that leans by 57 degrees, as it did in this run, needs "),
            std::string::npos);
}

TEST(Flight, WarnsOfALargestForceAtTheEnd) {
  const FlowScene scene = SceneFile().read();
  const auto warnings = [&](double time) {
    run::ResultDocument result;
    describe_flights(scene, peaks_of({9000.0, time}), {}, result);
    return result.warnings;
  };
  EXPECT_TRUE(warnings(0.9 * scene.end_time).empty());
  ASSERT_EQ(warnings(scene.end_time).size(), 1U);
  EXPECT_TRUE(warnings(scene.end_time)[0].starts_with("canopy[0]: the largest line force"))
      << warnings(scene.end_time)[0];
}

TEST(Flight, WarnsOfALargestForceOfTheStart) {
  const FlowScene scene = SceneFile().read();
  const auto warnings = [&](double time) {
    run::ResultDocument result;
    describe_flights(scene, peaks_of({9000.0, time}),
                     history_of(scene, {{"canopy_0_airspeed", [](double) { return 10.0; }}}), result);
    return result.warnings;
  };
  const double diameter = std::sqrt(4.0 / std::numbers::pi * nominal);
  EXPECT_TRUE(warnings(0.0051 * diameter).empty());
  ASSERT_EQ(warnings(0.0049 * diameter).size(), 1U);
  EXPECT_TRUE(warnings(0.0049 * diameter)[0].starts_with(
      "canopy[0]: the largest line force is that of the start, 0.0418 s"))
      << warnings(0.0049 * diameter)[0];
}

TEST(Flight, WithoutRowsHasThePeakAlone) {
  const FlowScene scene = SceneFile().read({"output.history_every=0"});
  const auto values = described(scene, {}, {10.0, 1.0});
  EXPECT_EQ(values.size(), 2U);
  EXPECT_EQ(values.at("canopy_0.peak_line_force"), 10.0);
}

TEST(Flight, MeansBeginAfterTheReefingLineIsCut) {
  const FlowScene scene = SceneFile().read(
      {"canopy[0].shape=\"partly-closed\"", "canopy[0].closure=0.3", "canopy[0].reefing={length=12, cut=3}"});
  EXPECT_EQ(described(scene, history_of(scene, {})).at("canopy_0.from"), 3.5);
}

TEST(Flight, ReportPrintsWhatThereIs) {
  run::ResultDocument result;
  result.metrics.set("canopy_0", "from", 2.0);
  result.metrics.set("canopy_0", "drag_coefficient", 0.8123);
  result.metrics.set("canopy_0", "drag_coefficient_error", 0.0251);
  result.metrics.set("canopy_0", "inflated_diameter_ratio", 0.6712);
  result.metrics.set("canopy_0", "peak_line_force", 10034.0);
  result.metrics.set("canopies", "vertices", std::int64_t{3});
  result.metrics.set("figure_of_merit", "simulated_s_per_s", 0.3305);
  EXPECT_EQ(flight_report(result),
            "  0.331 s of flight per second of steps\n"
            "canopy[0], means from 2 s on; +- is 95 % by the scatter in this run\n"
            "  C_D0                              0.812 +- 0.025\n"
            "  D_p/D_0                           0.6712  (no error bar: too short a run, or a drift)\n"
            "  peak line force, N                10030\n");
  EXPECT_EQ(flight_title("canopy_1.peak_line_force"), "canopy[1] peak line force, N");
  EXPECT_EQ(flight_title("body_0_force_x_mean"), "body_0_force_x_mean");
  EXPECT_EQ(flight_report({}), "");
}

TEST(Drop, SetsVelocityRelativeToTheAirAndGravity) {
  const SceneFile file;
  const FlowScene scene =
      file.read({"canopy[0].payload={mass=90}", "drop={speed=20, angle=30}", "fluid.velocity=[1,0,5]"});
  EXPECT_EQ(scene.gravity, (std::array<double, 3>{0.0, 0.0, -9.81}));
  const fabric::Vector velocity = scene.canopies[0].start_velocity;
  EXPECT_NEAR(velocity[0], 1.0 + 20.0 * std::cos(std::numbers::pi / 6.0), 1e-12);
  EXPECT_EQ(velocity[1], 0.0);
  EXPECT_NEAR(velocity[2], 5.0 - 10.0, 1e-12);
  const Sheets sheets = make_all_sheets({}, scene.canopies, 1.0, 1.0);
  EXPECT_EQ(sheets.velocities.size(), sheets.positions.size());
  for (const fabric::Vector& each : sheets.velocities) EXPECT_EQ(each, velocity);
  // Straight down unless given, through the stream.
  EXPECT_EQ(file.read({"canopy[0].payload={mass=90}", "drop={speed=10}"}).canopies[0].start_velocity,
            (fabric::Vector{0.0, 0.0, 0.0}));
  EXPECT_GT(scene.parameters.max_dt, 0.0);
  EXPECT_LE(scene.parameters.max_dt, scene.cfl() * 0.4 / 17.3) << "steps resolve the speed of the drop";
}

TEST(Drop, ResolvesToItself) {
  const SceneFile file;
  const FlowScene scene = file.read({"canopy[0].payload={mass=90}", "drop={speed=20, angle=30, height=300}"});
  const std::string printed = print_flow_scene(scene);
  std::ofstream(file.path()) << printed;
  EXPECT_EQ(print_flow_scene(file.read()), printed);
}

TEST(Drop, VelocityOfThePayloadIsThatOfItsCanopies) {
  const FlowScene scene = SceneFile().read({"canopy[0].payload={mass=90, guided=true, velocity=[0,0,-4]}"});
  const Sheets sheets = make_all_sheets({}, scene.canopies, 1.0, 1.0);
  EXPECT_EQ(sheets.velocities.front(), (fabric::Vector{0.0, 0.0, -4.0}));
  EXPECT_EQ(sheets.velocities.back(), (fabric::Vector{0.0, 0.0, -4.0})) << "along the wire";
}

TEST(Drop, ThatStartsFromRestIsEstimatedAtTheSpeedOfItsDescent) {
  const SceneFile file;
  const std::vector<std::string> sets = {falling[0], falling[1], "fluid.velocity=[0,0,0]"};
  // 90 kg on 57 m^2 descend with 5.74 m/s; steps of half a cell of 0.4 m at 2.5 times that.
  const double speed = std::sqrt(2.0 * 90.0 * 9.81 / (0.75 * 1.25 * nominal));
  EXPECT_EQ(run_size(file.read(sets)).steps, std::ceil(4.0 * 2.5 * speed / (0.5 * 0.4)));
  EXPECT_NE(run_size_report(file.read(sets)).find("the speed of the start or the descent"),
            std::string::npos);
}

TEST(Drop, HasATouchDown) {
  const FlowScene scene = SceneFile().read({"canopy[0].payload={mass=90}", "drop={speed=10, height=9}"});
  const auto fall = [](double t) {
    return 10.0 - 2.0 * t;
  };  // the air rises with 10 m/s; falls with 2 t: t^2 m
  const auto values = described(scene, history_of(scene, {{"canopy_0_payload_velocity_z", fall}}));
  EXPECT_NEAR(values.at("canopy_0.touchdown_time"), 3.0, 1e-4);
  EXPECT_NEAR(values.at("canopy_0.touchdown_speed"), 6.0, 1e-3);
}

TEST(Drop, RefusesWhatDoesNotFall) {
  const SceneFile file;
  const auto refused = [&](const std::vector<std::string>& sets, const std::string& part) {
    EXPECT_NE(file.refusal(sets).find(part), std::string::npos) << file.refusal(sets);
  };
  const std::string free = "canopy[0].payload={mass=90}", drop = "drop={speed=20, angle=30}";
  refused({drop}, "canopy[0].payload.fixed = true: it does not fall");
  refused({free, "drop={angle=30}"}, "missing key \"drop.speed\"");
  refused({free, "drop={speed=3, hight=30}"}, "unknown key \"drop.hight\"; did you mean \"height\"?");
  refused({free, "drop={speed=-3}"}, "drop.speed");
  refused({free, "drop={speed=3, angle=120}"}, "drop.angle");
  refused({free, drop, "coupling.gravity=[1,0,-9.81]"}, "drop needs a coupling.gravity along z");
  refused({free, drop, "fluid.velocity=[0,0,\"5*t\"]"}, "does not vary");
  refused({"canopy[0].payload={mass=90, guided=true}", drop}, "keeps the payload on a path of 90 degrees");
  refused({"canopy[0].payload={mass=90, velocity=[1,0,0]}", drop}, "payload.velocity");
  refused({"canopy[0].payload={mass=90, guided=true, velocity=[1,0,0]}"},
          "canopy[0].payload.velocity is not along z");
  refused({"canopy[0].payload={fixed=true, velocity=[0,0,1]}"}, "payload.velocity");
}

}  // namespace
}  // namespace drogue::parachute_app
