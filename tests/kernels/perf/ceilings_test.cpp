// ctest-label: no-sanitizer
#include <gtest/gtest.h>

#include "kernels/device/stopwatch.hpp"
#include "perf/ceilings/ceilings.hpp"
#include "tests/support/backend.hpp"

// Results of the kernels that measure the ceilings of a backend against their closed forms.

namespace drogue::perf {
namespace {

class Ceilings : public ::testing::TestWithParam<Ceiling> {};

/// Largest error: chains round at every step, by at most half a unit in the last place of their values, which
/// the next steps reduce; triads and counts add small integers, which is exact.
double largest_error(Ceiling ceiling) {
  if (ceiling == Ceiling::fp64) return 1e-9;
  return ceiling == Ceiling::fp32 || ceiling == Ceiling::issue ? 1e-3 : 0.0;
}

TEST_P(Ceilings, EqualsClosedForm) {
  if (!has_ceiling(testing::tested_backend, GetParam())) {
    EXPECT_THROW(static_cast<void>(create_ceiling(testing::tested_backend, GetParam())),
                 std::invalid_argument);
    return;
  }
  const auto kernel = create_ceiling(testing::tested_backend, GetParam());
  const double tolerance = largest_error(GetParam());
  for (int round = 0; round < 2; ++round) {
    kernel->reset();
    EXPECT_GT(kernel->error(), 0.1) << "before the first run";
    kernel->run();
    EXPECT_LE(kernel->error(), tolerance);
  }
  const bool is_latency = GetParam() == Ceiling::launch || GetParam() == Ceiling::graph_node;
  EXPECT_EQ(kernel->flops() > 0.0, !is_latency);
  EXPECT_EQ(kernel->bytes() > 0.0, !is_latency);
  EXPECT_EQ(kernel->launches() > 1, is_latency);
  EXPECT_EQ(kernel->instructions() > 0.0, GetParam() == Ceiling::issue);
}

TEST_P(Ceilings, RunsOnADeviceBetweenItsEvents) {
  if (!has_ceiling(testing::tested_backend, GetParam())) return;
  const auto kernel = create_ceiling(testing::tested_backend, GetParam());
  kernel->reset();
  const device::Stopwatch watch;
  const double seconds = kernel->timed_run(), wall = watch.seconds();
  if (device::needs_device(testing::tested_backend)) {
    EXPECT_GT(seconds, 0.0);
    EXPECT_LT(seconds, wall);
    EXPECT_LE(kernel->error(), largest_error(GetParam()));
  } else {
    EXPECT_EQ(seconds, 0.0);
    EXPECT_GT(kernel->error(), 0.1) << "no event times a host, so nothing runs";
  }
}

TEST(CeilingList, HasTheCachesOfAHostOrTheLatenciesOfADevice) {
  const bool on_device = device::needs_device(testing::tested_backend);
  for (const Ceiling ceiling :
       {Ceiling::fp64, Ceiling::fp32, Ceiling::memory, Ceiling::cache, Ceiling::launch})
    EXPECT_TRUE(has_ceiling(testing::tested_backend, ceiling));
  for (const Ceiling ceiling : {Ceiling::issue, Ceiling::graph_node})
    EXPECT_EQ(has_ceiling(testing::tested_backend, ceiling), on_device);
  EXPECT_EQ(has_ceiling(testing::tested_backend, Ceiling::l2), !on_device);
}

INSTANTIATE_TEST_SUITE_P(All, Ceilings,
                         ::testing::Values(Ceiling::fp64, Ceiling::fp32, Ceiling::issue, Ceiling::memory,
                                           Ceiling::cache, Ceiling::l2, Ceiling::l3, Ceiling::launch,
                                           Ceiling::graph_node));

}  // namespace
}  // namespace drogue::perf
