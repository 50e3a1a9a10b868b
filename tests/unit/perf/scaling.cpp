#include "perf/models/scaling.hpp"

#include <gtest/gtest.h>

namespace drogue::perf {
namespace {

TEST(Scaling, CountsUnitsByDoublingUpToAll) {
  EXPECT_EQ(unit_counts(0), std::vector<int>({1}));
  EXPECT_EQ(unit_counts(1), std::vector<int>({1}));
  EXPECT_EQ(unit_counts(2), std::vector<int>({1, 2}));
  EXPECT_EQ(unit_counts(6), std::vector<int>({1, 2, 4, 6}));
  EXPECT_EQ(unit_counts(8), std::vector<int>({1, 2, 4, 8}));
}

TEST(Scaling, DividesStrongScalingAloneByTheUnits) {
  EXPECT_DOUBLE_EQ(efficiency(false, 8.0, 2.5, 4), 0.8);
  EXPECT_DOUBLE_EQ(efficiency(true, 8.0, 10.0, 4), 0.8);
}

TEST(Scaling, GrowsTheBoxAlongZInWeakScalingAlone) {
  const std::array<int, 3> one = {32, 16, 8};
  EXPECT_EQ(scaled_cells(one, true, 3), (std::array<int, 3>{32, 16, 24}));
  EXPECT_EQ(scaled_cells(one, false, 3), one);
}

TEST(Scaling, KeepsCellsCubesAndTheToleranceOfSecondOrder) {
  const std::string text = flow_scene({16, 16, 32}, 20);
  EXPECT_NE(text.find("cells = [16, 16, 32]"), std::string::npos);
  EXPECT_NE(text.find("[0, 6.2831853071795862], [0, 12.566370614359172]]"), std::string::npos) << text;
  EXPECT_NE(text.find("l2_velocity = 0.000154\n"), std::string::npos) << text;
}

}  // namespace
}  // namespace drogue::perf
