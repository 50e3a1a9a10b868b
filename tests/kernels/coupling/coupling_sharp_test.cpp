// ctest-label: exact
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "kernels/coupling/sharp/sharp_sheet.hpp"
#include "kernels/coupling/sheet/inverse_masses.hpp"
#include "kernels/device/backend.hpp"
#include "kernels/fabric/points_transfer.hpp"
#include "kernels/reference/coupling/sharp_sheet.hpp"
#include "tests/support/coupled_case.hpp"

// Sheets as pressure jumps between the cells that they separate: crossings and forces against an oracle, the
// porous law, leaks, layers and balances.

namespace drogue::coupling {
namespace {

using drogue::testing::CoupledCase;
using drogue::testing::CoupledRun;
using fabric::Vector;
using Space = DROGUE_TEST_SPACE;

constexpr double h = 0.1;

/// Two crumpled layers in a grid that is periodic along y alone, so close that they share faces.
reference::SharpSheet crumpled_layers(std::mt19937& engine) {
  std::uniform_real_distribution<double> noise(-0.4 * h, 0.4 * h), velocity(-2.0, 2.0);
  reference::SharpSheet sheet;
  sheet.alpha = 25.0, sheet.beta = 4.0;
  constexpr int n = 9;
  for (int layer = 0; layer < 2; ++layer) {
    const int first = static_cast<int>(sheet.positions.size());
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        sheet.positions.push_back({0.21 + 0.08 * i, 0.1 + 0.075 * j,
                                   0.45 + 0.3 * h * layer + 0.2 * std::sin(0.5 * i) + noise(engine)});
        sheet.velocities.push_back({velocity(engine), velocity(engine), velocity(engine)});
      }
    for (int i = 0; i + 1 < n; ++i)
      for (int j = 0; j + 1 < n; ++j) {
        const int a = first + n * i + j;
        sheet.triangles.push_back({a, a + n, a + 1});
        sheet.triangles.push_back({a + n, a + n + 1, a + 1});
      }
  }
  return sheet;
}

TEST(SharpSheet, ForcesOfCrumpledLayersMatchTheReference) {
  std::mt19937 engine(7);
  StaggeredGrid grid;
  grid.cells = {11, 9, 10};
  grid.origin = {0.013, -0.021, 0.007};
  grid.spacing = {h, 0.9 * h, 1.1 * h};
  grid.periodic = {false, true, false};
  const reference::SharpSheet sheet = crumpled_layers(engine);
  reference::FaceField air = reference::zero_field(grid);
  std::uniform_real_distribution<double> velocity(-3.0, 3.0);
  for (auto& component : air)
    for (double& value : component) value = velocity(engine);
  constexpr double density = 1.2, dt = 0.01;
  const reference::SharpForces expected = reference::sharp_forces(grid, sheet, air, density, dt);
  ASSERT_GT(expected.crossings, 100);

  const Space space;
  mesh::Mesh mesh;
  mesh.rest = sheet.positions;
  mesh.triangles = sheet.triangles;
  fabric::Parameters cloth;
  cloth.mesh = mesh;
  const auto rows = sheet.positions.size();
  cloth.mass.assign(rows, 1.0);
  cloth.pinned.assign(rows, 7);
  SheetParameters parameters;
  parameters.method = CouplingMethod::sharp;
  parameters.law = {sheet.alpha, sheet.beta, false};
  const SharpSheet<Space> sharp(space, grid, cloth.mesh, inverse_masses(cloth), parameters, density);
  using Vectors = SharpSheet<Space>::Vectors;
  const Vectors x("x", rows), v("v", rows);
  fabric::copy_to_points(space, sheet.positions, x);
  fabric::copy_to_points(space, sheet.velocities, v);
  using OneComponent = Kokkos::View<double***, Kokkos::LayoutLeft, Space::memory_space>;
  FaceViews<OneComponent> densities;
  SharpSheet<Space>::Faces velocity_faces, density_faces;
  FaceViews<OneComponent> velocities;
  for (int d = 0; d < 3; ++d) {
    const auto n = [&](int axis) { return static_cast<std::size_t>(faces_along(grid, d, axis)); };
    velocity_faces.component[d] = velocities.component[d] = OneComponent("u", n(0), n(1), n(2));
    density_faces.component[d] = densities.component[d] = OneComponent("f", n(0), n(1), n(2));
    const auto mirror = Kokkos::create_mirror_view(velocities.component[d]);
    for (std::size_t i = 0; i < mirror.size(); ++i) mirror.data()[i] = air[static_cast<std::size_t>(d)][i];
    Kokkos::deep_copy(velocities.component[d], mirror);
  }
  for (int repetition = 0; repetition < 2; ++repetition) {
    for (const auto& component : densities.component) Kokkos::deep_copy(space, component, 0.0);
    sharp.freeze(space, {x, v}, 0.0);
    sharp.interpolate_air(space, velocity_faces);
    sharp.spread_forces(space, {x, v}, density_faces, dt);
    space.fence();
  }
  for (int d = 0; d < 3; ++d) {
    const auto found = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), densities.component[d]);
    const auto& of_component = expected.density[static_cast<std::size_t>(d)];
    double largest = 0.0;
    for (const double value : of_component) largest = std::max(largest, std::abs(value));
    // The displacement of the centres by 1e-7 cells changes weights by that much.
    for (std::size_t i = 0; i < found.size(); ++i)
      EXPECT_NEAR(found.data()[i], of_component[i], 1e-5 * largest) << d << ' ' << i;
  }
  std::vector<Vector> forces(rows);
  fabric::PointsReader<Space> reader;
  reader.read(space, sharp.force(), forces);
  double largest = 0.0;
  for (const Vector& f : expected.vertices)
    for (const double value : f) largest = std::max(largest, std::abs(value));
  for (std::size_t i = 0; i < rows; ++i)
    for (std::size_t axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(forces[i][axis], expected.vertices[i][axis], 1e-5 * largest) << i;
  EXPECT_EQ(transfer_counts(space, sharp.transfer()).rejected_forces, 0);
}

