// ctest-label: no-sanitizer
#include <gtest/gtest.h>

#include "kernels/fabric/solver.hpp"
#include "tests/support/backend.hpp"
#include "tests/support/expression_program.hpp"
#include "tests/support/fabric_mesh.hpp"
#include "tests/support/fabric_sheets.hpp"
#include "tests/support/profiled.hpp"

// Launches, fences, copies and allocations of steps: steps launch kernels and do nothing else.

namespace drogue::fabric {
namespace {

using device::ProfilingCounters;
using testing::random_patch;
using testing::shaken;

constexpr const auto& backend = testing::tested_backend;
const bool on_device = backend == device::Backend::cuda;

Parameters patch(Integrator integrator) {
  Parameters p;
  p.mesh = random_patch(11, 8, 3);
  p.material.axial_stiffness = 500.0;
  p.mass.assign(p.mesh.rest.size(), 0.01);
  p.integrator = integrator;
  p.dt = 2e-4;
  return p;
}

/// Kernel launches of 1024 steps, after 256 steps to warm up. They include four checkpoints. Also expects no
/// fence, allocation or copy.
std::int64_t launches_of(const Parameters& p) {
  const auto solver = create_solver(backend, p);
  solver->upload(shaken(p.mesh.rest, 0.1, 1), std::vector<Vector>(p.mass.size(), Vector{}));
  EXPECT_TRUE(solver->enqueue_steps(256));
  const ProfilingCounters before = testing::profiled();
  EXPECT_TRUE(solver->enqueue_steps(1024));
  const ProfilingCounters after = testing::profiled();
  EXPECT_EQ(after.fences, before.fences);
  EXPECT_EQ(after.allocations, before.allocations);
  EXPECT_EQ(after.copies, before.copies);
  EXPECT_EQ(after.h2d_bytes + after.d2h_bytes, before.h2d_bytes + before.d2h_bytes);
  EXPECT_FALSE(solver->failure());
  return after.kernel_launches - before.kernel_launches;
}

TEST(FabricProfiling, StepsOnlyLaunchKernels) {
  Parameters p = patch(Integrator::rk4);
  // On a device, one launch takes all steps between two checkpoints.
  EXPECT_LE(launches_of(p), (on_device ? 4 : 4 * 1024) + 4);
  p.driver = Driver::graph;
  EXPECT_LE(launches_of(p), (on_device ? 1 : 4) * 1024 + 4);
  p.driver = Driver::plain;
  // On a device, one kernel computes two stages.
  EXPECT_LE(launches_of(p), (on_device ? 2 : 4) * 1024 + 4);
  // At a checkpoint, a half kick completes the step and another one begins the next step.
  EXPECT_LE(launches_of(patch(Integrator::verlet)), 1024 + 4 + 4);
}

TEST(FabricProfiling, RepeatedQueriesDoNotAllocate) {
  testing::Sheets s = testing::folded(3.0);
  s.p.follower_pressures = {{testing::postfix({1.0}), {}}};
  const auto solver = create_solver(backend, s.p);
  solver->upload(s.x, s.v);
  std::vector<ContactWork> work(s.x.size());
  const auto query = [&] {
    EXPECT_TRUE(solver->enqueue_steps(2));
    EXPECT_GT(solver->totals().kinetic, 0.0);
    EXPECT_GT(solver->fastest_frequency(), 0.0);
    solver->download(s.x, s.v);
    solver->contact_work(work);
    return testing::profiled().allocations;
  };
  const std::int64_t before = query();
  EXPECT_EQ(query(), before);
}

TEST(FabricProfiling, BoundsTheMemoryPerVertex) {
  testing::profiled();
  const auto bytes_of = [](int rows) {
    Parameters p = patch(Integrator::rk4);
    p.mesh = random_patch(100, rows, 3);
    p.mass.assign(p.mesh.rest.size(), 0.01);
    p.driver = Driver::graph;
    const std::int64_t before = testing::profiled().device_bytes;
    const auto solver = create_solver(backend, p);
    return testing::profiled().device_bytes - before;
  };
  // Host backends store the rest values of triangles, devices recompute them.
  EXPECT_LT(static_cast<double>(bytes_of(60) - bytes_of(20)) / 4000.0, on_device ? 400.0 : 550.0);
}

TEST(FabricProfiling, BoundsTheLaunchesOfLoadsAndMotions) {
  using testing::postfix;
  const auto kernels = [](Integrator integrator, auto change) {
    Parameters p = patch(integrator);
    p.driver = Driver::graph;
    change(p);
    // Additional launches per step; checkpoints and their half kicks cancel in the difference.
    Parameters without = patch(integrator);
    without.driver = Driver::graph;
    return (launches_of(p) - launches_of(without)) / 1024;
  };
  const auto loads = [](Parameters& p) {
    p.timed_loads = {{postfix({"t"}), std::vector<Vector>(p.mass.size(), Vector{})}};
  };
  const auto pressure = [](Parameters& p) { p.follower_pressures = {{postfix({1.0}), {}}}; };
  const auto dashpots = [](Parameters& p) { p.relative_damping = 1.0; };
  const auto motion = [](Parameters& p) { p.motions = {{0, {3}, postfix({"t"})}}; };
  const auto all = [&](Parameters& p) { loads(p), pressure(p), dashpots(p), motion(p); };
  const auto of_host = [](int count) { return on_device ? 0 : count; };
  EXPECT_LE(kernels(Integrator::rk4, loads), of_host(4));
  EXPECT_LE(kernels(Integrator::rk4, pressure), of_host(4));
  EXPECT_LE(kernels(Integrator::rk4, dashpots), of_host(4));
  EXPECT_LE(kernels(Integrator::rk4, motion), of_host(4));
  EXPECT_LE(kernels(Integrator::rk4, all), of_host(8));
  EXPECT_LE(kernels(Integrator::verlet, loads), 1);
  EXPECT_LE(kernels(Integrator::verlet, dashpots), 1);
  EXPECT_LE(kernels(Integrator::verlet, motion), 1);
  EXPECT_LE(kernels(Integrator::verlet, all), 3);
}

TEST(FabricProfiling, ContactOnlyLaunchesKernels) {
  testing::Sheets s = testing::folded(3.0);
  const auto solver = create_solver(backend, s.p);
  solver->upload(s.x, s.v);
  EXPECT_TRUE(solver->enqueue_steps(10));
  const ProfilingCounters before = testing::profiled();
  EXPECT_TRUE(solver->enqueue_steps(100));
  const ProfilingCounters after = testing::profiled();
  EXPECT_EQ(after.fences, before.fences);
  EXPECT_EQ(after.allocations, before.allocations);
  EXPECT_EQ(after.copies, before.copies);
  // Contact before and after the two half steps of Verlet's method; on a device, each is one graph.
  EXPECT_LE(after.kernel_launches - before.kernel_launches, (on_device ? 1 + 2 + 1 : 27 + 2 + 27) * 100);
  EXPECT_FALSE(solver->failure());
}

TEST(FabricProfiling, AllocatesNoContactDataWithoutContact) {
  const auto bytes = [](bool self) {
    testing::Sheets s = testing::folded(3.0);
    s.p.contact.self = self;
    const ProfilingCounters before = testing::profiled();
    const auto solver = create_solver(backend, s.p);
    return testing::profiled().device_bytes - before.device_bytes;
  };
  const std::int64_t without = bytes(false);
  EXPECT_LT(without, 144 * 1500) << "the fabric alone";
  EXPECT_GT(bytes(true), without + 144 * 1500);
}

}  // namespace
}  // namespace drogue::fabric
