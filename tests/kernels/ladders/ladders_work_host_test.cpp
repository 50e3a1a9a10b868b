// ctest-label: no-sanitizer
#include <gtest/gtest.h>

#include <vector>

#include "tests/support/counted.hpp"

// Counts that must precede the kernels.
#include "perf/ladders/options/options_rung.hpp"
#include "perf/ladders/springs/tension.hpp"
#include "perf/ladders/weno/one_division.hpp"

// Checks the operations that the predictions of the ladders use.

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

/// Operations of a triangle around a vertex: its edges, `tensions(change)` and the force.
template <class Tension>
perf::Arithmetic counted_triangle(const Tension& tensions) {
  return arithmetic_of([&] {
    const auto point = [](double x) {
      return PointOf<Counted>{Counted::input(x), Counted::input(2.0 * x), Counted::input(3.0 * x)};
    };
    const Counted rest[3] = {Counted::input(1.0), Counted::input(1.1), Counted::input(1.2)};
    const TriangleEdges<Counted> edges(point(0.1), point(0.7), point(0.9), rest);
    const PointOf<Counted> force = edges.add_force(point(0.3), tensions(edges.change, rest));
    force.x.keep(), force.y.keep(), force.z.keep();
  });
}

TEST(SpringLadderWork, EqualsCountedOperations) {
  const perf::Arithmetic stored = counted_triangle([](const EdgeChangesOf<Counted>& change, const Counted*) {
    Counted stiffness[5];
    for (Counted& k : stiffness) k = Counted::input(2.0);
    return stored_tensions(change, stiffness);
  });
  EXPECT_EQ(stored.additions + stored.multiplications, stored_operations);
  EXPECT_EQ(stored.divisions, 0);
  const perf::Arithmetic recomputed =
      counted_triangle([](const EdgeChangesOf<Counted>& change, const Counted* rest) {
        return RecomputedTension::tensions(change, rest, Counted::input(0.5), Counted::input(3.0),
                                           Counted::input(0.7));
      });
  EXPECT_EQ(recomputed.additions + recomputed.multiplications, recomputed_operations);
  EXPECT_EQ(recomputed.divisions, 0);
}

TEST(OptionsLadderWork, EqualsCountedOperations) {
  const perf::Arithmetic counted = arithmetic_of([] {
    std::vector<Counted> right(option_nodes), pivots(option_nodes), v(option_nodes);
    for (Counted& value : right) value = Counted::input(1.0);
    const auto entry = [](std::vector<Counted>& row) {
      return [&row](int i) -> Counted& { return row[static_cast<std::size_t>(i)]; };
    };
    struct {
      Counted lower = Counted::input(0.2), diagonal = Counted::input(1.5), upper = Counted::input(0.3);
    } s;
    solve_step(s, Counted::input(0.8), entry(right), entry(pivots), entry(v));
    for (const Counted& value : v) value.keep();
  });
  // The first nodes have known neighbours.
  constexpr double inner = option_nodes - 2;
  EXPECT_NEAR(static_cast<double>(counted.additions + counted.multiplications) / inner,
              elimination_operations, 0.05);
  EXPECT_NEAR(static_cast<double>(counted.divisions) / inner, 1.0, 0.02);
}

}  // namespace
}  // namespace drogue::perf::ladder
