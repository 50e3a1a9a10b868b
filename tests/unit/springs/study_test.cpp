#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "miniapps/springs/verify/samples.hpp"
#include "miniapps/springs/verify/study_points.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/temporary_file.hpp"

namespace drogue::springs_app {
namespace {

const std::filesystem::path scenes = std::filesystem::path(DROGUE_SOURCE_DIR) / "miniapps/springs/scenes";

std::string refusal(const std::string& scene, const std::string& lists) {
  return testing::refusal_of([&] { return study_points(scenes / (scene + ".toml"), {}, lists); },
                             ExitCode::usage);
}

TEST(SpringsStudy, ComputesLengthAndAreaOfAMesh) {
  const fabric::Mesh disk = generate(mesh::Disk{0.4, 3169});
  EXPECT_NEAR(total_area(disk, disk.rest), std::numbers::pi * 0.16, 1e-3 * 0.16);
  EXPECT_EQ(total_length(disk, disk.rest), 0.0);
  const fabric::Mesh string = generate(mesh::String{{0.5, 0.85, 0.0}, {0.8, 0.35, 0.0}, 60});
  EXPECT_NEAR(total_length(string, string.rest), std::hypot(0.3, 0.5), 1e-15);
  std::vector<fabric::Vector> doubled = disk.rest;
  for (fabric::Vector& x : doubled) x = {2.0 * x[0], 1.0, 2.0 * x[1]};
  EXPECT_NEAR(total_area(disk, doubled), 4.0 * total_area(disk, disk.rest), 1e-14);
}

TEST(SpringsStudy, AveragesDifferencesOverTime) {
  // 2 over a first part that is three times as long as the second, where it falls to 0.
  EXPECT_DOUBLE_EQ(mean_difference({0.0, 3.0, 4.0}, {1.0, 1.0, 5.0}, {3.0, 3.0, 5.0}), (6.0 + 1.0) / 4.0);
  EXPECT_DOUBLE_EQ(mean_difference({7.0}, {1.0}, {1.5}), 0.5);
}

TEST(SpringsStudy, PointsAreTheProductWithoutRepeatedMeshes) {
  const auto points =
      study_points(scenes / "drum-cone.toml", {}, "meshes=217:61:62,masses=equal:area,integrators=verlet");
  ASSERT_EQ(points.size(), 4U);
  const std::vector<std::size_t> vertices = {61, 217, 61, 217};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(points[i].scene.mesh.rest.size(), vertices[i]);
    EXPECT_EQ(points[i].label, i < 2 ? "biquadratic equal verlet" : "biquadratic verlet");
    EXPECT_EQ(points[i].scene.fabric.mass, i < 2 ? fabric::Lumping::equal : fabric::Lumping::area);
  }
}

TEST(SpringsStudy, TwoMeshesMakeADoublingSequence) {
  EXPECT_EQ(study_points(scenes / "drum-cone.toml", {}, "meshes=61:217").size(), 3U);
  EXPECT_NE(refusal("drum-cone", "meshes=217:61").find("meshes=61:217"), std::string::npos);
}

TEST(SpringsStudy, EdgeSpringsHaveTheStiffnessOfEquilateralTriangles) {
  const auto from_membrane =
      study_points(scenes / "drum-cone.toml", {}, "models=edge:quadratic,masses=equal");
  EXPECT_NEAR(*from_membrane[0].scene.fabric.stiffness, 1000.0, 1e-2);
  EXPECT_EQ(from_membrane[0].scene.fabric.area_density, 0.756);
  EXPECT_EQ(from_membrane[0].scene.fabric.mass, fabric::Lumping::equal);
  EXPECT_EQ(from_membrane[1].scene.fabric.material.membrane_modulus, 1154.7);
  const auto from_edges =
      study_points(scenes / "drum-cone.toml", {"material={model=\"edge\",stiffness=1000,tension_only=true}"},
                   "models=biquadratic");
  EXPECT_NEAR(from_edges[0].scene.fabric.material.membrane_modulus, 2000.0 / std::sqrt(3.0), 1e-9);
  EXPECT_NEAR(from_edges[0].scene.fabric.material.poisson, 1.0 / 3.0, 1e-15);
  EXPECT_TRUE(from_edges[0].scene.fabric.material.tension_only);
}

TEST(SpringsStudy, StringsKeepTheirAxialStiffnessOnEveryMesh) {
  for (const StudyPoint& point : study_points(scenes / "swing-chord.toml", {}, "meshes=60:498")) {
    EXPECT_NEAR(point.scene.fabric.material.axial_stiffness, 5000.0 * std::hypot(0.3, 0.5) / 59.0, 1e-10);
    EXPECT_EQ(point.model, "string");
  }
}

TEST(SpringsStudy, StringsBesideClothKeepTheirStiffnessInEveryModel) {
  const testing::TemporaryFile scene("app = \"springs\"\n[mesh]\nfile = \"m.obj\"\n[time]\nend_time = 1\n");
  scene.add("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 -1\nv 0 0 -3\nf 1 2 3\nl 1 4 5\n");
  const std::vector<std::string> of_material = {
      "membrane_modulus=500,line_density=0.3,axial_stiffness=50",
      "membrane_modulus=500,line_density=0.3,stiffness=40",
      "model=\"edge\",stiffness=70,line_density=0.3,axial_stiffness=50",
      "model=\"edge\",stiffness=70,line_density=0.3",
  };
  for (const std::string& keys : of_material) {
    const std::vector<std::string> sets = {"material={" + keys + "}"};
    const SpringsScene base = read_springs_scene(scene.path(), sets);
    const auto points = study_points(scene.path(), sets, "models=edge:quadratic:biquadratic");
    ASSERT_EQ(points.size(), 3U);
    for (const StudyPoint& point : points) {
      EXPECT_EQ(point.scene.fabric.line_density, 0.3) << keys;
      EXPECT_EQ(point.scene.mesh.line_stiffness, base.mesh.line_stiffness) << keys << point.label;
      EXPECT_EQ(point.scene.fabric.material.axial_stiffness, base.fabric.material.axial_stiffness) << keys;
    }
    const double edge = base.fabric.material.model == fabric::Model::edge ? 70.0 : 250.0 * std::sqrt(3.0);
    EXPECT_DOUBLE_EQ(points[0].scene.fabric.material.stiffness, edge) << keys;
  }
}

TEST(SpringsStudy, RefusesInvalidAxes) {
  EXPECT_NE(refusal("drum", "meshes=1").find("not an integer number of vertices between 2 and 2^24"),
            std::string::npos);
  EXPECT_NE(refusal("drum", "models=linear-vector").find("edge, quadratic, biquadratic"), std::string::npos);
  EXPECT_NE(refusal("drum", "schemes=js").find("meshes, models, masses, integrators"), std::string::npos);
  EXPECT_NE(refusal("chain", "models=edge").find("the mesh of chain has none"), std::string::npos);
}

}  // namespace
}  // namespace drogue::springs_app
