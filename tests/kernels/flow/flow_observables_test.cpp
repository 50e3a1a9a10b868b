#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "kernels/reference/flow/observables.hpp"
#include "tests/support/expression_program.hpp"
#include "tests/support/flow_case.hpp"

// Totals and fields at cell centres against the oracle on random data, corners of the ghost region included.

namespace drogue::flow {
namespace {

using namespace drogue::testing;  // NOLINT: helpers of these tests
using reference::GridIndex;

constexpr const auto& backend = testing::tested_backend;

/// Domains that are periodic, bounded, and one cell thick.
std::vector<Parameters> domains() {
  Parameters bounded = periodic_box({7, 6, 5});
  bounded.high = {2.0, 0.6, 1.1};
  bounded.density = 1.3;
  bounded.viscosity = 0.05;
  const BoundaryKind kinds[] = {BoundaryKind::inflow, BoundaryKind::outflow, BoundaryKind::wall,
                                BoundaryKind::slip,   BoundaryKind::wall,    BoundaryKind::wall};
  for (std::size_t side = 0; side < 6; ++side) {
    bounded.boundary[side].kind = kinds[side];
    if (kinds[side] == BoundaryKind::wall || kinds[side] == BoundaryKind::inflow)
      bounded.boundary[side].velocity = {0.3, -0.2, 0.1 * static_cast<double>(side)};
    if (kinds[side] == BoundaryKind::wall) bounded.boundary[side].velocity[side / 2] = 0.0;
  }
  Parameters thick = periodic_box({9, 8, 7}), thin = periodic_box({9, 1, 7}), plane = bounded;
  thin.high[1] = 0.3;
  thin.viscosity = thick.viscosity = 0.02;
  plane.cells[2] = 1;
  plane.boundary[4].kind = plane.boundary[5].kind = BoundaryKind::periodic;
  return {thick, thin, bounded, plane};
}

TEST(FlowObservables, TotalsEqualThoseOfTheReference) {
  for (const Parameters& p : domains()) {
    const FlowDomain domain(p);
    const auto solver = started(backend, p, random_field(domain, 21));
    const Totals totals = solver->totals();
    const StaggeredField u = velocity(*solver);
    const reference::FlowSums sums = reference::flow_sums(domain, u, 0.0);
    const auto near = [&](double value, double expected) {
      EXPECT_NEAR(value, expected, 1e-13 * (1.0 + std::abs(expected)));
    };
    near(totals.kinetic_energy, sums.kinetic_energy);
    near(totals.enstrophy, sums.enstrophy);
    near(totals.dissipation, sums.dissipation);
    for (std::size_t c = 0; c < 3; ++c) near(totals.momentum[c], sums.momentum[c]);
    near(totals.max_speed, sums.max_speed);
    for (std::size_t side = 0; side < 6; ++side) near(totals.outflow[side], sums.outflow[side]);
    double squares = 0.0, most = 0.0;
    for (const double value : reference::divergence(domain, u)) {
      squares += value * value / static_cast<double>(p.cells[0] * p.cells[1] * p.cells[2]);
      most = std::max(most, std::abs(value));
    }
    EXPECT_NEAR(totals.divergence_rms, std::sqrt(squares), 1e-13);
    EXPECT_NEAR(totals.divergence_max, most, 1e-13);
  }
}

TEST(FlowObservables, TotalsBesideProfilesOfSidesEqualThoseOfTheReference) {
  for (const BoundaryKind y : {BoundaryKind::periodic, BoundaryKind::wall, BoundaryKind::slip})
    for (const BoundaryKind z : {BoundaryKind::periodic, BoundaryKind::outflow, BoundaryKind::wall}) {
      Parameters p = domains()[2];
      for (std::size_t side = 2; side < 6; ++side) p.boundary[side] = {side < 4 ? y : z, {}, {}};
      // Defined only where 0 <= y <= 0.6 and 0 <= z <= 1.1.
      const auto profile = postfix({"y", 0.6, "y", "-", "*", "z", "*", 1.1, "z", "-", "*", "sqrt", "y", "+"});
      p.boundary[0].velocity_expressions = {profile, profile, profile};
      const FlowDomain domain(
          p, [&](std::size_t side, std::size_t component, const reference::Point& at, double) {
            if (side != 0) return p.boundary[side].velocity[component];
            return std::sqrt(at[1] * (0.6 - at[1]) * at[2] * (1.1 - at[2])) + at[1];
          });
      const auto solver = started(backend, p, random_field(domain, 23));
      const Totals totals = solver->totals();
      const reference::FlowSums sums = reference::flow_sums(domain, velocity(*solver), 0.0);
      EXPECT_NEAR(totals.enstrophy, sums.enstrophy, 1e-12 * sums.enstrophy);
      EXPECT_NEAR(totals.dissipation, sums.dissipation, 1e-12 * sums.dissipation);
    }
}

TEST(FlowObservables, SamplesEqualThoseOfTheReference) {
  for (const Parameters& p : domains()) {
    const FlowDomain domain(p);
    const auto solver = started(backend, p, random_field(domain, 22));
    ASSERT_EQ(solver->advance(endless, 1, {}), Stop::pause);
    const StaggeredField u = velocity(*solver);
    const double time = solver->progress().time;
    const std::size_t cells = static_cast<std::size_t>(p.cells[0] * p.cells[1] * p.cells[2]);
    std::vector<double> speed(3 * cells), vorticity(3 * cells), pressure(cells), q(cells);
    solver->sample(CellField::velocity, speed);
    solver->sample(CellField::vorticity, vorticity);
    solver->sample(CellField::pressure, pressure);
    solver->sample(CellField::q_criterion, q);
    const std::vector<double> kinematic = reference::present_pressure(domain, u, time);
    domain.for_each_cell([&](const GridIndex& cell) {
      const auto at = static_cast<std::size_t>((cell[0] * p.cells[1] + cell[1]) * p.cells[2] + cell[2]);
      const auto gradient = reference::velocity_gradient(domain, u, cell, time);
      double product = 0.0;
      for (std::size_t c = 0; c < 3; ++c) {
        GridIndex next = cell;
        if (p.cells[c] > 1) ++next[c];
        EXPECT_NEAR(speed[3 * at + c],
                    0.5 * (domain.velocity(u, c, cell, time) + domain.velocity(u, c, next, time)), 1e-14);
        const std::size_t a = (c + 1) % 3, b = (c + 2) % 3;
        EXPECT_NEAR(vorticity[3 * at + c], gradient[b][a] - gradient[a][b], 1e-12);
        for (std::size_t d = 0; d < 3; ++d) product += gradient[c][d] * gradient[d][c];
      }
      EXPECT_NEAR(q[at], -0.5 * product, 1e-11);
      // Where fluid flows back, the solver takes the dynamic pressure at the end of a very short step.
      EXPECT_NEAR(pressure[at], p.density * kinematic[domain.cell_at(cell)], 1e-4 * largest(kinematic));
    });
  }
}

TEST(FlowObservables, TotalsDoNotDependOnTheBackend) {
  for (const Parameters& p : domains()) {
    const StaggeredField u = random_field(FlowDomain(p), 23);
    const Totals first = started(device::compiled_backends().front(), p, u)->totals();
    const Totals second = started(backend, p, u)->totals();
    EXPECT_NEAR(first.kinetic_energy, second.kinetic_energy, 1e-14);
    EXPECT_NEAR(first.enstrophy, second.enstrophy, 1e-12 * first.enstrophy);
  }
}

}  // namespace
}  // namespace drogue::flow
