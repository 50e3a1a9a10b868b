#include <gtest/gtest.h>

#include "perf/ceilings/ceilings.hpp"
#include "tests/support/backend.hpp"

// Results of the kernels that measure the ceilings of a backend against their closed forms.

namespace drogue::perf {
namespace {

class Ceilings : public ::testing::TestWithParam<Ceiling> {};

TEST_P(Ceilings, EqualsClosedForm) {
  const auto kernel = create_ceiling(testing::tested_backend, GetParam());
  // The chains round at every step; the triads add small integers, which is exact.
  const double tolerance = GetParam() == Ceiling::fp64 ? 1e-9 : 0.0;
  for (int round = 0; round < 2; ++round) {
    kernel->reset();
    EXPECT_GT(kernel->error(), 0.1) << "before the first run";
    kernel->run();
    EXPECT_LE(kernel->error(), tolerance);
  }
  EXPECT_GT(kernel->flops(), 0.0);
  EXPECT_GT(kernel->bytes(), 0.0);
}

INSTANTIATE_TEST_SUITE_P(All, Ceilings, ::testing::Values(Ceiling::fp64, Ceiling::memory, Ceiling::cache));

}  // namespace
}  // namespace drogue::perf
