#include <gtest/gtest.h>

#include <vector>

#include "tests/support/flow_oracle.hpp"

// Momentum rates, projection and whole steps against the oracle on random data.

namespace drogue::flow {
namespace {

using namespace drogue::testing;  // NOLINT: helpers of these tests

TEST(FlowMomentum, RatesInPeriodicBoxesEqualThoseOfTheReference) {
  const Sides periodic{BoundaryKind::periodic, BoundaryKind::periodic};
  for (const Advection scheme : schemes)
    for (const std::array<int, 3>& cells : {std::array<int, 3>{13, 9, 7},
                                            {33, 5, 6},
                                            {67, 4, 4},
                                            {4, 4, 4},
                                            {12, 1, 9},
                                            {17, 10, 1},
                                            {1, 8, 6},
                                            {19, 1, 1}})
      expect_equal_rates(parameters_of(cells, {periodic, periodic, periodic}, scheme), 11);
}

// ctest-label: smoke
TEST(FlowMomentum, RatesBetweenBoundedSidesEqualThoseOfTheReference) {
  const Sides walls{BoundaryKind::wall, BoundaryKind::slip},
      through{BoundaryKind::inflow, BoundaryKind::outflow};
  for (const Advection scheme : schemes)
    for (const std::array<int, 3>& cells :
         {std::array<int, 3>{13, 9, 7}, {33, 5, 6}, {12, 1, 9}, {17, 10, 1}}) {
      expect_equal_rates(parameters_of(cells, {through, walls, walls}, scheme), 12);
      expect_equal_rates(parameters_of(cells, {walls, walls, through}, scheme), 13);
    }
}

TEST(FlowMomentum, RatesWithEddyViscositiesEqualThoseOfTheReference) {
  const Sides periodic{BoundaryKind::periodic, BoundaryKind::periodic},
      walls{BoundaryKind::wall, BoundaryKind::slip}, through{BoundaryKind::inflow, BoundaryKind::outflow};
  for (const Turbulence model : {Turbulence::smagorinsky, Turbulence::vreman})
    for (const std::array<int, 3>& cells : {std::array<int, 3>{13, 9, 7}, {12, 1, 9}, {17, 10, 1}, {1, 8, 6}})
      for (const std::array<Sides, 3>& sides : {std::array<Sides, 3>{periodic, periodic, periodic},
                                                {through, walls, walls},
                                                {walls, through, periodic},
                                                {periodic, walls, through}}) {
        Parameters p = parameters_of(cells, sides, Advection::central);
        p.turbulence = model;
        p.turbulence_constant = 0.6;  // larger than usual, so that its stress matters
        expect_equal_rates(p, 14);
        if (HasFatalFailure()) return;
      }
}

TEST(FlowStep, EqualsTheReferenceForAllPairsOfSidesInTwoDimensions) {
  const Sides periodic{BoundaryKind::periodic, BoundaryKind::periodic};
  unsigned seed = 100;
  for (const Sides& x : all_sides())
    for (const Sides& y : all_sides())
      for (const TimeScheme time : {TimeScheme::ab2, TimeScheme::rk3}) {
        Parameters p = parameters_of({6, 5, 1}, {x, y, periodic}, schemes[seed % 3]);
        p.time_scheme = time;
        expect_equal_steps(p, ++seed);
        if (HasFatalFailure()) return;
      }
}

TEST(FlowStep, EqualsTheReferenceForPairsOfSidesInThreeDimensions) {
  const std::vector<Sides> sides = all_sides();
  unsigned seed = 1000;
  for (std::size_t i = 0; i < sides.size(); ++i)
    for (const TimeScheme time : {TimeScheme::ab2, TimeScheme::rk3}) {
      Parameters p =
          parameters_of({5, 4, 6}, {sides[i], sides[(i + 5) % 17], sides[(i + 11) % 17]}, schemes[seed % 3]);
      p.time_scheme = time;
      expect_equal_steps(p, ++seed);
      if (HasFatalFailure()) return;
    }
}

TEST(FlowStep, EqualsTheReferenceByDiagonalization) {
  const Sides through{BoundaryKind::inflow, BoundaryKind::outflow},
      walls{BoundaryKind::wall, BoundaryKind::wall};
  for (const TimeScheme time : {TimeScheme::ab2, TimeScheme::rk3})
    for (const Sides& x : {through, walls}) {
      Parameters p = parameters_of({7, 5, 6}, {x, walls, {BoundaryKind::periodic, BoundaryKind::periodic}},
                                   Advection::weno_z);
      p.time_scheme = time;
      p.pressure_solver = PressureSolver::diagonalization;
      expect_equal_steps(p, 2000);
    }
}

TEST(FlowStep, EqualsTheReferenceWithImplicitDiffusionForAllPairsOfSides) {
  const Sides periodic{BoundaryKind::periodic, BoundaryKind::periodic};
  unsigned seed = 4000;
  for (const Sides& x : all_sides())
    for (const Sides& y : all_sides()) {
      Parameters p = parameters_of({6, 5, 1}, {x, y, periodic}, schemes[seed % 3]);
      p.time_scheme = TimeScheme::ab2;
      p.diffusion = Diffusion::crank_nicolson;
      p.viscosity = 2.0;  // nu dt / h^2 is 0.4
      if (seed % 2 == 0) p.pressure_solver = PressureSolver::diagonalization;
      expect_equal_steps(p, ++seed);
      if (HasFatalFailure()) return;
    }
}

TEST(FlowStep, EqualsTheReferenceWithImplicitDiffusionInThreeDimensions) {
  const std::vector<Sides> sides = all_sides();
  unsigned seed = 5000;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    Parameters p =
        parameters_of({5, 4, 6}, {sides[i], sides[(i + 5) % 17], sides[(i + 11) % 17]}, schemes[seed % 3]);
    p.time_scheme = TimeScheme::ab2;
    p.diffusion = Diffusion::crank_nicolson;
    p.viscosity = 2.0;
    expect_equal_steps(p, ++seed);
    if (HasFatalFailure()) return;
  }
}

TEST(FlowStep, EqualsTheReferenceWithEddyViscositiesForPairsOfSides) {
  const std::vector<Sides> sides = all_sides();
  unsigned seed = 6000;
  for (std::size_t i = 0; i < sides.size(); ++i)
    for (const TimeIntegration& integration : time_integrations) {
      Parameters p =
          parameters_of({5, 4, 6}, {sides[i], sides[(i + 5) % 17], sides[(i + 11) % 17]}, schemes[seed % 3]);
      integration.set(p);
      p.turbulence = seed % 2 == 0 ? Turbulence::smagorinsky : Turbulence::vreman;
      expect_equal_steps(p, ++seed);
      if (HasFatalFailure()) return;
    }
}

TEST(FlowStep, EvaluatesExpressionsOfSidesAtTheTimesOfTheStages) {
  const Sides through{BoundaryKind::inflow, BoundaryKind::outflow},
      walls{BoundaryKind::wall, BoundaryKind::slip};
  const Sides periodic{BoundaryKind::periodic, BoundaryKind::periodic};
  for (const TimeIntegration& integration : time_integrations)
    for (const Sides& beside : {walls, periodic}) {
      Parameters p = parameters_of({6, 5, 4}, {through, beside, beside}, Advection::weno_z);
      integration.set(p);
      // Component c is 1 + 40 t y + (c + 1) z.
      for (int c = 0; c < 3; ++c) {
        device::ExpressionBuilder builder;
        builder.push("constant", 40.0);
        builder.push("t");
        builder.push("*");
        builder.push("y");
        builder.push("*");
        builder.push("constant", c + 1.0);
        builder.push("z");
        builder.push("*");
        builder.push("+");
        builder.push("constant", 1.0);
        builder.push("+");
        p.boundary[0].velocity_expressions.push_back(builder.program());
      }
      expect_equal_steps(
          p, 3000, [&](std::size_t side, std::size_t component, const reference::Point& point, double t) {
            if (side != 0) return p.boundary[side].velocity[component];
            return 1.0 + 40.0 * t * point[1] + (static_cast<double>(component) + 1.0) * point[2];
          });
    }
}

}  // namespace
}  // namespace drogue::flow
