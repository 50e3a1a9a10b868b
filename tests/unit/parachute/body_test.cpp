#include <gtest/gtest.h>

#include "miniapps/parachute/bodies/body.hpp"

// Meshes of rigid plates.

namespace drogue::parachute_app {
namespace {

TEST(Bodies, PlatesHaveTheirAreaTheirNormalAndEdgesOfTheGivenLength) {
  for (int normal = 0; normal < 3; ++normal) {
    Body body;
    body.normal = normal;
    body.centre = {1.0, 2.0, 3.0};
    body.lengths = {0.4, 0.75};
    body.edge_length = 0.1;
    EXPECT_EQ(body.edges(), (std::array<int, 2>{4, 8}));
    const fabric::Parameters sheets = make_sheets({body});
    ASSERT_EQ(sheets.mesh.rest.size(), body.vertices());
    ASSERT_EQ(sheets.mesh.triangles.size(), 2U * 4U * 8U);
    const auto axis = static_cast<std::size_t>(normal);
    double doubled = 0.0;
    for (const auto& corners : sheets.mesh.triangles) {
      const fabric::Vector& a = sheets.mesh.rest[static_cast<std::size_t>(corners[0])];
      const fabric::Vector& b = sheets.mesh.rest[static_cast<std::size_t>(corners[1])];
      const fabric::Vector& c = sheets.mesh.rest[static_cast<std::size_t>(corners[2])];
      const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
      const double along = (b[u] - a[u]) * (c[v] - a[v]) - (b[v] - a[v]) * (c[u] - a[u]);
      EXPECT_GT(along, 0.0) << "the normal points along the axis " << normal;
      doubled += along;
    }
    EXPECT_NEAR(0.5 * doubled, 0.4 * 0.75, 1e-14);
    fabric::Vector mean{};
    for (const fabric::Vector& x : sheets.mesh.rest)
      for (std::size_t k = 0; k < 3; ++k) mean[k] += x[k] / static_cast<double>(sheets.mesh.rest.size());
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(mean[k], body.centre[k], 1e-14);
    for (const std::uint8_t axes : sheets.pinned) EXPECT_EQ(axes, 7);
  }
}

TEST(Bodies, SeveralBodiesAreOneMeshInTheirOrder) {
  Body first, second;
  first.lengths = second.lengths = {1.0, 1.0};
  first.edge_length = 0.5, second.edge_length = 0.25;
  second.centre = {7.0, 0.0, 0.0};
  const fabric::Parameters sheets = make_sheets({first, second});
  EXPECT_EQ(vertices_of({first, second}), 9U + 25U);
  ASSERT_EQ(sheets.mesh.rest.size(), 34U);
  EXPECT_EQ(sheets.mesh.rest[8][0], 0.0);
  EXPECT_EQ(sheets.mesh.rest[9][0], 7.0);
}

}  // namespace
}  // namespace drogue::parachute_app
