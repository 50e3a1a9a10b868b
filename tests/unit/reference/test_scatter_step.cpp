#include "kernels/reference/fabric/scatter_step.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kernels/reference/fabric/membrane.hpp"
#include "tests/support/fabric_mesh.hpp"

namespace drogue::reference {
namespace {

fabric::Parameters patch_of_cloth() {
  fabric::Parameters p;
  p.mesh = testing::random_patch(5, 4, 1);
  p.mesh.rest.resize(20);
  p.mesh.lines.clear();
  p.mass.assign(p.mesh.rest.size(), 0.3);
  return p;
}

TEST(ReferenceScatter, ForcesAreGradientsOfTheEnergy) {
  const fabric::Parameters p = patch_of_cloth();
  const std::vector<fabric::Vector> now = testing::shaken(p.mesh.rest, 0.2, 2),
                                    expected = forces(p.material, p.mesh, now);
  std::vector<fabric::Vector> f(now.size());
  ScatterSheet(p).forces(now, f);
  for (std::size_t i = 0; i < f.size(); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_NEAR(f[i][axis], expected[i][axis], 1e-9);
}

TEST(ReferenceScatter, ConvergesWithFourthOrder) {
  fabric::Parameters p = patch_of_cloth();
  p.gravity = {0.0, 0.0, -9.81}, p.damping = 0.4, p.pinned.assign(p.mass.size(), 0), p.pinned[0] = 7;
  const auto end = [&](int steps) {
    std::vector<fabric::Vector> x = testing::shaken(p.mesh.rest, 0.05, 3), v(x.size(), fabric::Vector{});
    ScatterSheet sheet(p);
    for (int step = 0; step < steps; ++step) sheet.step(0.05 / steps, x, v);
    return x;
  };
  const auto distance = [](const auto& a, const auto& b) {
    double largest = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i)
      for (std::size_t axis = 0; axis < 3; ++axis)
        largest = std::max(largest, std::abs(a[i][axis] - b[i][axis]));
    return largest;
  };
  const auto best = end(800);
  EXPECT_NEAR(std::log2(distance(end(50), best) / distance(end(100), best)), 4.0, 0.2);
}

}  // namespace
}  // namespace drogue::reference
