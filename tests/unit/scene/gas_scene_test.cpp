#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "common/scene/library.hpp"
#include "miniapps/gas/scene/scene.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/temporary_file.hpp"

namespace drogue::gas_app {
namespace {

const std::filesystem::path source = DROGUE_SOURCE_DIR;
const std::filesystem::path shipped = source / "miniapps/gas/scenes";

const std::string least =
    "app = \"gas\"\n[gas]\n[mesh]\n[initial]\n"
    "riemann = { left = { rho = 1, p = 1 }, right = { rho = 0.125, p = 0.1 } }\n[run]\nend_time = 0.4\n";

GasScene read_text(const std::string& text, const std::vector<std::string>& sets = {},
                   SchemeSource scheme = SchemeSource::scene) {
  return read_gas_scene(testing::TemporaryFile(text).path(), sets, scheme);
}

/// Message without the folder of the file.
std::string error_of(const std::vector<std::string>& sets, const std::string& text = least) {
  return testing::refusal_of([&] { return read_text(text, sets); });
}

bool holds(const std::string& text, const std::string& words) {
  return text.find(words) != std::string::npos;
}

TEST(GasScene, MinimalSceneHasTheDocumentedDefaults) {
  const GasScene scene = read_text(least);
  const gas::Parameters& parameters = scene.parameters;
  EXPECT_EQ(parameters.gamma, 1.4);
  EXPECT_EQ(parameters.cells, 200);
  EXPECT_EQ(parameters.x_min, -1.0);
  EXPECT_EQ(parameters.x_max, 1.0);
  EXPECT_EQ(parameters.weno, gas::Weno::z);
  EXPECT_EQ(parameters.weno_power, 1);
  EXPECT_EQ(parameters.splitting, gas::Splitting::lf_stencil);
  EXPECT_EQ(parameters.time_scheme, gas::TimeScheme::ssprk3);
  EXPECT_EQ(parameters.face_average, gas::FaceAverage::arithmetic);
  EXPECT_EQ(parameters.positivity, gas::Positivity::automatic);
  EXPECT_EQ(parameters.precision, gas::Precision::full);
  EXPECT_EQ(parameters.cfl, 0.6);
  EXPECT_EQ(parameters.ramp_steps, 20);
  EXPECT_EQ(parameters.fixed_dt, 0.0);
  EXPECT_EQ(parameters.max_steps, 1'000'000);
  EXPECT_EQ(parameters.block, 0);
  EXPECT_TRUE(scene.output.fields.empty());
  EXPECT_TRUE(scene.output.times.empty());
  EXPECT_EQ(scene.output.history_every, 10);
  EXPECT_FALSE(scene.verify.exact.has_value());
}

TEST(GasScene, EveryShippedSceneResolvesToItself) {
  const auto scenes = scene::list_scenes(shipped);
  ASSERT_GE(scenes.size(), 18U);
  for (const auto& entry : scenes) {
    EXPECT_FALSE(entry.description.empty()) << entry.name;
    for (const std::vector<std::string>& sets :
         {std::vector<std::string>{}, {"scheme.weno=js"}, {"scheme.fixed_dt=1e-4"}, {"output.fields=[]"}}) {
      const std::string printed = print_gas_scene(read_gas_scene(entry.file, sets));
      EXPECT_EQ(print_gas_scene(read_text(printed)), printed) << entry.name;
    }
  }
}

TEST(GasScene, OmitsInapplicableKeys) {
  EXPECT_TRUE(holds(print_gas_scene(read_text(least)), "weno_power = 1"));
  const std::string js = print_gas_scene(read_text(least, {"scheme.weno=js"}));
  EXPECT_FALSE(holds(js, "weno_power"));
  EXPECT_TRUE(holds(js, "cfl = 0.6\nramp_steps = 20\n"));
  EXPECT_FALSE(holds(js, "fixed_dt"));
  EXPECT_FALSE(holds(js, "times"));
  EXPECT_FALSE(holds(js, "[verify]"));
  EXPECT_FALSE(holds(js, "[tuning]"));
  const std::string fixed = print_gas_scene(read_text(least, {"scheme.fixed_dt=0.1"}));
  EXPECT_TRUE(holds(fixed, "fixed_dt = 0.1"));
  EXPECT_FALSE(holds(fixed, "cfl"));
  EXPECT_FALSE(holds(fixed, "ramp_steps"));
}

TEST(GasScene, NumbersSurvivePrinting) {
  const std::string third = "0.3333333333333333148";
  const GasScene scene = read_text(least, {"run.end_time=" + third, "mesh.domain=[-1e-7,123456789.125]"});
  const GasScene again = read_text(print_gas_scene(scene));
  EXPECT_EQ(again.end_time, 1.0 / 3.0);
  EXPECT_EQ(again.parameters.x_min, -1e-7);
  EXPECT_EQ(again.parameters.x_max, 123456789.125);
}

TEST(GasScene, CompletesTimesFromFieldsAndFieldsFromTimes) {
  EXPECT_EQ(read_text(least, {"output.fields=[\"p\"]"}).output.times, std::vector<double>{0.4});
  EXPECT_EQ(read_text(least, {"output.times=[0, 0.2]"}).output.fields,
            (std::vector<std::string>{"rho", "u", "p"}));
  EXPECT_TRUE(holds(error_of({"output.times=[0.1, 0.5]"}), "later than run.end_time = 0.4"));
  EXPECT_TRUE(holds(error_of({"output.times=[]", "output.fields=[\"u\"]"}), "output.times is empty"));
  EXPECT_TRUE(holds(error_of({"output.fields=[]", "output.times=[0.1]"}), "output.times"));
  EXPECT_TRUE(holds(error_of({"output.fields=[\"u\",\"u\"]"}), "twice"));
}

TEST(GasScene, BaselineSelectsTheSchemeOfShi) {
  const GasScene scene = read_text(least, {"scheme.weno_power=2"}, SchemeSource::baseline);
  EXPECT_EQ(scene.parameters.weno, gas::Weno::js);
  EXPECT_EQ(scene.parameters.splitting, gas::Splitting::lf_global);
  EXPECT_EQ(scene.parameters.face_average, gas::FaceAverage::conserved);
  EXPECT_EQ(scene.parameters.positivity, gas::Positivity::off);
  const std::string printed = print_gas_scene(scene);
  EXPECT_EQ(print_gas_scene(read_text(printed)), printed);
}

TEST(GasScene, ReferenceRunInheritsGasAndDomain) {
  const GasScene scene =
      read_text(least, {"verify.exact=reference", "verify.reference.cells=6400", "gas.gamma=1.5",
                        "boundary.left=reflecting", "scheme.weno=js", "verify.l1_density=0.1"});
  ASSERT_TRUE(scene.verify.reference.has_value());
  EXPECT_EQ(scene.verify.reference->cells, 6400);
  EXPECT_EQ(scene.verify.reference->gamma, 1.5);
  EXPECT_EQ(scene.verify.reference->left, gas::Boundary::reflecting);
  EXPECT_EQ(scene.verify.reference->weno, gas::Weno::z);
  EXPECT_EQ(scene.verify.tolerances.at("l1_density"), 0.1);
  EXPECT_TRUE(holds(error_of({"verify.exact=reference"}), "missing table \"verify.reference\""));
  const auto error_with = [](const std::string& cells) {
    return error_of({"verify.exact=reference", "verify.reference.cells=" + cells, "verify.l1_density=1"});
  };
  for (const char* cells : {"200", "250", "799"})
    EXPECT_TRUE(holds(error_with(cells), std::string(cells) + " is less than 4 times mesh.cells = 200"));
  EXPECT_EQ(error_with("800"), "");
  EXPECT_TRUE(holds(error_of({"verify.reference.cells=6400"}), "with exact = \"reference\""));
}

/// Rarefaction and shock of Sod's tube leave x = 0 at -1.18322 and 1.75216 m/s.
TEST(GasScene, RefusesAnExactRiemannSolutionThatTheEndsDisturb) {
  const auto error = [](std::vector<std::string> sets) {
    sets.emplace_back("verify.exact=riemann");
    return error_of(sets);
  };
  EXPECT_EQ(error({}), "");
  EXPECT_EQ(error({"run.end_time=2"}), "") << "waves leave through an outflow";
  EXPECT_TRUE(holds(error({"boundary.left=periodic", "boundary.right=periodic"}), "a second jump"));
  EXPECT_EQ(error({"boundary.left=reflecting", "run.end_time=0.845"}), "");
  EXPECT_TRUE(holds(error({"boundary.left=reflecting", "run.end_time=0.846"}), "from t = 0.84515"));
  EXPECT_EQ(error({"boundary.right=reflecting", "run.end_time=0.570"}), "");
  EXPECT_TRUE(holds(error({"boundary.right=reflecting", "run.end_time=0.571"}), "from t = 0.57072"));
  EXPECT_TRUE(holds(error({"boundary.left=reflecting", "initial.riemann.left.u=0.1"}), "from the start"));
  // A contact alone, which moves away from the wall.
  EXPECT_EQ(error({"boundary.left=reflecting", "run.end_time=9", "initial.riemann.right.p=1"}), "");
}

TEST(GasScene, NamesTheLineThatAMissingTableNeeds) {
  const std::string without_gas = least.substr(0, least.find("[gas]")) + least.substr(least.find("[mesh]"));
  EXPECT_TRUE(holds(error_of({}, without_gas), "missing table \"gas\": The gas; add the line [gas]"));
}

TEST(GasScene, TellsOfMoreStepsThanTheRunMayTake) {
  EXPECT_TRUE(
      holds(error_of({"scheme.fixed_dt=1e-300"}), "4e+299 steps to run.end_time, more than run.max_steps"));
  EXPECT_EQ(error_of({"scheme.fixed_dt=1e-300", "run.max_steps=7"}), "");
  EXPECT_EQ(error_of({"scheme.fixed_dt=1e-6"}), "");
  const auto notices = [](const std::vector<std::string>& sets) { return read_text(least, sets).notices; };
  const std::vector<std::string> found = notices({"run.end_time=1e5"});  // 0.006 m over 1.1832 m/s
  ASSERT_EQ(found.size(), 1U);
  EXPECT_TRUE(holds(found[0], "limits the first steps to 0.00507 s: 1.97e+07 steps")) << found[0];
  EXPECT_TRUE(notices({"run.end_time=1e5", "run.max_steps=7"}).empty());
  EXPECT_TRUE(notices({"run.end_time=5e3"}).empty());
}

TEST(GasScene, RefusesContradictions) {
  EXPECT_TRUE(holds(error_of({"scheme.weno=js", "scheme.weno_power=2"}), "with weno = \"z\""));
  EXPECT_TRUE(holds(error_of({"scheme.cfl=0.5", "scheme.fixed_dt=1e-3"}), "without fixed_dt"));
  EXPECT_TRUE(holds(error_of({"boundary.left=periodic"}), "needs boundary.right = \"periodic\""));
  EXPECT_TRUE(holds(error_of({"boundary.right=periodic"}), "needs boundary.left = \"periodic\""));
  EXPECT_TRUE(holds(error_of({"initial.riemann.x0=1"}), "not inside the domain [-1.0, 1.0]"));
  EXPECT_TRUE(holds(error_of({"verify.l1_density=1"}), "applies only with exact"));
  EXPECT_TRUE(holds(error_of({"verify.exact=advection"}), "needs initial.expression and periodic"));
  EXPECT_TRUE(holds(error_of({"initial.expression={rho=\"1\",p=\"1\"}", "verify.exact=riemann"}),
                    "needs initial.riemann"));
  EXPECT_EQ(error_of({"boundary.left=reflecting"}), "") << "nothing to compare with";
  EXPECT_TRUE(holds(error_of({"mesh.domain=[1, 1.0000000000001]"}), "cannot be divided"));
  EXPECT_TRUE(holds(error_of({"mesh.domain=[-1e308, 1e308]"}), "cannot be divided"));
}

TEST(GasScene, SplitPrecisionRefusesExtremePressures) {
  EXPECT_NO_THROW(read_text(least, {"scheme.precision=split", "initial.riemann.right.p=1.1e-11"}));
  const std::string message = error_of({"scheme.precision=split", "initial.riemann.right.p=0.9e-11"});
  EXPECT_TRUE(holds(message, "FP32"));
  EXPECT_TRUE(holds(message, "1e11"));
}

TEST(GasScene, RegionsCoverTheDomainInOrder) {
  const auto regions = [](const std::string& list) {
    return std::vector<std::string>{"initial.regions=[" + list + "]"};
  };
  const std::string state = "rho=1,p=1}";
  const GasScene scene =
      read_text(least, regions("{until=-0.5,rho=2,p=1},{until=0.5,rho=3,p=1},{rho=4,u=7,p=1}"));
  const InitialState initial(scene);
  EXPECT_EQ(initial(-0.75).rho, 2.0);
  EXPECT_EQ(initial(-0.5).rho, 3.0);
  EXPECT_EQ(initial(0.75).rho, 4.0);
  EXPECT_EQ(initial(0.75).u, 7.0);
  EXPECT_TRUE(
      holds(error_of(regions("{until=0.5," + state + ",{until=0.5," + state + ",{" + state)), "not greater"));
  EXPECT_TRUE(holds(error_of(regions("{" + state + ",{" + state)), "regions[0] needs \"until\""));
  EXPECT_TRUE(holds(error_of(regions("{until=0.5," + state)), "regions[0].until"));
  EXPECT_TRUE(holds(error_of(regions("{until=1.5," + state + ",{" + state)), "not inside the domain"));
}

TEST(GasScene, ChecksExpressionsInEveryCell) {
  const auto state = [](const std::string& rho, const std::string& p) {
    return std::vector<std::string>{"initial.expression={rho=\"" + rho + "\",p=\"" + p + "\"}"};
  };
  const InitialState initial(read_text(least, state("1 + 0.2*sin(pi*x)", "2*dx")));
  EXPECT_DOUBLE_EQ(initial(0.25).rho, 1.0 + 0.2 * std::sin(0.25 * M_PI));
  EXPECT_DOUBLE_EQ(initial(0.25).p, 0.02);
  EXPECT_EQ(initial(0.25).u, 0.0);
  const InitialState copy = initial;
  EXPECT_EQ(copy(0.1).rho, initial(0.1).rho);
  const std::string negative = error_of(state("x - 0.9", "1"));
  EXPECT_TRUE(holds(negative, "initial.expression.rho gives rho = -")) << negative;
  EXPECT_TRUE(holds(negative, "at x = -0.995 (cell 0)")) << negative;
  EXPECT_TRUE(holds(error_of(state("1", "x > 0.992 ? -1 : 1")), "(cell 199)"));
  EXPECT_TRUE(holds(error_of(state("1", "1/(x - x)")), "gives p = inf"));
  EXPECT_TRUE(holds(error_of(state("sqrt(x)", "1")), "nan"));
  EXPECT_TRUE(holds(error_of(state("1 + t", "1")), "at character 5: unknown name \"t\""));
  EXPECT_TRUE(holds(error_of(state("1", "1.7e308")), "FP64 does not hold"));
}

TEST(GasScene, ChecksLargeMeshesWithSeveralThreads) {
  const std::vector<std::string> sets = {"mesh.cells=1000000"};
  std::vector<std::string> bad = sets;
  bad.emplace_back("initial.expression={rho=\"1\",p=\"x > 0.5 ? 0.5 - x : 1\"}");
  EXPECT_TRUE(holds(error_of(bad), "(cell 750000)")) << error_of(bad);
  bad.back() = "initial.expression={rho=\"1\",p=\"1 + x/2\"}";
  EXPECT_NO_THROW(read_text(least, bad));
}

TEST(GasScene, AdvectionRequiresUniformFlow) {
  const std::vector<std::string> sets = {"boundary={left=\"periodic\",right=\"periodic\"}",
                                         "verify.exact=advection",
                                         "initial.expression={rho=\"2+x\",u=\"1\",p=\"1\"}"};
  EXPECT_NO_THROW(read_text(least, sets));
  EXPECT_TRUE(
      holds(error_of({sets[0], sets[1], "initial.expression={rho=\"1\",u=\"x\",p=\"1\"}"}), "do not vary"));
}

TEST(GasScene, AcceptsExactlyTheDocumentedMeshSizes) {
  EXPECT_EQ(read_text(least, {"mesh.cells=8"}).parameters.cells, 8);
  EXPECT_TRUE(holds(error_of({"mesh.cells=7"}), "8 .. 268435456"));
  EXPECT_TRUE(holds(error_of({"mesh.cells=268435457"}), "8 .. 268435456"));
  EXPECT_TRUE(holds(error_of({"gas.gamma=1"}), "> 1"));
}

TEST(GasSceneDocument, MatchesTheDeclarations) {
  const std::filesystem::path page = source / "docs/scenes-gas.md";
  if (std::getenv("DROGUE_UPDATE_DOCS") != nullptr) std::ofstream(page) << document_gas_scene();
  std::ostringstream written;
  written << std::ifstream(page).rdbuf();
  EXPECT_EQ(written.str(), document_gas_scene())
      << "after a change of the keys: DROGUE_UPDATE_DOCS=1 ctest -R GasSceneDocument";
}

TEST(ShippedScenes, BlastOfSedovHasItsEnergyOnEveryMesh) {
  for (const int cells : {8, 9, 200, 201}) {
    const GasScene scene = read_gas_scene(shipped / "sedov.toml", {"mesh.cells=" + std::to_string(cells)});
    const InitialState initial(scene);
    const gas::Parameters& p = scene.parameters;
    const double dx = (p.x_max - p.x_min) / cells;
    double energy = 0.0;
    for (int i = 0; i < cells; ++i) energy += initial(cell_centre(p, i)).p / (p.gamma - 1.0) * dx;
    EXPECT_NEAR(energy, 3.2e6, 1e-6) << cells;
  }
}

TEST(ShippedScenes, FindsScenesByName) {
  EXPECT_EQ(scene::find_scene("sod", shipped), shipped / "sod.toml");
  EXPECT_EQ(scene::find_scene((shipped / "sod.toml").string(), "nowhere"), shipped / "sod.toml");
  const auto find = [] { return scene::find_scene("sedow", shipped); };
  EXPECT_TRUE(holds(testing::refusal_of(find, ExitCode::usage), "did you mean \"sedov\"?"));
  EXPECT_TRUE(scene::list_scenes("no such folder").empty());
  EXPECT_TRUE(holds(scene::list_text(scene::list_scenes(shipped)), "\nsod "));
}

}  // namespace
}  // namespace drogue::gas_app
