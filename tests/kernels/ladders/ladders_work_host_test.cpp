#include <gtest/gtest.h>

#include "tests/support/counted.hpp"

// Counts that must precede the kernels.
#include "perf/ladders/weno/one_division.hpp"

// Checks the operations per face that the predictions of the WENO ladder use.

namespace drogue::perf::ladder {
namespace {

using drogue::testing::arithmetic_of;
using drogue::testing::Counted;

template <class Flux>
perf::Arithmetic counted_face() {
  return arithmetic_of([] {
    CellState<Counted> cells[6];
    for (int k = 0; k < 6; ++k) {
      const auto of = [&](double value) { return Counted::input(value + 0.1 * k); };
      cells[k] = {of(1.0), of(0.5), of(3.0), of(0.5), of(1.0), of(4.0), of(1.2)};
    }
    const ConservedVector<Counted> f = Flux::template face<Counted>(1.4, cells);
    f.rho.keep(), f.m.keep(), f.energy.keep();
  });
}

template <class Flux>
void expect_counted(const char* name) {
  const perf::Arithmetic counted = counted_face<Flux>(), stated = Flux::arithmetic;
  EXPECT_EQ(counted.additions, stated.additions) << name;
  EXPECT_EQ(counted.multiplications, stated.multiplications) << name;
  EXPECT_EQ(counted.divisions, stated.divisions) << name;
  EXPECT_EQ(counted.roots, stated.roots) << name;
}

TEST(WenoLadderWork, EqualsCountedOperations) {
  expect_counted<DirectFlux>("direct");
  expect_counted<DifferenceFlux>("differences");
  expect_counted<OneDivisionFlux>("one division");
}

}  // namespace
}  // namespace drogue::perf::ladder
