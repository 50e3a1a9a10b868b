// ctest-label: no-sanitizer
#include "perf/models/tridiagonal.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/support/counted.hpp"

// These headers must follow the definition of the counted type.
#include "perf/tridiagonal/solve_spd.hpp"
#include "perf/tridiagonal/solve_toeplitz.hpp"

// Checks the work of perf/models/tridiagonal.hpp by counting the operations of the kernels.

namespace drogue::perf {
namespace {

using testing::arithmetic_of;
using testing::Counted;

std::vector<Counted> inputs(int count, double value) {
  std::vector<Counted> made;
  for (int i = 0; i < count; ++i) made.push_back(Counted::input(value));
  return made;
}

TEST(TridiagonalWork, CountsTheOperationsOfPttrf) {
  using View = Kokkos::View<Counted**, Kokkos::LayoutRight, Kokkos::HostSpace, Kokkos::MemoryUnmanaged>;
  for (const int n : {2, 5, 64}) {
    std::vector<Counted> diagonal, off_diagonal, right;
    const Arithmetic counted = arithmetic_of([&] {
      diagonal = inputs(n, 4.0), off_diagonal = inputs(n - 1, -1.0), right = inputs(n, 2.0);
      tridiagonal::SpdFunctor<View, View, View>{
          View(diagonal.data(), 1, n), View(off_diagonal.data(), 1, n - 1), View(right.data(), 1, n)}(0);
      for (const auto* row : {&diagonal, &off_diagonal, &right})
        for (const Counted& number : *row) number.keep();
    });
    EXPECT_EQ(counted, spd_arithmetic(n)) << n;
    // Inner unknowns of a long system tend to 2/(4 - 2).
    const double distance_to_end = n / 2 - 1;
    EXPECT_NEAR(right[static_cast<std::size_t>(n / 2)].value, 1.0,
                std::pow(2.0 - std::sqrt(3.0), distance_to_end));
  }
}

/// Operations of `ToeplitzFunctor::in_scratch`.
Arithmetic count_recurrences(int nodes) {
  const options::SerialThreadGroup<Counted> group;
  const int block = options::block_of(nodes, group.lanes), count = block * group.lanes;
  return arithmetic_of([&] {
    std::vector<Counted> y = inputs(count, 1.0), x(y.size()), scratch(9 * options::max_lanes);
    const std::vector<Counted> floor(y.size(), Counted(-options::unbounded));
    const Counted inverse = Counted::input(0.5), from_left = Counted::input(0.25),
                  from_right = Counted::input(0.25), boundary = Counted::input(1.0);
    for (int i = 0; i < count; ++i) {
      const auto at = static_cast<std::size_t>(i);
      y[at] = i < nodes ? inverse * y[at] : Counted(0.0);
    }
    options::recur_backward(group, {y.data()}, block, from_right, scratch.data());
    options::recur_forward(group, x.data(), y.data(), floor.data(), block, nodes, from_left, boundary,
                           scratch.data());
    for (const Counted& number : x) number.keep();
  });
}

TEST(TridiagonalWork, CountsTheOperationsOfRecurrences) {
  for (const int nodes : {64, 128, 256}) {
    const Arithmetic counted = count_recurrences(nodes);
    EXPECT_EQ(counted, toeplitz_arithmetic(nodes)) << nodes;
    // On one lane five operations per node would do.
    EXPECT_GT(counted.flops(), 5 * (nodes - 1)) << nodes;
  }
  EXPECT_EQ(toeplitz_arithmetic(100), Arithmetic{});
}

TEST(TridiagonalWork, ReadsAndWritesEachArrayOnce) {
  EXPECT_EQ(spd_bytes(10), 2 * 8 * (10 + 9 + 10));
  EXPECT_EQ(toeplitz_bytes(10), 8 * (4 + 10 + 10));
}

}  // namespace
}  // namespace drogue::perf
