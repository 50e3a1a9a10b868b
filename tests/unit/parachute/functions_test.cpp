#include "miniapps/parachute/scene/functions.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <stdexcept>

#include "miniapps/parachute/scene/scene_check.hpp"

namespace drogue::parachute_app {
namespace {

flow::Parameters channel() {
  flow::Parameters p;
  p.cells = {4, 5, 1};
  p.low = {1.0, -1.0, 0.0};
  p.high = {3.0, 1.0, 0.5};
  p.boundary[2].kind = p.boundary[3].kind = flow::BoundaryKind::wall;
  return p;
}

TEST(Lattice, ComponentsLieOnTheFacesNormalToTheirAxis) {
  const Lattice x = lattice_of(channel(), 0);
  EXPECT_EQ(x.n, (std::array<int, 3>{4, 5, 1}));
  EXPECT_EQ(x.place(0), (std::array<double, 3>{1.0, -0.8, 0.25}));
  const Lattice y = lattice_of(channel(), 1);
  EXPECT_EQ(y.n, (std::array<int, 3>{4, 6, 1}));
  EXPECT_EQ(y.place(0), (std::array<double, 3>{1.25, -1.0, 0.25}));
  EXPECT_EQ(y.place(23), (std::array<double, 3>{2.75, 1.0, 0.25}));
  EXPECT_EQ(lattice_of(channel(), 2).place(0), (std::array<double, 3>{1.25, -0.8, 0.25}));
}

TEST(Lattice, PointsStandForTheVolumesBetweenThem) {
  flow::Parameters p = channel();
  p.faces[1] = {-1.0, -0.7, -0.3, 0.2, 0.6, 1.0};
  const Lattice cells = lattice_of(p), y = lattice_of(p, 1);
  EXPECT_EQ(cells.place(4)[1], 0.5 * (-0.7 - 0.3));
  EXPECT_EQ(y.place(8)[1], -0.3);
  const std::vector<double> widths = {0.0, 0.3, 0.4, 0.5, 0.4, 0.4, 0.0};
  for (std::size_t j = 0; j < 6; ++j)
    EXPECT_NEAR(y.volume(4 * j), 0.5 * (widths[j] + widths[j + 1]) / 0.4, 1e-15);
  for (std::size_t j = 0; j < 5; ++j) EXPECT_NEAR(cells.volume(4 * j), widths[j + 1] / 0.4, 1e-15);
  // On axes of one width they have those of a cell, and half of it at sides, exactly.
  EXPECT_EQ(lattice_of(channel(), 1).volume(0), 0.5);
  EXPECT_EQ(lattice_of(channel(), 1).volume(4), 1.0);
  EXPECT_EQ(lattice_of(channel(), 0).volume(0), 1.0);
}

TEST(Evaluate, ThreadsFillEveryPointOfAStride) {
  flow::Parameters p;
  p.cells = {97, 61, 41};
  const Lattice lattice = lattice_of(p);
  for (const std::size_t stride : {std::size_t{1}, std::size_t{3}}) {
    const std::vector<double> values = evaluate(SpaceTimeFunction("x + 10*y*z + t"), lattice, 3.0, stride);
    ASSERT_EQ(values.size(), (lattice.size() + stride - 1) / stride);
    for (std::size_t entry = 0; entry < values.size(); ++entry) {
      const auto [x, y, z] = lattice.place(stride * entry);
      ASSERT_DOUBLE_EQ(values[entry], x + 10.0 * y * z + 3.0) << entry;
    }
  }
}

TEST(StrideOfCheck, MeetsAllPointsOfSmallLatticesAndAllPlanesOfLargeOnes) {
  flow::Parameters p;
  p.cells = {64, 64, 64};
  EXPECT_EQ(stride_of_check(framework::InitialCheck::all_cells, lattice_of(p)), 1U);
  p.cells = {512, 512, 512};
  const Lattice large = lattice_of(p);
  const std::size_t stride = stride_of_check(framework::InitialCheck::all_cells, large);
  EXPECT_LE(large.size() / stride, 4'194'304U);
  std::set<std::size_t> planes;
  for (std::size_t k = 0; k < 512; ++k) planes.insert(k * stride % 512);
  EXPECT_EQ(planes.size(), 512U);
}

TEST(SpaceTimeFunction, RecognisesConstants) {
  EXPECT_EQ(SpaceTimeFunction("2*pi").constant(), 2.0 * M_PI);
  EXPECT_FALSE(SpaceTimeFunction("0*t").constant().has_value());
}

TEST(DeviceProgram, RejectsLongExpressions) {
  std::string text = "x";
  for (int i = 0; i < 100; ++i) text += "+x";
  EXPECT_THROW(static_cast<void>(device_program(text)), std::invalid_argument);
  EXPECT_EQ(device_program("x+t").length, 3);
}

}  // namespace
}  // namespace drogue::parachute_app
