#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "common/scene/library.hpp"
#include "miniapps/springs/scene/scene.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/temporary_file.hpp"

namespace drogue::springs_app {
namespace {

const std::filesystem::path source = DROGUE_SOURCE_DIR;
const std::filesystem::path shipped = source / "miniapps/springs/scenes";

const std::string least = "app = \"springs\"\n[mesh]\ndisk = {}\n[time]\nend_time = 1\n";
const std::string with_file = "app = \"springs\"\n[mesh]\nfile = \"m.obj\"\n[time]\nend_time = 1\n";
const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
const std::string rope = "v 0 0 0\nv 1 0 0\nv 3 0 0\nl 1 2 3\n";

SpringsScene read_text(const std::string& text, const std::vector<std::string>& sets = {},
                       const std::string& mesh = "") {
  const testing::TemporaryFile scene(text);
  if (!mesh.empty()) scene.add("m.obj", mesh);
  return read_springs_scene(scene.path(), sets);
}

std::string error_of(const std::vector<std::string>& sets, const std::string& text = least,
                     const std::string& mesh = "") {
  return testing::refusal_of([&] { return read_text(text, sets, mesh); });
}

bool holds(const std::string& text, const std::string& words) {
  return text.find(words) != std::string::npos;
}

TEST(SpringsScene, MinimalSceneHasTheDocumentedDefaults) {
  const SpringsScene scene = read_text(least);
  EXPECT_EQ(scene.fabric.material.model, fabric::Model::biquadratic);
  EXPECT_EQ(scene.fabric.material.membrane_modulus, 1000.0);
  EXPECT_EQ(scene.fabric.material.poisson, 0.3);
  EXPECT_EQ(scene.fabric.area_density, 0.756);
  EXPECT_EQ(scene.fabric.mass, fabric::Lumping::area);
  EXPECT_EQ(scene.time.integrator, fabric::Integrator::verlet);
  EXPECT_FALSE(scene.time.dt.has_value());
  EXPECT_EQ(scene.time.safety, 0.4);
  EXPECT_TRUE(scene.output.fields.empty());
  EXPECT_EQ(scene.mesh.rest.size(), 1027U);
}

TEST(SpringsScene, EveryShippedSceneResolvesToItself) {
  const auto scenes = scene::list_scenes(shipped);
  ASSERT_GE(scenes.size(), 4U);
  for (const auto& entry : scenes) {
    EXPECT_FALSE(entry.description.empty()) << entry.name;
    const std::string printed = print_springs_scene(read_springs_scene(entry.file));
    EXPECT_EQ(print_springs_scene(read_text(printed)), printed) << entry.name;
  }
}

TEST(SpringsScene, OmitsInapplicableKeys) {
  const std::string cloth = print_springs_scene(read_text(least));
  for (const char* key :
       {"model = ", "membrane_modulus", "poisson", "area_density", "safety", "dt = \"auto\""})
    EXPECT_TRUE(holds(cloth, key)) << key << cloth;
  for (const char* key : {"\nstiffness", "line_density", "prestretch = 1", "times", "[verify]"})
    EXPECT_FALSE(holds(cloth, key)) << key << cloth;
  EXPECT_FALSE(holds(cloth, "contact")) << cloth;
  EXPECT_TRUE(holds(print_springs_scene(read_text(least, {"contact.self=true"})), "self = true"));
  const std::string met = "contact.objects=[{kind=\"sphere\",centre=[0,0,-9],radius=1}]";
  EXPECT_TRUE(holds(print_springs_scene(read_text(least, {met})), "self = false"));
  const std::string edges = print_springs_scene(read_text(least, {"material.model=edge"}));
  EXPECT_TRUE(holds(edges, "\nstiffness = 1000.0"));
  EXPECT_FALSE(holds(edges, "membrane_modulus"));
  const std::string string = print_springs_scene(read_text(least, {"mesh.string={}"}));
  EXPECT_TRUE(holds(string, "axial_stiffness = 5000.0"));
  for (const char* key : {"model", "area_density", "disk"}) EXPECT_FALSE(holds(string, key)) << key;
  const std::string fixed = print_springs_scene(read_text(least, {"time.dt=1e-4"}));
  EXPECT_TRUE(holds(fixed, "dt = 1e-04"));
  EXPECT_FALSE(holds(fixed, "safety"));
}

TEST(SpringsScene, PressureRequiresConsistentOrientation) {
  const std::string half = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\n";
  // Three squares in a ring, the last turned over: a strip with one side.
  const std::string moebius =
      "v 1 0 -.2\nv 1 0 .2\nv -.5 .9 -.2\nv -.5 .9 .2\nv -.5 -.9 -.2\nv -.5 -.9 .2\n"
      "f 1 3 2\nf 2 3 4\nf 3 5 4\nf 4 5 6\nf 5 2 6\nf 6 2 1\n";
  for (const std::string load : {"pressure=\"1\"", "follower_pressure=\"t\""}) {
    const std::vector<std::string> sets = {"load=[{" + load + "}]"};
    EXPECT_EQ(error_of(sets, with_file, half + "f 1 3 4\n"), "");
    EXPECT_TRUE(holds(error_of(sets, with_file, half + "f 1 4 3\n"), "faces 0 and 1 of the mesh turn"));
    EXPECT_TRUE(holds(error_of(sets, with_file, moebius), "turn in opposite senses"));
    EXPECT_TRUE(holds(error_of(sets, with_file, moebius), "as a Moebius strip"));
  }
  EXPECT_EQ(error_of({}, with_file, moebius), "");
}

TEST(SpringsScene, PressureOnClosedClothNeedsOneSense) {
  const auto tetrahedron = [](double x, int first, bool inwards) {
    const auto vertex = [&](double a, double b, double c) {
      return "v " + std::to_string(x + a) + " " + std::to_string(b) + " " + std::to_string(c) + "\n";
    };
    std::string text = vertex(0, 0, 0) + vertex(1, 0, 0) + vertex(0, 1, 0) + vertex(0, 0, 1);
    for (std::array<int, 3> face :
         {std::array{0, 2, 1}, std::array{0, 1, 3}, std::array{1, 2, 3}, std::array{0, 3, 2}}) {
      if (inwards) std::swap(face[1], face[2]);
      text += "f";
      for (const int i : face) text += " " + std::to_string(first + i);
      text += "\n";
    }
    return text;
  };
  const std::vector<std::string> sets = {"load=[{follower_pressure=1}]"};
  EXPECT_EQ(error_of(sets, with_file, tetrahedron(0, 1, false) + tetrahedron(3, 5, false)), "");
  EXPECT_EQ(error_of(sets, with_file, tetrahedron(0, 1, true)), "");
  EXPECT_TRUE(holds(error_of(sets, with_file, tetrahedron(0, 1, false) + tetrahedron(3, 5, true)),
                    "the one with face 4 of the mesh point inwards, those of the one with face 0 outwards"));
}

TEST(SpringsScene, ScalesMeshFiles) {
  EXPECT_EQ(error_of({"mesh.scale=0.01"}, with_file, triangle), "");
  EXPECT_TRUE(holds(error_of({"mesh.scale=1e-300"}, with_file, triangle), "between 1e-60 and 1e60 m"));
  EXPECT_TRUE(holds(error_of({"mesh.scale=2"}), "mesh.scale"));
}

TEST(SpringsScene, AcceptsPinAxesInAnyOrder) {
  const auto axes = [](const std::string& text) {
    return read_text(least, {"pin=[{where=\"1\",axes=\"" + text + "\"}]"}).pins.at(0).axes;
  };
  EXPECT_EQ(axes("zyx"), "xyz");
  EXPECT_EQ(axes("zx"), "xz");
  EXPECT_TRUE(holds(error_of({"pin=[{where=\"1\",axes=\"xx\"}]"}), "\"xx\""));
}

TEST(SpringsScene, PrintsIntegersWithoutAPoint) {
  const SpringsScene drum = read_springs_scene(shipped / "drum.toml");
  EXPECT_TRUE(holds(print_springs_scene(drum), "mode = [0, 1]")) << print_springs_scene(drum);
}

TEST(SpringsScene, ResolvesFilesRelativeToTheScene) {
  const testing::TemporaryFile file(with_file);
  file.add("m.obj", triangle);
  const SpringsScene scene = read_springs_scene(file.path());
  EXPECT_EQ(scene.mesh.triangles.size(), 1U);
  const std::string printed = print_springs_scene(scene);
  EXPECT_EQ(print_springs_scene(read_text(printed)), printed) << "from another folder";
}

TEST(SpringsScene, MeshFileDecidesWhichKeysApply) {
  EXPECT_EQ(error_of({"material.poisson=0.2"}, with_file, triangle), "");
  EXPECT_TRUE(holds(error_of({"material.poisson=0.2"}, with_file, rope), "applies only with triangles"));
  EXPECT_TRUE(holds(error_of({"material.line_density=0.2"}, with_file, triangle), "applies only with lines"));
  EXPECT_FALSE(holds(print_springs_scene(read_text(with_file, {}, rope)), "poisson"));
  EXPECT_TRUE(holds(error_of({}, with_file), "there is no file"));
  EXPECT_TRUE(
      holds(error_of({}, with_file, triangle + "f 1 2 9\n"), "m.obj:5: face 2 of the file names vertex 9"));
}

TEST(SpringsScene, StringStiffnessAppliesPerEdge) {
  const SpringsScene scene = read_text(least, {"mesh.string={vertices=5}", "material.stiffness=100"});
  EXPECT_DOUBLE_EQ(scene.fabric.material.axial_stiffness, 25.0);
  const SpringsScene uneven = read_text(with_file, {"material.stiffness=5"}, rope);
  EXPECT_EQ(uneven.mesh.line_stiffness, (std::vector<double>{5.0, 10.0}));
}

TEST(SpringsScene, AcceptsAxialStiffnessOfStringsBesideEdges) {
  const std::string both = triangle + "v 0 0 -2\nl 1 4\n";
  const std::string edge = "material.model=edge", axial = "material.axial_stiffness=50",
                    stiffness = "material.stiffness=70";
  const SpringsScene scene = read_text(with_file, {edge, axial, stiffness}, both);
  EXPECT_EQ(scene.fabric.material.stiffness, 70.0);
  EXPECT_EQ(scene.fabric.material.axial_stiffness, 50.0);
  EXPECT_TRUE(scene.mesh.line_stiffness.empty());
  EXPECT_TRUE(holds(print_springs_scene(scene), "\naxial_stiffness = 50.0"));
  EXPECT_EQ(read_text(with_file, {edge, axial}, both).fabric.material.stiffness, 1000.0);
  const SpringsScene one = read_text(with_file, {edge, stiffness}, both);
  EXPECT_EQ(one.mesh.line_stiffness, std::vector<double>{140.0});
  EXPECT_FALSE(holds(print_springs_scene(one), "axial_stiffness"));
  EXPECT_TRUE(holds(error_of({axial, stiffness}, with_file, both), "without stiffness"));
  EXPECT_TRUE(holds(error_of({edge, axial, stiffness}, with_file, rope), "give one"));
}

TEST(SpringsScene, ReinforcementsBecomeLines) {
  const auto with = [](const std::string& list) {
    return std::vector<std::string>{"reinforcement=[" + list + "]"};
  };
  // Both edges of the triangle at its first corner; neither is a string of the mesh.
  const SpringsScene cloth = read_text(with_file,
                                       with("{where=\"y==0\",axial_stiffness=3,line_density=0.5},"
                                            "{where=\"x==0\",axial_stiffness=7}"),
                                       triangle);
  EXPECT_EQ(cloth.mesh.lines, (std::vector<std::array<int, 2>>{{0, 1}, {0, 2}}));
  EXPECT_EQ(cloth.mesh.line_stiffness, (std::vector<double>{3.0, 7.0}));
  EXPECT_EQ(cloth.mesh.line_density, (std::vector<double>{0.5, 0.0}));
  EXPECT_FALSE(cloth.has_lines());
  EXPECT_FALSE(holds(print_springs_scene(cloth), "material.axial_stiffness"));
  // The reinforcement replaces the material of one line; the other keeps it.
  const SpringsScene string =
      read_text(with_file, with("{where=\"x>0.5\",axial_stiffness=9,line_density=0.1}"), rope);
  EXPECT_EQ(string.mesh.lines.size(), 2U);
  EXPECT_EQ(string.mesh.line_stiffness, (std::vector<double>{5000.0, 9.0}));
  EXPECT_EQ(string.mesh.line_density, (std::vector<double>{0.001, 0.1}));
  const auto wrong = [&](const std::string& list, const std::string& mesh = triangle) {
    return error_of(with(list), with_file, mesh);
  };
  EXPECT_TRUE(holds(wrong("{where=\"x>2\",axial_stiffness=1}"), "holds at no vertex: nothing is reinforced"));
  EXPECT_TRUE(holds(wrong("{where=\"x==1\",axial_stiffness=1}"), "holds at both ends of no edge"));
  EXPECT_TRUE(
      holds(wrong("{where=\"x==0\",axial_stiffness=1},{where=\"1\",axial_stiffness=1}"),
            "reinforcement[1] and reinforcement[0] both reinforce the edge at vertex 0 (0.0, 0.0, 0.0) "
            "and at vertex 2"));
  EXPECT_TRUE(holds(wrong("{where=\"1\",axial_stiffness=1}", rope), "leave no mass at vertex 0"));
  EXPECT_TRUE(holds(wrong("{where=\"1\"}"), "missing key \"reinforcement[0].axial_stiffness\""));
  EXPECT_TRUE(holds(wrong("{where=\"1\",axial_stiffness=0}"), "> 0"));
  EXPECT_TRUE(holds(wrong("{where=\"1\",axial_stiffness=1,stiffness=1}"), "axial_stiffness"));
}

TEST(SpringsScene, ClosedFormsRefuseUnsupportedReinforcements) {
  const std::string sheet = "app = \"springs\"\n[mesh]\nrectangle = { vertices = 9 }\n[time]\nend_time = 1\n";
  const auto young = [&](const std::string& where) {
    return error_of({"reinforcement=[{where=\"" + where + "\",axial_stiffness=1}]", "verify.young=1e-9",
                     "pin=[{where=\"x==1\",motion={x=1e-3}}]"},
                    sheet);
  };
  EXPECT_EQ(young("y==0.5"), "");
  EXPECT_TRUE(holds(young("y==0.5 && x<0.7"), "from end to end"));
  EXPECT_TRUE(holds(young("x==0.5"), "run along x"));
  EXPECT_TRUE(holds(error_of({"mesh.string={}", "load=[{gravity=[1,0,0]}]", "verify.stretch=1",
                              "reinforcement=[{where=\"1\",axial_stiffness=1,line_density=1}]"}),
                    "without reinforcement"));
}

TEST(SpringsScene, RefusesTheLinearVectorModelWithMotion) {
  EXPECT_TRUE(holds(error_of({"material.model=linear-vector"}), "rigid rotation"));
  EXPECT_EQ(error_of({"material.model=linear-vector", "time.end_time=0"}), "");
}

TEST(SpringsScene, RefusesEmptyAndConflictingPins) {
  const auto pins = [](const std::string& list) { return std::vector<std::string>{"pin=[" + list + "]"}; };
  EXPECT_EQ(error_of(pins("{where=\"x>0.9\"},{where=\"y>0.3\"}")), "");
  EXPECT_EQ(error_of(pins("{where=\"x>0.9\",axes=\"x\",motion={x=\"t\"}},{where=\"x>0.9\",axes=\"yz\"}")),
            "");
  EXPECT_TRUE(holds(error_of(pins("{where=\"x>2\"}")), "pin[0].where = \"x>2\" holds at no vertex"));
  EXPECT_TRUE(holds(error_of(pins("{where=\"1\"},{where=\"x>0\",axes=\"z\",motion={z=\"t\"}}")),
                    "pin[1] and pin[0] hold the z axis in different ways at vertex"));
  EXPECT_TRUE(holds(error_of(pins("{where=\"1\",axes=\"xy\",motion={z=\"t\"}}")), "leaves free"));
  EXPECT_TRUE(holds(error_of(pins("{where=\"1/(x-x)\"}")), "must be finite"));
  EXPECT_TRUE(holds(error_of(pins("{where=\"t\"}")), "unknown name \"t\""));
}

TEST(SpringsScene, RequiresOneKindPerLoad) {
  const auto loads = [](const std::string& list) { return std::vector<std::string>{"load=[" + list + "]"}; };
  EXPECT_EQ(error_of(loads("{gravity=[0,0,-9.81]},{pressure=\"100*x\"},{force={z=\"1\"},where=\"x>0.5\"}")),
            "");
  EXPECT_TRUE(holds(error_of(loads("{gravity=[0,0,-9.81],pressure=1}")), "contradicts"));
  EXPECT_TRUE(holds(error_of(loads("{where=\"x\"}")), "load[0]"));
  EXPECT_TRUE(holds(error_of(loads("{gravity=[0,0]}")), "must be 3 numbers"));
  EXPECT_TRUE(holds(error_of(loads("{pressure=1,where=\"x\"}")), "with force"));
  EXPECT_TRUE(holds(error_of({"mesh.string={}", "load=[{pressure=1}]"}), "needs triangles"));
  EXPECT_TRUE(holds(error_of(loads("{force={}}")), "needs one of x, y, z"));
}

TEST(SpringsScene, PressureRequiresTriangles) {
  const std::string two = triangle + "v 1 1 0\n", along = two + "f 2 4 3\n", against = two + "f 2 3 4\n";
  EXPECT_EQ(error_of({"load=[{pressure=1}]"}, with_file, along), "");
  EXPECT_EQ(error_of({"load=[{gravity=[0,0,1]}]"}, with_file, against), "");
  EXPECT_TRUE(holds(error_of({"load=[{follower_pressure=1}]"}, with_file, against), "faces 0 and 1"));
}

TEST(SpringsScene, BendingRequiresTriangles) {
  const std::vector<std::string> sets = {"material.bending_stiffness=1e-3"};
  EXPECT_EQ(error_of(sets), "");
  EXPECT_EQ(error_of(sets, with_file, "v 0 0 0\nv 1 0 1\nv 0 1 0\nv 1 1 1\nf 1 2 3\nf 2 3 4\n"), "")
      << "a slope";
  EXPECT_TRUE(holds(error_of(sets, with_file, triangle + "v 1 1 1\nf 2 4 3\n"), "flat at rest"));
  EXPECT_TRUE(holds(error_of(sets, with_file, rope), "with triangles"));
}

TEST(SpringsScene, CompletesAndChecksOutput) {
  EXPECT_EQ(read_text(least, {"output.fields=[\"velocity\"]"}).output.times, std::vector<double>{1.0});
  EXPECT_EQ(read_text(least, {"output.times=[0.5]"}).output.fields, std::vector<std::string>{"position"});
  EXPECT_TRUE(holds(error_of({"output.times=[2]"}), "later than time.end_time = 1"));
  EXPECT_TRUE(holds(error_of({"mesh.string={}", "output.fields=[\"von_mises\"]"}), "a stress of triangles"));
  EXPECT_TRUE(
      holds(error_of({"material.model=linear-vector", "time.end_time=0", "output.fields=[\"von_mises\"]"}),
            "not along edges"));
  EXPECT_TRUE(holds(error_of({"time.dt=1e-300"}), "more than 1e15 steps"));
}

/// Checks that divide by a quantity which the scene makes zero, or whose closed form does not hold.
TEST(SpringsScene, RefusesChecksOutsideTheirValidity) {
  const auto refusal = [](std::vector<std::string> sets, const std::string& text = least) {
    return error_of(sets, text);
  };
  const std::string equilibrium = "verify.equilibrium=1";
  EXPECT_TRUE(holds(refusal({equilibrium, "load=[{follower_pressure=1}]"}), "a pin, or a dead pressure"));
  EXPECT_TRUE(holds(refusal({equilibrium, "load=[{gravity=[0,0,-1]}]"}), "a pin, or a dead pressure"));
  EXPECT_TRUE(holds(refusal({equilibrium, "load=[{force={z=\"t\"}}]"}), "a pin, or a dead pressure"));
  EXPECT_EQ(refusal({equilibrium, "load=[{pressure=1}]"}), "");
  EXPECT_EQ(refusal({equilibrium, "load=[{follower_pressure=1}]", "pin=[{where=\"x>0.3\"}]"}), "");

  const std::string rim = "pin=[{where=\"sqrt(x^2+y^2)>0.4-1e-9\"}]", hencky = "verify.hencky=1";
  EXPECT_EQ(refusal({hencky, rim, "load=[{pressure=1}]"}), "");
  EXPECT_TRUE(holds(refusal({hencky, "load=[{pressure=1}]"}), "clamps the rim"));
  EXPECT_TRUE(holds(refusal({hencky, rim, "load=[{pressure=0}]"}), "other than 0"));
  EXPECT_TRUE(holds(refusal({hencky, rim, "load=[{pressure=1}]", "initial.prestretch=0.1"}), "prestretch"));

  const std::string rope_scene =
      "app = \"springs\"\n[mesh]\nstring = { from = [0,0,0], to = [1,0,0], vertices = 5 }\n"
      "[time]\nend_time = 1\n[[load]]\ngravity = [0,0,-9.81]\n";
  const std::string ends = "pin=[{where=\"x==0||x==1\"}]", begin = "pin=[{where=\"x==0\"}]";
  const auto catenary = [&](std::vector<std::string> sets) {
    sets.emplace_back("verify.catenary=1");
    return refusal(sets, rope_scene);
  };
  EXPECT_EQ(catenary({ends}), "");
  EXPECT_TRUE(holds(catenary({begin}), "both ends"));
  EXPECT_TRUE(holds(catenary({ends, "mass=[{where=\"x==0.5\",add=1}]"}), "without payloads"));
  EXPECT_TRUE(holds(catenary({ends, "load=[{gravity=[0,0,0]}]"}), "gravity other than 0"));
  EXPECT_TRUE(holds(catenary({ends, "initial.displacement={x=\"-x\",z=\"x\"}"}), "one above the other"));
  EXPECT_EQ(refusal({begin, "verify.stretch=1"}, rope_scene), "");
  EXPECT_TRUE(holds(refusal({ends, "verify.stretch=1"}, rope_scene), "none that holds the other"));
  EXPECT_TRUE(holds(refusal({begin, "verify.stretch=1", "load=[{gravity=[0,0,0]}]"}, rope_scene),
                    "gravity other than 0"));

  const std::string sheet = "app = \"springs\"\n[mesh]\nrectangle = { vertices = 9 }\n[time]\nend_time = 1\n";
  EXPECT_TRUE(holds(refusal({"verify.young=1", "pin=[{where=\"x==1\",motion={x=\"t*(1-t)\"}}]"}, sheet),
                    "not 0 at the end"));
  const auto front = [&](const std::string& probes) {
    return refusal({"verify.front_speed={value=1,tolerance=1}", "output.probes=[" + probes + "]"}, sheet);
  };
  EXPECT_EQ(front("{at=[0,0,0]},{at=[1,0,0]}"), "");
  EXPECT_TRUE(holds(front("{at=[0,0,0]},{at=[0.1,0,0]}"), "different vertices"));
}

TEST(SpringsScene, EnergyDriftNeedsLoadsWithAPotential) {
  const auto drift = [](std::vector<std::string> sets) {
    sets.emplace_back("verify.energy_drift=1");
    return error_of(sets);
  };
  const std::string rim = "pin=[{where=\"sqrt(x^2+y^2)>0.4-1e-9\"}]", blown = "load=[{follower_pressure=10}]";
  EXPECT_EQ(drift({rim, blown}), "");
  EXPECT_TRUE(holds(drift({blown}), "rim is held"));
  EXPECT_TRUE(holds(drift({"pin=[{where=\"sqrt(x^2+y^2)>0.4-1e-9\",axes=\"xy\"}]", blown}), "rim is held"));
  EXPECT_TRUE(holds(drift({rim, "load=[{follower_pressure=\"10*x\"}]"}), "rim is held"));
  EXPECT_TRUE(holds(drift({rim, "load=[{follower_pressure=\"10*t\"}]"}), "rim is held"));
}

TEST(SpringsScene, RefusesChecksWithoutTheirQuantity) {
  EXPECT_TRUE(holds(error_of({"verify.young=1e-5"}), "mesh.strip"));
  EXPECT_TRUE(holds(error_of({"verify.hencky=1e-5"}), "a constant pressure"));
  EXPECT_TRUE(holds(error_of({"verify.catenary=1e-5"}), "mesh.string"));
  EXPECT_TRUE(holds(error_of({"verify.energy_drift=1", "output.history_every=0"}), "history_every"));
  EXPECT_TRUE(holds(error_of({"verify.energy_drift=1", "damping.absolute=1"}), "without damping"));
  const std::string probe = "output.probes=[{at=[0,0,0]}]";
  EXPECT_TRUE(holds(error_of({"verify.frequency={mode=[0,1],tolerance=1}"}), "prestretch"));
  EXPECT_TRUE(holds(error_of({"verify.frequency={value=3,tolerance=1}"}), "probe of that number"));
  EXPECT_TRUE(holds(error_of({"verify.frequency={tolerance=1}", probe}), "needs a value"));
  EXPECT_EQ(error_of({"verify.frequency={mode=[0,1],tolerance=1}", probe, "initial.prestretch=0.01"}), "");
  const auto value = [](const std::string& keys) { return "verify.values=[{" + keys + ",tolerance=1}]"; };
  EXPECT_EQ(error_of({value("quantity=\"elastic_energy\",value=1")}), "");
  EXPECT_TRUE(holds(error_of({value("quantity=\"elastic_energy\",value=0")}), "relative"));
  EXPECT_TRUE(
      holds(error_of({value("quantity=\"elastic_energy\",at=[0,0,0],value=1")}), "a quantity of a vertex"));
  EXPECT_TRUE(
      holds(error_of({value("quantity=\"area_growth\",at=[0,0,0],value=1")}), "a quantity of a vertex"));
  EXPECT_TRUE(holds(error_of({value("quantity=\"von_mises\",value=1")}), "needs at, a position"));
  EXPECT_TRUE(holds(error_of({"verify.frequency={mode=[0.5,1],tolerance=1}", probe}), "integers"));
}

TEST(SpringsSceneDocument, MatchesTheDeclarations) {
  const std::filesystem::path page = source / "docs/scenes-springs.md";
  if (std::getenv("DROGUE_UPDATE_DOCS") != nullptr) std::ofstream(page) << document_springs_scene();
  std::ostringstream written;
  written << std::ifstream(page).rdbuf();
  EXPECT_EQ(written.str(), document_springs_scene())
      << "after a change of the keys: DROGUE_UPDATE_DOCS=1 ctest -R SpringsSceneDocument";
}

}  // namespace
}  // namespace drogue::springs_app