/// Mean velocity of the air, m/s.
Vector mean_velocity_of(const CoupledCase& c, CoupledRun& run) {
  const flow::Totals totals = run.solver->flow().totals();
  Vector mean{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    mean[axis] = totals.momentum[axis] / (c.p.flow.density * c.volume());
  return mean;
}

TEST(SharpSheet, FollowsThePorousLawAcrossAChannel) {
  for (const double dp : {30.0, 300.0})
    for (const flow::TimeScheme time : {flow::TimeScheme::ab2, flow::TimeScheme::rk3}) {
      CoupledCase c(16, 8, h, 0.005);
      c.p.sheet.method = CouplingMethod::sharp;
      c.p.flow.time_scheme = time;
      c.p.flow.pressure_drop = {dp, 0.0, 0.0};
      c.add_strip(0.83, 0.0, 0.83, 0.8, 16);
      CoupledRun run(c);
      ASSERT_TRUE(run.advance(400));
      const double law = CoupledCase::law_velocity(dp);
      EXPECT_NEAR(mean_velocity_of(c, run)[0], law, 1e-5 * law) << dp;
      EXPECT_NEAR(run.force()[0], -dp * 0.8 * h, 1e-6 * dp * 0.8 * h) << dp;
    }
}

TEST(SharpSheet, LayersBetweenTwoCentresAddTheirPressureDifferences) {
  CoupledCase c(24, 4, h, 0.01);
  c.p.sheet.method = CouplingMethod::sharp;
  c.p.flow.pressure_drop = {300.0, 0.0, 0.0};
  for (const double x : {0.97, 0.99, 1.01}) c.add_strip(x, 0.0, x, 0.4, 8);
  c.p.sheet.law = {100.0, 0.0, false};
  CoupledRun run(c);
  ASSERT_TRUE(run.advance(600));
  EXPECT_NEAR(mean_velocity_of(c, run)[0], 1.0, 1e-5);
}

/// Mean normal velocity, m/s, through a strip of slope 2 across a box, on which a force on the air exerts
/// 100 Pa.
double through_tilted_sharp_sheet(bool impermeable, double shift) {
  CoupledCase c(8, 16, h, 0.005);
  c.p.sheet.method = CouplingMethod::sharp;
  const double length = std::hypot(0.8, 1.6), nx = 1.6 / length, ny = -0.8 / length,
               strength = 100.0 * length * h / c.volume();
  c.p.flow.body_force = {strength * nx, strength * ny, 0.0};
  c.p.sheet.law.impermeable = impermeable;
  c.add_strip(shift, 0.0, 0.8 + shift, 1.6, 36);
  CoupledRun run(c);
  EXPECT_TRUE(run.advance(200));
  const Vector mean = mean_velocity_of(c, run);
  return mean[0] * nx + mean[1] * ny;
}

TEST(SharpSheet, FollowsThePorousLawAndDoesNotLeakAtASlope) {
  const double law = CoupledCase::law_velocity(100.0);
  for (const double shift : {0.0, 0.013}) {
    EXPECT_LE(std::abs(through_tilted_sharp_sheet(true, shift)), 1e-3 * law) << shift;
    EXPECT_NEAR(through_tilted_sharp_sheet(false, shift), law, 1e-5 * law) << shift;
  }
}

TEST(SharpSheet, TakesTheMomentumThatTheAirLoses) {
  CoupledCase c(16, 16, h, 0.004);
  c.p.sheet.method = CouplingMethod::sharp;
  c.add_strip(0.61, 0.2, 0.87, 1.4, 24);
  for (Vector& v : c.v) v = {1.0, 0.5, 0.0};
  CoupledRun run(c);
  Vector last{};
  for (int step = 0; step < 40; ++step) {
    ASSERT_TRUE(run.advance(1));
    const flow::Totals now = run.solver->flow().totals();
    const Vector force = run.force(), total = run.solver->total_force_on_air();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(now.momentum[axis] - last[axis], 0.004 * force[axis], 1e-13);
      EXPECT_NEAR(total[axis], force[axis], 1e-12);
      last[axis] = now.momentum[axis];
    }
  }
  EXPECT_GT(last[0], 0.01);
}

