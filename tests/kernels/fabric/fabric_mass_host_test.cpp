#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <stdexcept>

#include "kernels/fabric/elastic/lumped_mass.hpp"
#include "kernels/mesh/edges.hpp"
#include "kernels/reference/fabric/mass.hpp"
#include "tests/support/fabric_mesh.hpp"

// Lumped masses against integrals of shape functions, and the convergence order of a second moment.

namespace drogue::fabric {
namespace {

double sum_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

TEST(FabricMass, EqualsRowSumsOfTheConsistentMassMatrix) {
  const Mesh mesh = testing::random_patch(9, 6, 2);
  const std::vector<double> mine = lumped_masses(mesh, 0.756, 0.2, Lumping::area),
                            exact = reference::row_sum_masses(mesh, 0.756, 0.2);
  for (std::size_t i = 0; i < mine.size(); ++i) EXPECT_NEAR(mine[i], exact[i], 1e-15) << i;
  EXPECT_NEAR(mine.back(), 0.5 * 0.5 * 0.2, 1e-15) << "the end of a line has half the mass of its segment";
}

TEST(FabricMass, UsesTheDensityOfEachLine) {
  Mesh mesh = testing::random_patch(9, 6, 2);
  mesh.line_density = {0.1, 0.0, 0.3, 0.7};
  const std::vector<double> mine = lumped_masses(mesh, 0.756, 0.2, Lumping::area),
                            exact = reference::row_sum_masses(mesh, 0.756, 0.2);
  for (std::size_t i = 0; i < mine.size(); ++i) EXPECT_NEAR(mine[i], exact[i], 1e-15) << i;
  EXPECT_NEAR(mine.back(), 0.5 * 0.5 * 0.3, 1e-15);
  mesh.line_density.pop_back();
  EXPECT_THROW(static_cast<void>(lumped_masses(mesh, 1.0, 0.2, Lumping::area)), std::invalid_argument);
  mesh.line_density.push_back(-1.0);
  EXPECT_THROW(static_cast<void>(lumped_masses(mesh, 1.0, 0.2, Lumping::area)), std::invalid_argument);
}

TEST(FabricMass, UsesTheLengthOfEachLine) {
  Mesh mesh = testing::random_patch(9, 6, 2);
  mesh.line_length = {0.0, 0.9, 0.0, 2.0};
  const std::vector<double> mine = lumped_masses(mesh, 0.756, 0.2, Lumping::area),
                            exact = reference::row_sum_masses(mesh, 0.756, 0.2);
  for (std::size_t i = 0; i < mine.size(); ++i) EXPECT_NEAR(mine[i], exact[i], 1e-15) << i;
  mesh.line_length.clear();
  const double change = sum_of(mine) - sum_of(lumped_masses(mesh, 0.756, 0.2, Lumping::area));
  const double before = 0.5 + rest_distance(mesh, mesh.lines[3][0], mesh.lines[3][1]);
  EXPECT_NEAR(change, 0.2 * (2.9 - before), 1e-13);
}

TEST(FabricMass, EqualLumpingPreservesTheTotalMass) {
  const Mesh mesh = testing::random_patch(9, 6, 2);
  const std::vector<double> equal = lumped_masses(mesh, 0.756, 0.2, Lumping::equal);
  EXPECT_NEAR(sum_of(equal), sum_of(lumped_masses(mesh, 0.756, 0.2, Lumping::area)), 1e-13);
  for (const double m : equal) EXPECT_EQ(m, equal[0]);
}

/// Error, kg m^2, of the second moment of a rectangle of n by n cells about its lower edge; exact is
/// 2 * 3^3 / 3.
double moment_error(int n, Lumping lumping) {
  Mesh mesh;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) mesh.rest.push_back({2.0 * i / n, 3.0 * j / n, 0.0});
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i, b = a + 1, c = a + n + 1, d = c + 1;
      mesh.triangles.push_back({a, b, d});
      mesh.triangles.push_back({a, d, c});
    }
  const std::vector<double> mass = lumped_masses(mesh, 1.0, 0.0, lumping);
  double moment = 0.0;
  for (std::size_t i = 0; i < mass.size(); ++i) moment += mass[i] * mesh.rest[i][1] * mesh.rest[i][1];
  return std::abs(moment - 18.0);
}

// ctest-label: no-sanitizer
TEST(FabricMass, AreaLumpingIsSecondOrderAndEqualLumpingFirstOrder) {
  const auto order = [](Lumping lumping) {
    return std::log2(moment_error(16, lumping) / moment_error(64, lumping)) / 2.0;
  };
  EXPECT_NEAR(order(Lumping::area), 2.0, 0.05);
  EXPECT_NEAR(order(Lumping::equal), 1.0, 0.05);
}

TEST(FabricMass, RejectsInvalidDensities) {
  const Mesh mesh = testing::random_patch(2, 2, 1);
  for (const double wrong : {-1.0, std::nan(""), static_cast<double>(INFINITY)}) {
    EXPECT_THROW(static_cast<void>(lumped_masses(mesh, wrong, 0.0, Lumping::area)), std::invalid_argument);
    EXPECT_THROW(static_cast<void>(lumped_masses(mesh, 0.0, wrong, Lumping::equal)), std::invalid_argument);
  }
}

}  // namespace
}  // namespace drogue::fabric
