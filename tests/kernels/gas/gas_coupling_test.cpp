// ctest-label: exact
#include <gtest/gtest.h>

#include "kernels/device/launch.hpp"
#include "kernels/gas/gas_solver.hpp"
#include "tests/support/backend.hpp"
#include "tests/support/gas_state.hpp"
#include "tests/support/profiled.hpp"

// Coupling of a gas solver to other kernels on the device.

namespace drogue::gas {
namespace {

using namespace drogue::testing;  // NOLINT: helpers of these tests

using Space = DROGUE_TEST_SPACE;

/// Copies the density of the last accepted step to a View of another solver.
struct ReadDensity {
  gas::GasState<Space> state;
  Kokkos::View<double*, Space::memory_space> density;

  KOKKOS_FUNCTION void operator()(const int i) const { density(i) = state.now()(i, 0); }
};

TEST(GasCoupling, AnotherKernelReadsTheStateBetweenStepsWithoutACopy) {
  Parameters p;
  p.cells = 300;
  p.left = p.right = Boundary::periodic;
  p.positivity = Positivity::off;
  const testing::GasState initial = random_state(p, 3, rough);
  const auto expected_solver = started(tested_backend, p, initial);
  ASSERT_EQ(expected_solver->advance(1.0, 7, 0, {}, {}), Stop::pause);
  const testing::GasState expected = download(*expected_solver, p);

  for (const Driver driver : {Driver::plain, Driver::graph, Driver::automatic}) {
    p.driver = driver;
    const device::Instance<Space> instance(1);
    GasSolver<Space> solver(instance, p);
    solver.upload(0, fields(initial));
    solver.start();
    const ReadDensity read{solver.state(), decltype(ReadDensity::density)("density", 300)};
    solver.enqueue_begin(1.0);
    solver.enqueue_step();  // captures a graph
    const device::ProfilingCounters before = profiled();
    for (int step = 1; step < 7; ++step) {
      solver.enqueue_step();
      device::launch_each(instance.space(), "read_density", 300, read);
    }
    const device::ProfilingCounters after = profiled();
    EXPECT_EQ(after.fences, before.fences) << solver.driver();
    EXPECT_EQ(after.copies, before.copies) << solver.driver();
    const auto density = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), read.density);
    EXPECT_EQ(solver.restart_state().step, 7) << solver.driver();
    for (std::size_t i = 0; i < 300; ++i) EXPECT_EQ(density(i), expected[0][i]) << solver.driver();
  }
}

}  // namespace
}  // namespace drogue::gas
