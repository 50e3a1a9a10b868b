#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "common/scene/library.hpp"
#include "miniapps/parachute/scene/exchange.hpp"
#include "miniapps/parachute/scene/scene.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/temporary_file.hpp"

namespace drogue::parachute_app {
namespace {

const std::filesystem::path source = DROGUE_SOURCE_DIR;

const char* const least = R"(app = "parachute"
[fluid]
[grid]
cells = [8, 6, 4]
domain = [[0, 2], [0, 1], [0, 1]]
boundary = { x = ["inflow", "outflow"], y = "slip", z = "periodic" }
[run]
end_time = 1
)";

FlowScene read_text(const std::string& text, const std::vector<std::string>& sets = {}) {
  return read_flow_scene(testing::TemporaryFile(text).path(), sets);
}

std::string fingerprint_of(const FlowScene& scene) { return framework::fingerprint(scene_identity(scene)); }

std::string error_of(const std::vector<std::string>& sets) {
  return testing::refusal_of([&] { return read_text(least, sets); });
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(FlowScene, MinimalSceneHasTheDocumentedDefaults) {
  const FlowScene scene = read_text(least);
  const flow::Parameters& p = scene.parameters;
  EXPECT_EQ(p.cells, (std::array<int, 3>{8, 6, 4}));
  EXPECT_EQ(p.high, (std::array<double, 3>{2.0, 1.0, 1.0}));
  EXPECT_EQ(p.density, 1.225);
  EXPECT_EQ(p.viscosity, 1.8e-5);
  EXPECT_EQ(p.advection, flow::Advection::weno_z);
  EXPECT_EQ(p.time_scheme, flow::TimeScheme::rk3);
  EXPECT_EQ(p.diffusion, flow::Diffusion::explicit_);
  EXPECT_EQ(p.turbulence, flow::Turbulence::none);
  EXPECT_EQ(p.pressure_solver, flow::PressureSolver::automatic);
  EXPECT_EQ(p.fixed_dt, 0.0);
  EXPECT_EQ(p.cfl, 0.0);
  EXPECT_EQ(p.max_dt, 0.0);
  EXPECT_TRUE(scene.output.fields.empty());
}

TEST(FlowScene, SidesTakeTheVelocityOfTheFluidOrTheirWall) {
  using enum flow::BoundaryKind;
  const FlowScene scene =
      read_text(least, {"fluid.velocity=[2, 0.5, 0]", "grid.boundary.y=[\"wall\", \"slip\"]",
                        "grid.wall_velocity.y_low=[\"sin(t)\", 0, 1]"});
  const auto& sides = scene.parameters.boundary;
  const flow::BoundaryKind kinds[] = {inflow, outflow, wall, slip, periodic, periodic};
  for (std::size_t side = 0; side < 6; ++side) EXPECT_EQ(sides[side].kind, kinds[side]) << side_names[side];
  EXPECT_EQ(sides[0].velocity, (std::array<double, 3>{2.0, 0.5, 0.0}));
  EXPECT_TRUE(sides[0].velocity_expressions.empty());
  EXPECT_EQ(sides[2].velocity_expressions.size(), 3U);
  EXPECT_EQ(sides[3].velocity, (std::array<double, 3>{}));
}

TEST(FlowScene, InitialVelocityReplacesThatOfTheFluid) {
  const FlowScene scene = read_text(least, {"fluid.velocity=[1, 0, 0]", "initial.velocity=[0, \"x\", 0]"});
  EXPECT_EQ(scene.initial_velocity()[1], "x");
  EXPECT_EQ(read_text(least, {"fluid.velocity=[1, 0, 0]"}).initial_velocity()[0], "1.0");
}

TEST(FlowScene, AxisWithOneCellIsPeriodicByDefault) {
  const std::string sides = "grid.boundary={x=\"slip\",y=\"wall\"}";
  const FlowScene scene = read_text(least, {"grid.cells=[8, 6, 1]", sides});
  EXPECT_EQ(scene.parameters.boundary[5].kind, flow::BoundaryKind::periodic);
  EXPECT_TRUE(contains(error_of({sides}), "missing key \"grid.boundary.z\""));
  EXPECT_TRUE(contains(error_of({"grid.cells=[8, 6, 1]", "grid.boundary.z=\"wall\""}), "periodic or slip"));
}

TEST(FlowScene, EveryShippedSceneResolvesToItself) {
  const auto scenes = scene::list_scenes(source / "miniapps/parachute/scenes");
  ASSERT_GE(scenes.size(), 12U);
  for (const auto& entry : scenes) {
    EXPECT_FALSE(entry.description.empty()) << entry.name;
    // Full scenes differ from small ones in numbers only, and take long to check.
    if (entry.name.ends_with("-full")) continue;
    const std::string printed = print_flow_scene(read_flow_scene(entry.file));
    EXPECT_EQ(print_flow_scene(read_text(printed)), printed) << entry.name;
  }
}

TEST(FlowScene, OmitsInapplicableKeys) {
  const std::string printed = print_flow_scene(read_text(least));
  for (const char* key : {"wall_velocity", "pressure_tolerance", "turbulence_constant", "max_dt", "[verify]",
                          "[tuning]", "[initial]"})
    EXPECT_FALSE(contains(printed, key)) << key;
  EXPECT_TRUE(contains(printed, "weno = \"z\"\n"));
  EXPECT_TRUE(contains(printed, "frame = \"fixed\"\n"));
  EXPECT_TRUE(contains(printed, "time = \"rk3\"\n"));
  EXPECT_TRUE(contains(printed, "dt = \"auto\"\n"));
  EXPECT_TRUE(contains(print_flow_scene(read_text(least, {"run.cfl=0.4"})), "cfl = 0.4\n"));
  const std::string central = print_flow_scene(read_text(least, {"flow.advection=central", "run.dt=0.01"}));
  EXPECT_FALSE(contains(central, "weno"));
  EXPECT_FALSE(contains(central, "cfl"));
}

TEST(FlowScene, PrintsDefaultsThatFollowFromOtherKeys) {
  EXPECT_TRUE(contains(print_flow_scene(read_text(least)), "cfl = 1.0\n"));
  EXPECT_TRUE(contains(print_flow_scene(read_text(least, {"flow.time=ab2"})), "cfl = 0.5\n"));
  for (const auto& [model, constant] : {std::pair{"smagorinsky", "0.17"}, std::pair{"vreman", "0.07"}})
    EXPECT_TRUE(contains(print_flow_scene(read_text(least, {std::string("flow.turbulence=") + model})),
                         std::string("turbulence_constant = ") + constant + "\n"));
}

TEST(FlowScene, SheetsThatTheFluidMovesBoundTheTimeStep) {
  // Half of the least width, 1/6 m, over the largest component of the stream, or sqrt(g h), or the speed of
  // the plate on its spring, and the step that resolves its frequency with 2.45 kg of fluid.
  const auto plate = [](const std::string& offset) {
    return "body=[{kind=\"plate\",normal=\"x\",centre=[1,0.5,0.5],lengths=[1,1],edge_length=0.1,mount="
           "{mass=2,stiffness=8,offset=" +
           offset + "}}]";
  };
  const std::string closed = "grid.boundary={x=\"periodic\",y=\"periodic\",z=\"periodic\"}";
  const auto max_dt = [&](std::vector<std::string> sets) {
    sets.push_back(closed);
    return read_text(least, sets).parameters.max_dt;
  };
  EXPECT_DOUBLE_EQ(max_dt({plate("0"), "fluid.velocity=[0,-5,2]"}), 0.1 / 6.0);
  EXPECT_DOUBLE_EQ(max_dt({plate("2"), "fluid.velocity=[0.1,0,0]"}), 0.5 / 6.0 / 4.0);
  const double resolved = std::sqrt(0.01 * 0.5 / (8.0 / 2.1 - 1.0) / (8.0 / (2.0 + 2.45)));
  for (const char* velocity : {"[1e-3,0,0]", "[\"3*t\",0,0]", "[0,0,0]"})
    EXPECT_DOUBLE_EQ(max_dt({plate("0"), std::string("fluid.velocity=") + velocity}), resolved);
  EXPECT_DOUBLE_EQ(max_dt({plate("0"), "run.end_time=0.01"}), 0.01);  // the end
  EXPECT_EQ(max_dt({plate("0"), "run.max_dt=0.01"}), 0.01);
  EXPECT_EQ(max_dt({plate("0"), "run.dt=0.01"}), 0.0);
  const std::string body = "body=[{kind=\"sphere\",centre=[1,0.5,0.5],radius=0.2,edge_length=0.1}]";
  const FlowScene scene = read_text(least, {body});
  EXPECT_TRUE(contains(print_flow_scene(scene), "cfl = 0.5\nmax_dt = 1.0"));
  EXPECT_EQ(fingerprint_of(scene), fingerprint_of(read_text(least, {body, "run.max_dt=0.01"})));
}

TEST(FlowScene, ImplicitDiffusionTakesItsTimeSchemeByItself) {
  const auto time = [](const std::vector<std::string>& sets) {
    return read_text(least, sets).parameters.time_scheme;
  };
  EXPECT_EQ(time({"flow.diffusion=crank-nicolson"}), flow::TimeScheme::ab2);
  EXPECT_EQ(time({}), flow::TimeScheme::rk3);
  EXPECT_TRUE(contains(error_of({"flow.diffusion=crank-nicolson", "flow.time=rk3"}), "needs flow.time"));
}

TEST(FlowScene, SheetsInImplicitDiffusionBoundTheTimeStep) {
  const std::string body =
                        "body=[{kind=\"sphere\",centre=[1,0.5,0.5],radius=0.2,edge_length=0.1,retraction=0}]",
                    implicit = "flow.diffusion=crank-nicolson", stiff = "fluid.viscosity=100";
  const auto max_dt = [&](const std::vector<std::string>& sets) {
    return read_text(least, sets).parameters.max_dt;
  };
  const double resolved = 1.225 / 100.0 / 36.0;  // the least width is 1/6 m
  EXPECT_DOUBLE_EQ(max_dt({body, implicit, stiff}), resolved);
  EXPECT_EQ(max_dt({body, stiff}), 1.0);
  EXPECT_EQ(max_dt({implicit, stiff}), 0.0);
  EXPECT_EQ(max_dt({body, implicit, "fluid.viscosity=0"}), 1.0);
  EXPECT_EQ(max_dt({body, implicit, stiff, "run.max_dt=0.1"}), 0.1);
  const auto notices = [&](const char* dt) { return read_text(least, {body, implicit, stiff, dt}).notices; };
  ASSERT_EQ(notices("run.max_dt=0.1").size(), 1U);
  EXPECT_TRUE(contains(notices("run.max_dt=0.1")[0], "run.max_dt = 0.1 s: viscosity spreads the force"));
  EXPECT_TRUE(contains(notices("run.dt=0.1")[0], "run.dt = 0.1 s: viscosity spreads the force"));
  EXPECT_TRUE(notices("run.dt=0.0006").empty());
}

/// Exchange with the fluid of a shipped scene.
coupling::SheetParameters exchange(const std::string& name, const std::vector<std::string>& sets = {}) {
  const FlowScene scene = read_flow_scene(source / "miniapps/parachute/scenes" / (name + ".toml"), sets);
  return exchange_parameters(scene, make_all_sheets(scene.bodies, scene.canopies, 1.0, 1.0, scene.flags));
}

TEST(FlowScene, CorrectsTheExchangeUnlessItIsPlain) {
  const coupling::SheetParameters all = exchange("c9-flat");
  EXPECT_EQ(all.leak_filter, 0.5);
  EXPECT_GT(all.edge_inset, 0.3);
  EXPECT_EQ(all.filter_of_vertex.size(), all.law_of_vertex.size());
  EXPECT_TRUE(all.filter_of_vertex.front().by_law);
  for (const char* name : {"flag", "disk-normal", "membrane-drum-in-air"})
    EXPECT_FALSE(exchange(name).filter_of_vertex.front().by_law) << name;
  EXPECT_EQ(exchange("flag").leak_filter, 0.0);
  EXPECT_EQ(exchange("cup").edge_inset, 0.0) << "it has a retraction";
  EXPECT_GT(exchange("cup", {"body[0].retraction=0"}).edge_inset, 0.3);
  const std::string plain = "coupling.corrections=plain";
  for (const coupling::SheetParameters& p :
       {exchange("c9-flat", {plain}), exchange("c9-heavy", {"coupling={method=\"explicit\"}"})}) {
    EXPECT_EQ(p.leak_filter, 0.0);
    EXPECT_EQ(p.edge_inset, 0.0);
    EXPECT_TRUE(p.filter_of_vertex.empty());
    EXPECT_EQ(p.filter, 0.5);
  }
  // Keys of their own replace parts of either.
  const coupling::SheetParameters some =
      exchange("c9-flat", {"coupling.filter=0.3", "coupling.edge_inset=0"});
  EXPECT_TRUE(some.filter_of_vertex.empty());
  EXPECT_EQ(some.filter, 0.3);
  EXPECT_EQ(some.edge_inset, 0.0);
  EXPECT_EQ(some.leak_filter, 0.5);
  EXPECT_EQ(exchange("c9-flat", {plain, "coupling.leak_filter=0.4"}).leak_filter, 0.4);
}

TEST(FlowScene, CourantNumberIsThatOfTheStreamOrTheRun) {
  const auto number = [](const std::vector<std::string>& sets) {
    return courant_number(read_flow_scene(source / "miniapps/parachute/scenes/c9-duct.toml", sets));
  };
  // 10 m/s and cells of 0.4 m.
  EXPECT_DOUBLE_EQ(number({"run.max_dt=0.001"}), 1.8 * 10.0 * 0.001 / 0.4);
  EXPECT_DOUBLE_EQ(number({"run.max_dt=0.1"}), 0.25);
  EXPECT_DOUBLE_EQ(number({"verify={}", "fluid.velocity=[0,0,0]", "run.cfl=0.4"}), 0.4);
}

TEST(FlowScene, NotesTheSchemeWhoseEnergyGrows) {
  const auto notes = [](const std::vector<std::string>& sets) {
    return read_text(least, sets).notices.size();
  };
  const std::string central = "flow.advection=central", still = "fluid.viscosity=0", ab2 = "flow.time=ab2";
  EXPECT_EQ(notes({central, still, ab2}), 1U);
  EXPECT_EQ(notes({central, still, "flow.diffusion=crank-nicolson"}), 1U);
  EXPECT_EQ(notes({central, still}), 0U);
  EXPECT_EQ(notes({still, ab2}), 0U);
  EXPECT_EQ(notes({central, ab2}), 0U);
}

TEST(FlowScene, RefusesStepsThatReachNoEnd) {
  EXPECT_TRUE(contains(error_of({"run.dt=1e-300"}), "run.max_steps"));
  EXPECT_TRUE(contains(error_of({"fluid.viscosity=1e12"}), "run.max_steps"));
  EXPECT_TRUE(contains(error_of({"fluid.density=1e-300"}), "run.max_steps"));
  EXPECT_EQ(error_of({"fluid.viscosity=1e12", "flow.diffusion=crank-nicolson"}), "");
  EXPECT_EQ(error_of({"run.dt=1e-300", "run.max_steps=7"}), "");
}

TEST(FlowScene, SceneWithoutFluidIsClothAlone) {
  const std::string drop =
      "app = \"parachute\"\n[[canopy]]\nkind = \"flat-circular\"\nedge_length = 0.5\n[run]\nend_time = 1\n";
  const FlowScene scene = read_text(drop, {"output.times=[1]", "verify.energy_drift=1e-3"});
  EXPECT_FALSE(scene.has_fluid());
  EXPECT_EQ(scene.output.fields, (std::vector<std::string>{"position", "von_mises"}));
  const std::string printed = print_flow_scene(scene);
  for (const char* absent :
       {"[fluid]", "[grid]", "[flow]", "porosity", "method", "cfl", "strength", "tuning"})
    EXPECT_FALSE(contains(printed, absent)) << absent;
  EXPECT_TRUE(contains(printed, "dt = \"auto\"\n"));
  EXPECT_TRUE(contains(printed, "energy_drift = 0.001\n"));
  EXPECT_EQ(print_flow_scene(read_text(printed)), printed);
  EXPECT_EQ(fingerprint_of(scene), fingerprint_of(read_text(drop, {"run.dt=1e-4"})));
  EXPECT_NE(fingerprint_of(scene), fingerprint_of(read_text(drop, {"coupling.gravity=[0,0,-1]"})));
  EXPECT_TRUE(read_text(least).has_fluid());
  EXPECT_THROW(read_text(drop, {"run.dt=1e-300"}), Failure) << "more steps than run.max_steps";
}

TEST(FlowScene, FingerprintIgnoresOutputAndSteps) {
  const std::string base = fingerprint_of(read_text(least));
  for (const char* set : {"run.end_time=2", "run.cfl=0.2", "run.dt=0.01", "output.history_every=3",
                          "verify.divergence=1", "tuning.step.driver=plain"})
    EXPECT_EQ(fingerprint_of(read_text(least, {set})), base) << set;
  for (const char* set : {"fluid.viscosity=1", "grid.cells=[8, 6, 8]", "flow.weno=js",
                          "fluid.velocity=[1, 0, 0]", "flow.body_force=[1, 0, 0]"})
    EXPECT_NE(fingerprint_of(read_text(least, {set})), base) << set;
}

TEST(FlowSceneDocument, MatchesTheDeclarations) {
  const std::filesystem::path page = source / "docs/scenes-parachute.md";
  if (std::getenv("DROGUE_UPDATE_DOCS") != nullptr) std::ofstream(page) << document_flow_scene();
  std::ostringstream written;
  written << std::ifstream(page).rdbuf();
  EXPECT_EQ(written.str(), document_flow_scene())
      << "after a change of the keys: DROGUE_UPDATE_DOCS=1 ctest -R FlowSceneDocument";
}

}  // namespace
}  // namespace drogue::parachute_app
