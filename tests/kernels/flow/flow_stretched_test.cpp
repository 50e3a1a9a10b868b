#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "kernels/reference/flow/observables.hpp"
#include "tests/support/expression_program.hpp"
#include "tests/support/flow_faces.hpp"
#include "tests/support/flow_oracle.hpp"

// Grids whose cells have widths of their own, against the oracle, uniform grids, and what holds on both.

namespace drogue::flow {
namespace {

using namespace drogue::testing;  // NOLINT: helpers of these tests
using reference::GridIndex;

constexpr const auto& backend = testing::tested_backend;
constexpr Sides periodic{BoundaryKind::periodic, BoundaryKind::periodic},
    walls{BoundaryKind::wall, BoundaryKind::slip}, through{BoundaryKind::inflow, BoundaryKind::outflow};

/// As `parameters_of`, with random widths.
Parameters stretched(const std::array<int, 3>& cells, const std::array<Sides, 3>& sides, Advection advection,
                     unsigned seed, double ratio = 3.0) {
  Parameters p = parameters_of(cells, sides, advection);
  set_random_widths(p, ratio, seed);
  return p;
}

// ctest-label: smoke
TEST(FlowStretched, RatesEqualThoseOfTheReference) {
  unsigned seed = 10;
  for (const Advection scheme : schemes)
    for (const std::array<int, 3>& cells :
         {std::array<int, 3>{13, 9, 7}, {67, 4, 4}, {12, 1, 9}, {17, 10, 1}, {1, 8, 6}})
      for (const std::array<Sides, 3>& sides : {std::array<Sides, 3>{periodic, periodic, periodic},
                                                {through, walls, walls},
                                                {walls, through, periodic},
                                                {periodic, walls, through}}) {
        ++seed;
        expect_equal_rates(stretched(cells, sides, scheme, seed), seed);
        if (HasFatalFailure()) return;
      }
}

TEST(FlowStretched, RatesOnOneStretchedAxisEqualThoseOfTheReference) {
  unsigned seed = 200;
  for (const std::size_t axis : {0U, 1U, 2U})
    for (const std::array<Sides, 3>& sides :
         {std::array<Sides, 3>{periodic, periodic, periodic}, {walls, through, walls}}) {
      ++seed;
      Parameters p = stretched({13, 9, 7}, sides, schemes[seed % 3], seed);
      for (const std::size_t other : {0U, 1U, 2U})
        if (other != axis) p.faces[other].clear();
      expect_equal_rates(p, seed);
      if (HasFatalFailure()) return;
    }
}

TEST(FlowStretched, RatesWithEddyViscositiesEqualThoseOfTheReference) {
  unsigned seed = 300;
  for (const Turbulence model : {Turbulence::smagorinsky, Turbulence::vreman})
    for (const std::array<int, 3>& cells : {std::array<int, 3>{13, 9, 7}, {12, 1, 9}, {1, 8, 6}})
      for (const std::array<Sides, 3>& sides :
           {std::array<Sides, 3>{periodic, periodic, periodic}, {through, walls, walls}}) {
        Parameters p = stretched(cells, sides, Advection::central, ++seed);
        p.turbulence = model;
        p.turbulence_constant = 0.6;  // larger than usual, so that its stress matters
        expect_equal_rates(p, seed);
        if (HasFatalFailure()) return;
      }
}

TEST(FlowStretched, StepsEqualTheReferenceForAllPairsOfSidesInTwoDimensions) {
  unsigned seed = 1000;
  for (const Sides& x : all_sides())
    for (const Sides& y : all_sides()) {
      Parameters p = stretched({6, 5, 1}, {x, y, periodic}, schemes[seed % 3], seed);
      time_integrations[seed / 3 % 3].set(p);
      if (p.diffusion == Diffusion::crank_nicolson) p.viscosity = 2.0;
      expect_equal_steps(p, ++seed);
      if (HasFatalFailure()) return;
    }
}

TEST(FlowStretched, StepsEqualTheReferenceForPairsOfSidesInThreeDimensions) {
  const std::vector<Sides> sides = all_sides();
  unsigned seed = 2000;
  for (std::size_t i = 0; i < sides.size(); ++i)
    for (const TimeIntegration& integration : time_integrations) {
      Parameters p = stretched({5, 4, 6}, {sides[i], sides[(i + 5) % 17], sides[(i + 11) % 17]},
                               schemes[seed % 3], seed);
      integration.set(p);
      if (p.diffusion == Diffusion::crank_nicolson) p.viscosity = 2.0;
      if (seed % 2 == 0) p.turbulence = seed % 4 == 0 ? Turbulence::smagorinsky : Turbulence::vreman;
      expect_equal_steps(p, ++seed);
      if (HasFatalFailure()) return;
    }
}

TEST(FlowStretched, ExpressionsOfSidesHaveTrueCoordinates) {
  for (const TimeIntegration& integration : time_integrations)
    for (const Sides& beside : {walls, periodic}) {
      Parameters p = stretched({6, 5, 4}, {through, beside, beside}, Advection::weno_z, 5);
      integration.set(p);
      // Component c is 1 + 40 t y + (c + 1) z.
      for (int c = 0; c < 3; ++c)
        p.boundary[0].velocity_expressions.push_back(
            postfix({40.0, "t", "*", "y", "*", c + 1.0, "z", "*", "+", 1.0, "+"}));
      expect_equal_steps(
          p, 3000, [&](std::size_t side, std::size_t component, const reference::Point& point, double t) {
            if (side != 0) return p.boundary[side].velocity[component];
            return 1.0 + 40.0 * t * point[1] + (static_cast<double>(component) + 1.0) * point[2];
          });
    }
}

/// Boxes whose cells grow by ten percent to twenty times the least width: periodic, and a channel.
std::vector<Parameters> graded_boxes() {
  Parameters box = periodic_box({80, 12, 9}), channel = box;
  for (Parameters* p : {&box, &channel}) {
    set_graded_widths(*p, 0, 8, 1.1, 20.0);
    set_graded_widths(*p, 1, 4, 1.3, 20.0);
    p->viscosity = 1e-3;
  }
  const BoundaryKind kinds[] = {BoundaryKind::inflow, BoundaryKind::outflow, BoundaryKind::slip,
                                BoundaryKind::slip,   BoundaryKind::wall,    BoundaryKind::wall};
  for (std::size_t side = 0; side < 6; ++side) channel.boundary[side].kind = kinds[side];
  channel.boundary[0].velocity = {0.7, 0.0, 0.0};
  return {box, channel};
}

TEST(FlowStretched, StepsLeaveNoDivergence) {
  for (const Advection scheme : schemes)
    for (const TimeIntegration& integration : time_integrations)
      for (Parameters p : graded_boxes()) {
        p.advection = scheme;
        integration.set(p);
        const FlowDomain domain(p);
        const auto solver = started(backend, p, random_field(domain, 5));
        ASSERT_EQ(solver->advance(endless, 5, {}), Stop::pause);
        // Velocities of 1 m/s over cells of 2 mm.
        const double scale = 1.0 / core_of(p).spacing[0];
        EXPECT_LT(largest(reference::divergence(domain, velocity(*solver))), 1e-13 * scale);
      }
}

TEST(FlowStretched, PeriodicBoxesConserveMomentumToRoundOff) {
  for (const Advection scheme : schemes)
    for (const TimeIntegration& integration : time_integrations)
      for (const Turbulence model : {Turbulence::none, Turbulence::vreman}) {
        if (model != Turbulence::none && scheme != Advection::central) continue;
        Parameters p = graded_boxes().front();
        p.advection = scheme;
        p.turbulence = model;
        integration.set(p);
        const auto solver = started(backend, p, random_field(FlowDomain(p), 6));
        const Totals before = solver->totals();
        ASSERT_EQ(solver->advance(endless, 10, {}), Stop::pause);
        const Totals after = solver->totals();
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(after.momentum[c], before.momentum[c], 1e-14) << c;
      }
}

TEST(FlowStretched, KeepUniformFlowBitForBit) {
  for (const Advection scheme : schemes)
    for (const TimeScheme time : {TimeScheme::ab2, TimeScheme::rk3}) {
      Parameters p = graded_boxes().front();
      p.viscosity = 0.1;
      p.advection = scheme;
      p.time_scheme = time;
      const std::array<double, 3> u{0.3, -1.7, 1e-3};
      const auto initial =
          sampled_field(FlowDomain(p), [&](std::size_t c, const reference::Point&) { return u[c]; });
      const auto solver = started(backend, p, initial);
      ASSERT_EQ(solver->advance(endless, 20, {}), Stop::pause);
      EXPECT_EQ(velocity(*solver), initial);
    }
}

TEST(FlowStretched, CentralAdvectionConservesEnergyOfInviscidFlow) {
  Parameters p = periodic_box({12, 11, 10});
  set_random_widths(p, 3.0, 4);
  p.advection = Advection::central;
  p.fixed_dt = 1e-4;
  const auto solver = started(backend, p, random_field(FlowDomain(p), 8));
  const double before = solver->totals().kinetic_energy;
  ASSERT_EQ(solver->advance(endless, 20, {}), Stop::pause);
  EXPECT_NEAR(solver->totals().kinetic_energy, before, 1e-9 * before);
}

TEST(FlowStretched, EqualWidthsAgreeWithAUniformGrid) {
  for (const Advection scheme : schemes)
    for (const TimeIntegration& integration : time_integrations)
      for (const std::array<Sides, 3>& sides :
           {std::array<Sides, 3>{periodic, periodic, periodic}, {through, walls, walls}}) {
        Parameters p = parameters_of({12, 9, 7}, sides, scheme);
        integration.set(p);
        p.fixed_dt = 0.0;
        p.turbulence = Turbulence::smagorinsky;
        const StaggeredField initial = random_field(FlowDomain(p), 12);
        const auto uniform = started(backend, p, initial);
        for (std::size_t axis = 0; axis < 3; ++axis)
          set_widths(p, axis, std::vector<double>(static_cast<std::size_t>(p.cells[axis]), 1.0));
        const auto with_faces = started(backend, p, initial);
        ASSERT_EQ(uniform->advance(endless, 5, {}), Stop::pause);
        ASSERT_EQ(with_faces->advance(endless, 5, {}), Stop::pause);
        EXPECT_LT(largest_difference(velocity(*uniform), velocity(*with_faces)), 1e-11);
        EXPECT_NEAR(uniform->progress().time, with_faces->progress().time, 1e-12);
        EXPECT_NEAR(uniform->totals().enstrophy, with_faces->totals().enstrophy, 1e-9);
      }
}

TEST(FlowStretched, RestartsContinueBitForBit) {
  for (const TimeIntegration& integration : time_integrations) {
    Parameters p = stretched({9, 8, 7}, {through, walls, periodic}, Advection::weno_z, 15);
    integration.set(p);
    p.fixed_dt = 0.0;
    const auto first = started(backend, p, random_field(FlowDomain(p), 16));
    ASSERT_EQ(first->advance(endless, 3, {}), Stop::pause);
    const auto second = create_solver(backend, p);
    copy_state(*first, *second);
    second->restore(first->progress());
    for (Solver* solver : {first.get(), second.get()})
      ASSERT_EQ(solver->advance(endless, 6, {}), Stop::pause);
    EXPECT_EQ(velocity(*first), velocity(*second));
    EXPECT_EQ(first->progress().time, second->progress().time);
  }
}

TEST(FlowStretched, DtIsThatOfTheLeastWidthBesideEachFace) {
  for (const std::array<Sides, 3>& sides :
       {std::array<Sides, 3>{periodic, periodic, periodic}, {through, walls, walls}}) {
    Parameters p = stretched({9, 8, 7}, sides, Advection::weno_z, 17);
    p.viscosity = 0.0;
    p.body_force = {0.0, 0.0, 0.0};
    p.fixed_dt = 0.0;
    const FlowDomain domain(p);
    const auto solver = started(backend, p, random_field(domain, 18));
    const StaggeredField u = velocity(*solver);
    double most = 0.0;
    domain.for_each_cell([&](const GridIndex& cell) {
      double sum = 0.0;
      for (std::size_t c = 0; c < 3; ++c) {
        double speed = std::abs(u[c][domain.at(c, cell)]);
        GridIndex high = cell;
        if (++high[c] == p.cells[c] && domain.is_bounded(c))
          speed = std::max(speed, std::abs(u[c][domain.at(c, high)]));
        sum += speed / std::min(domain.width(c, cell[c]), domain.width(c, cell[c] - 1));
      }
      most = std::max(most, sum);
    });
    EXPECT_NEAR(std::bit_cast<double>(solver->progress().rate_bits), most, 1e-13 * most);
  }
}

TEST(FlowStretched, TotalsAndExtremesEqualThoseOfTheReference) {
  for (const std::array<Sides, 3>& sides :
       {std::array<Sides, 3>{periodic, periodic, periodic}, {through, walls, walls}}) {
    Parameters p = stretched({9, 8, 7}, sides, Advection::weno_z, 19);
    p.watches_extremes = true;
    const FlowDomain domain(p);
    const auto solver = started(backend, p, random_field(domain, 20));
    const Totals totals = solver->totals();
    const StaggeredField u = velocity(*solver);
    const reference::FlowSums sums = reference::flow_sums(domain, u, 0.0);
    const auto near = [](double value, double expected) {
      EXPECT_NEAR(value, expected, 1e-12 * (1.0 + std::abs(expected)));
    };
    near(totals.kinetic_energy, sums.kinetic_energy);
    near(totals.enstrophy, sums.enstrophy);
    near(totals.dissipation, sums.dissipation);
    for (std::size_t c = 0; c < 3; ++c) near(totals.momentum[c], sums.momentum[c]);
    near(totals.max_speed, sums.max_speed);
    for (std::size_t side = 0; side < 6; ++side) near(totals.outflow[side], sums.outflow[side]);
    near(solver->extremes().energy, sums.kinetic_energy);
    near(solver->extremes().largest_speed, sums.max_speed);
    std::vector<double> vorticity(3U * 9U * 8U * 7U);
    solver->sample(CellField::vorticity, vorticity);
    domain.for_each_cell([&](const GridIndex& cell) {
      const auto at = static_cast<std::size_t>((cell[0] * 8 + cell[1]) * 7 + cell[2]);
      const auto gradient = reference::velocity_gradient(domain, u, cell, 0.0);
      for (std::size_t c = 0; c < 3; ++c)
        near(vorticity[3 * at + c], gradient[(c + 2) % 3][(c + 1) % 3] - gradient[(c + 1) % 3][(c + 2) % 3]);
    });
  }
}

TEST(FlowStretched, FastTransformsNeedEqualWidths) {
  Parameters p = graded_boxes().front();
  EXPECT_STREQ(create_solver(backend, p)->pressure_solver(), "diagonalization");
  p.pressure_solver = PressureSolver::fft;
  EXPECT_THROW(check_parameters(p), std::invalid_argument);
}

/// Moves the faces of a uniform grid of an axis by a smooth function: x + a L / (2 pi) sin(2 pi x / L).
void set_smooth_widths(Parameters& p, std::size_t axis, double a) {
  const int n = p.cells[axis];
  const double turn = 2.0 * std::numbers::pi / n;
  std::vector<double> widths;
  for (int i = 0; i < n; ++i) widths.push_back(turn + a * (std::sin((i + 1) * turn) - std::sin(i * turn)));
  set_widths(p, axis, widths);
}

/// Orders between consecutive errors, each with half the step of the one before.
void expect_second_order(const std::vector<double>& errors) {
  for (std::size_t i = 1; i < errors.size(); ++i)
    EXPECT_GE(std::log2(errors[i - 1] / errors[i]), 1.9) << errors[i - 1] << " " << errors[i];
}

TEST(FlowStretched, IsOfSecondOrderInSpaceForDriftingVortices) {
  constexpr double nu = 0.02, end = 0.5;
  for (const TimeIntegration& integration : time_integrations)
    for (const Advection scheme : schemes) {
      if (integration.time == TimeScheme::ab2 && scheme != Advection::weno_z) continue;
      std::vector<double> errors;
      for (const int n : {24, 48, 96}) {
        Parameters p = periodic_box({n, n, 1});
        p.high = {2.0 * std::numbers::pi, 2.0 * std::numbers::pi, 1.0};
        p.viscosity = nu;
        p.advection = scheme;
        integration.set(p);
        p.cfl = 0.3;
        for (const std::size_t axis : {0U, 1U}) set_smooth_widths(p, axis, 0.3);
        const FlowDomain domain(p);
        const auto exact = [&](double time) {
          return sampled_field(domain, [&](std::size_t c, const reference::Point& at) {
            const double x = at[0] - 0.8 * time, y = at[1] + 0.5 * time, decay = std::exp(-2.0 * nu * time);
            return c == 0   ? 0.8 + decay * std::sin(x) * std::cos(y)
                   : c == 1 ? -0.5 - decay * std::cos(x) * std::sin(y)
                            : 0.0;
          });
        };
        const auto solver = started(backend, p, exact(0.0));
        ASSERT_EQ(solver->advance(end, -1, {}), Stop::target);
        errors.push_back(rms_difference(velocity(*solver), exact(end)));
      }
      expect_second_order(errors);
      EXPECT_LT(errors.back(), 5e-4);
    }
}

TEST(FlowStretched, PoiseuilleFlowIsOfSecondOrderInSpace) {
  for (const TimeIntegration& integration : time_integrations) {
    std::vector<double> errors;
    for (const int n : {12, 24, 48}) {
      Parameters p = periodic_box({4, n, 1});
      p.viscosity = 0.1;
      p.pressure_drop = {0.4, 0.0, 0.0};
      p.boundary[2].kind = p.boundary[3].kind = BoundaryKind::wall;
      integration.set(p);
      set_smooth_widths(p, 1, -0.5);  // finest beside the walls
      const FlowDomain domain(p);
      const auto exact = sampled_field(domain, [](std::size_t c, const reference::Point& at) {
        return c == 0 ? 0.4 / (2.0 * 0.1) * at[1] * (1.0 - at[1]) : 0.0;
      });
      const auto solver = started(backend, p, exact);
      ASSERT_EQ(solver->advance(4.0, -1, {}), Stop::target);
      errors.push_back(rms_difference(velocity(*solver), exact));
    }
    expect_second_order(errors);
  }
}

}  // namespace
}  // namespace drogue::flow
