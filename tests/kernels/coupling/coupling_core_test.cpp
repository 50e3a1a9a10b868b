#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "kernels/flow/axis_lines.hpp"
#include "kernels/flow/face_views.hpp"
#include "kernels/flow/make_grid.hpp"
#include "tests/support/coupled_case.hpp"
#include "tests/support/flow_faces.hpp"

// Sheets in the core of stretched grids.

namespace drogue::coupling {
namespace {

using drogue::testing::CoupledCase;
using drogue::testing::CoupledRun;
using drogue::testing::set_graded_widths;
using fabric::Vector;
using flow::BoundaryKind;
using Space = Kokkos::DefaultHostExecutionSpace;

TEST(ForceBox, IsTheCoreWithoutCellsBesideWiderOnes) {
  flow::Parameters p;
  p.cells = {9, 6, 1};
  p.low = {0.0, -1.0, 0.0};
  p.high = {12.0, 2.0, 1.0};
  p.faces[0] = {0.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 10.0, 12.0};
  p.faces[1] = {-1.0, -0.5, 0.0, 0.5, 1.0, 1.5, 2.0};
  p.faces[1][6] = p.high[1] = 2.5;
  // Periodic sides are none: beyond them lies the cell at the other end.
  EXPECT_EQ(flow::force_box(p).begin[1], 1);
  EXPECT_EQ(flow::force_box(p).cells[1], 3);
  for (flow::Boundary& side : p.boundary) side.kind = BoundaryKind::slip;
  const flow::Core box = flow::force_box(p);
  EXPECT_EQ(box.begin, (std::array<int, 3>{2, 0, 0}));
  EXPECT_EQ(box.cells, (std::array<int, 3>{4, 4, 1}));
  EXPECT_EQ(box.low, (std::array<double, 3>{3.0, -1.0, 0.0}));
  EXPECT_EQ(box.high, (std::array<double, 3>{7.0, 1.0, 1.0}));
  EXPECT_EQ(box.spacing, (std::array<double, 3>{1.0, 0.5, 1.0}));
  p.faces = {};
  EXPECT_EQ(flow::force_box(p), flow::core_of(p));
}

TEST(ForceBox, RanksShareItsFacesWhereTheFlowKeepsThem) {
  flow::Parameters p;
  p.cells = {14, 16, 13};
  p.boundary[0].kind = p.boundary[1].kind = BoundaryKind::slip;
  p.boundary[2].kind = p.boundary[3].kind = BoundaryKind::wall;
  set_graded_widths(p, 0, 8, 1.2, 2.0);
  set_graded_widths(p, 1, 7, 1.1, 2.0);
  const flow::Core box = flow::force_box(p);
  for (const int ranks : {1, 4, 6}) {
    std::array<std::set<std::array<int, 3>>, 3> found;
    for (int rank = 0; rank < ranks; ++rank) {
      const flow::MacGrid g = flow::make_grid(p, flow::ranks_of(p, ranks, rank, false));
      const FaceWindow window = flow::face_window(g, box);
      const flow::List<Space> values("values", static_cast<std::size_t>(3 * g.component));
      const auto views = flow::face_views<Space>(g, box, values);
      for (int c = 0; c < 3; ++c)
        for (int k = 0; k < window.faces(c, 2); ++k)
          for (int j = 0; j < window.faces(c, 1); ++j)
            for (int i = 0; i < window.faces(c, 0); ++i) {
              std::array<int, 3> face = {i, j, k};
              for (int axis = 0; axis < 3; ++axis)
                face[static_cast<std::size_t>(axis)] += window.first(c, axis);
              EXPECT_TRUE(found[static_cast<std::size_t>(c)].insert(face).second);
              const auto own = [&](int axis) {
                const auto a = static_cast<std::size_t>(axis);
                return face[a] + box.begin[a] - g.origin[axis];
              };
              EXPECT_EQ(&views.component[c](static_cast<std::size_t>(i), static_cast<std::size_t>(j),
                                            static_cast<std::size_t>(k)),
                        values.data() + c * g.component + g.offset(own(0), own(1), own(2)));
            }
    }
    const StaggeredGrid grid = flow::coupling_grid(flow::make_grid(p), box);
    EXPECT_EQ(grid.periodic, (std::array<bool, 3>{false, false, true}));
    for (int c = 0; c < 3; ++c)
      EXPECT_EQ(found[static_cast<std::size_t>(c)].size(),
                static_cast<std::size_t>(faces_along(grid, c, 0) * faces_along(grid, c, 1) *
                                         faces_along(grid, c, 2)))
          << ranks;
  }
}

/// Gives an axis a core of `cells` cells of h, m, in its middle, and `outer` cells on each side that grow to
/// the ends of the domain.
void set_core(flow::Parameters& p, std::size_t axis, int cells, double h, int outer) {
  const double length = 0.5 * (p.high[axis] - p.low[axis] - cells * h) / h;
  double ratio = 1.0;
  for (double step = 0.25; step > 1e-16; step *= 0.5) {
    double sum = 0.0;
    for (int k = 1; k <= outer; ++k) sum += std::pow(ratio + step, k);
    if (sum < length) ratio += step;
  }
  std::vector<double> widths(static_cast<std::size_t>(cells), 1.0);
  for (int k = 1; k <= outer; ++k) {
    widths.push_back(std::pow(ratio, k));
    widths.insert(widths.begin(), widths.back());
  }
  p.cells[axis] = cells + 2 * outer;
  drogue::testing::set_widths(p, axis, widths);
}

/// A porous strip askew in the middle of a box of 3.2 m by 2.4 m, on a uniform grid of cells of 0.1 m, or in
/// a core of them of 1.6 m by 1.6 m.
CoupledCase strip_in_core(bool is_stretched) {
  CoupledCase c(32, 24, 0.1, 0.002);
  if (is_stretched) {
    set_core(c.p.flow, 0, 16, 0.1, 6);
    set_core(c.p.flow, 1, 16, 0.1, 3);
  }
  c.add_strip(1.55, 0.9, 1.7, 1.5, 12);
  return c;
}

/// Starts air at a speed along x, m/s, everywhere.
void start_wind(CoupledRun& run, const CoupledCase& c, double speed) {
  const std::array<int, 3> n = flow::extents(c.p.flow, 0);
  run.solver->flow().upload("velocity_x",
                            std::vector<double>(static_cast<std::size_t>(n[0] * n[1] * n[2]), speed));
  run.solver->start();
}

TEST(CoupledCore, AirAndSheetExchangeMomentumWithoutLoss) {
  const CoupledCase c = strip_in_core(true);
  CoupledRun run(c);
  start_wind(run, c, 5.0);
  double before = run.solver->flow().totals().momentum[0];
  EXPECT_NEAR(before, 5.0 * c.p.flow.density * c.volume(), 1e-12);
  for (int step = 0; step < 20; ++step) {
    ASSERT_TRUE(run.advance(1));
    const Vector force = run.force();
    const auto on_grid = run.solver->total_force_on_air();
    const double after = run.solver->flow().totals().momentum[0];
    EXPECT_LT(force[0], -0.1);
    for (const std::size_t axis : {0U, 1U})
      EXPECT_NEAR(on_grid[axis], force[axis], 1e-13 * std::abs(force[0]));
    // As much as the convection and diffusion of this periodic box keep.
    EXPECT_NEAR(after - before, 0.002 * force[0], 1e-12 * before);
    before = after;
  }
}

TEST(CoupledCore, ForcesAreThoseOfAUniformGridOfItsCells) {
  double force[2] = {};
  for (const bool is_stretched : {false, true}) {
    CoupledCase c = strip_in_core(is_stretched);
    c.p.flow.boundary[0].kind = BoundaryKind::inflow;
    c.p.flow.boundary[0].velocity = {5.0, 0.0, 0.0};
    c.p.flow.boundary[1].kind = BoundaryKind::outflow;
    c.p.flow.boundary[2].kind = c.p.flow.boundary[3].kind = BoundaryKind::slip;
    CoupledRun run(c);
    start_wind(run, c, 5.0);
    ASSERT_TRUE(run.advance(150));
    force[is_stretched ? 1 : 0] = run.force()[0];
  }
  EXPECT_LT(force[0], -1.0);
  EXPECT_NEAR(force[1] / force[0], 1.0, 0.005);
}

TEST(CoupledCore, ContinuesBitForBit) {
  CoupledCase c = strip_in_core(true);
  std::ranges::fill(c.p.fabric.pinned, std::uint8_t{0});
  CoupledRun whole(c), first(c);
  for (CoupledRun* run : {&whole, &first}) {
    start_wind(*run, c, 3.0);
    ASSERT_TRUE(run->advance(16));
  }
  ASSERT_TRUE(whole.advance(16));
  const auto second = create_solver(drogue::testing::tested_backend, c.p);
  drogue::testing::restore(drogue::testing::coupled_state(*first.solver), *second);
  ASSERT_EQ(second->advance(1e9, 32, {}), flow::Stop::pause);
  EXPECT_EQ(drogue::testing::coupled_state(*second).flow, drogue::testing::coupled_state(*whole.solver).flow);
}

TEST(CoupledCore, ClothThatLeavesItIsAFailure) {
  CoupledCase c = strip_in_core(true);
  std::ranges::fill(c.p.fabric.pinned, std::uint8_t{0});
  c.set_mass(50.0);
  for (Vector& v : c.v) v = {10.0, 0.0, 0.0};
  CoupledRun run(c);
  ASSERT_EQ(run.solver->advance(0.2, -1, {}), flow::Stop::failed);
  EXPECT_EQ(run.solver->failure().reason, FailureReason::left_domain);
  std::vector<Vector> x(c.x.size()), v(x);
  run.solver->fabric().download(x, v);
  const double rightmost = std::ranges::max(x, {}, [](const Vector& at) { return at[0]; })[0];
  // The core ends at 2.4 m; its last cell bears no forces, and the delta function needs a cell.
  EXPECT_GT(rightmost, 2.4 - 0.2 - 0.03);
  EXPECT_LT(rightmost, 2.4 - 0.2 + 0.03);
}

}  // namespace
}  // namespace drogue::coupling