TEST(SharpSheet, ContinuesBitForBitAndBackendsAgree) {
  CoupledCase c(16, 8, h, 0.01);
  c.p.sheet.method = CouplingMethod::sharp;
  c.p.flow.pressure_drop = {3.0, 0.0, 0.0};
  c.add_strip(0.63, 0.1, 0.93, 0.7, 16);
  CoupledRun whole(c), first(c), second(c);
  ASSERT_TRUE(whole.advance(20));
  ASSERT_TRUE(whole.advance(20));
  ASSERT_TRUE(first.advance(20));
  const auto middle = drogue::testing::coupled_state(*first.solver);
  EXPECT_EQ(middle.arrays.at("face_acceleration").size(), 3 * 16U * 8U);
  restore(middle, *second.solver);
  EXPECT_THROW(second.solver->upload("face_acceleration", std::vector<double>(7)), std::invalid_argument);
  ASSERT_TRUE(second.advance(20));
  EXPECT_EQ(second.force(), whole.force());
  std::vector<Vector> here(c.x.size()), there(c.x.size());
  whole.solver->download("sheet_force", numbers(here));
  for (const device::Backend backend : device::compiled_backends()) {
    const auto other = c.solver(backend);
    ASSERT_EQ(other->advance(1e9, 20, {}), flow::Stop::pause);
    ASSERT_EQ(other->advance(1e9, 40, {}), flow::Stop::pause);
    other->download("sheet_force", numbers(there));
    for (std::size_t i = 0; i < here.size(); ++i)
      for (std::size_t axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(there[i][axis], here[i][axis], drogue::testing::run_tolerance) << i << ' ' << axis;
  }
}

TEST(SharpSheet, StepsOfABlockNeitherFenceNorAllocateNorCopy) {
  CoupledCase c(16, 8, h, 0.002);
  c.p.sheet.method = CouplingMethod::sharp;
  c.p.substeps = 1;
  c.add_strip(0.63, 0.1, 0.93, 0.7, 16);
  CoupledRun run(c);
  static_cast<void>(drogue::testing::counted_steps(run, 16));
  // Blocks of 16 steps and of 4: the difference is that of 12 steps.
  const auto whole = drogue::testing::counted_steps(run, 16), part = drogue::testing::counted_steps(run, 4);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(whole[k], part[k]) << k;
  // Clearing, saving, two kernels before the step of the cloth, one that returns its state to the first of
  // two buffers, five for the forces, a check, and one after the step of the flow, which is 10 kernels on a
  // host and one graph on a device.
  const std::int64_t flow = drogue::testing::tested_backend == device::Backend::cuda ? 1 : 10;
  EXPECT_EQ(whole[3] - part[3], 12 * (1 + 1 + 2 + c.p.substeps + 1 + 5 + 1 + flow + 1));
}

TEST(SharpSheet, RejectsFreeVertices) {
  CoupledCase c(16, 8, h, 0.01);
  c.p.sheet.method = CouplingMethod::sharp;
  c.add_strip(0.63, 0.1, 0.93, 0.7, 16);
  c.p.fabric.pinned[5] = 6;
  EXPECT_THROW(static_cast<void>(c.solver(drogue::testing::tested_backend)), std::invalid_argument);
}

}  // namespace
}  // namespace drogue::coupling
