#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/support/flow_case.hpp"

// Results do not depend on the order of the axes, nor on the units.

namespace drogue::flow {
namespace {

using namespace drogue::testing;  // NOLINT: helpers of these tests
using reference::GridIndex;

constexpr const auto& backend = testing::tested_backend;

/// Order of axes: axis a of the permuted flow is axis `order[a]` of the first one.
using Order = std::array<std::size_t, 3>;

Parameters permuted(const Parameters& p, const Order& order) {
  Parameters result = p;
  for (std::size_t a = 0; a < 3; ++a) {
    result.cells[a] = p.cells[order[a]];
    result.low[a] = p.low[order[a]];
    result.high[a] = p.high[order[a]];
    for (const std::size_t end : {0U, 1U}) {
      const Boundary& side = p.boundary[2 * order[a] + end];
      result.boundary[2 * a + end].kind = side.kind;
      for (std::size_t c = 0; c < 3; ++c) result.boundary[2 * a + end].velocity[c] = side.velocity[order[c]];
    }
  }
  return result;
}

StaggeredField permuted(const Parameters& p, const StaggeredField& u, const Order& order) {
  const FlowDomain domain(p), other(permuted(p, order));
  StaggeredField result = other.zero_field();
  other.for_each_face([&](std::size_t c, const GridIndex& face) {
    GridIndex original{};
    for (std::size_t a = 0; a < 3; ++a) original[order[a]] = face[a];
    result[c][other.at(c, face)] = u[order[c]][domain.at(order[c], original)];
  });
  return result;
}

std::vector<double> sampled(Solver& solver, const Parameters& p, CellField field) {
  const int components = field == CellField::vorticity ? 3 : 1;
  std::vector<double> values(static_cast<std::size_t>(p.cells[0] * p.cells[1] * p.cells[2] * components));
  solver.sample(field, values);
  return values;
}

/// Expects velocity, vorticity and sums of a flow to be permuted with its axes after three steps.
void expect_equal_in_all_orders(const Parameters& p) {
  const StaggeredField initial = random_field(FlowDomain(p), 31);
  const auto solver = started(backend, p, initial);
  ASSERT_EQ(solver->advance(endless, 3, {}), Stop::pause);
  const StaggeredField u = velocity(*solver);
  const std::vector<double> vorticity = sampled(*solver, p, CellField::vorticity),
                            q = sampled(*solver, p, CellField::q_criterion);
  const Totals totals = solver->totals();
  for (const Order& order : {Order{1, 2, 0}, {2, 0, 1}, {1, 0, 2}, {0, 2, 1}, {2, 1, 0}}) {
    const Parameters other = permuted(p, order);
    const auto turned = started(backend, other, permuted(p, initial, order));
    ASSERT_EQ(turned->advance(endless, 3, {}), Stop::pause);
    EXPECT_LT(largest_difference(velocity(*turned), permuted(p, u, order)), 1e-11);
    EXPECT_NEAR(turned->totals().enstrophy, totals.enstrophy, 1e-11 * totals.enstrophy);
    EXPECT_NEAR(turned->totals().dissipation, totals.dissipation, 1e-11 * totals.dissipation);
    // Vorticity is a pseudovector: a reflection changes its sign.
    const bool reflects = order[1] != (order[0] + 1) % 3;
    const std::vector<double> w = sampled(*turned, other, CellField::vorticity),
                              q_turned = sampled(*turned, other, CellField::q_criterion);
    double difference = 0.0;
    std::size_t cell = 0;
    for (int i = 0; i < other.cells[0]; ++i)
      for (int j = 0; j < other.cells[1]; ++j)
        for (int k = 0; k < other.cells[2]; ++k, ++cell) {
          const GridIndex index{i, j, k};
          GridIndex at{};
          for (std::size_t a = 0; a < 3; ++a) at[order[a]] = index[a];
          const auto place = static_cast<std::size_t>((at[0] * p.cells[1] + at[1]) * p.cells[2] + at[2]);
          difference = std::max(difference, std::abs(q_turned[cell] - q[place]));
          for (std::size_t c = 0; c < 3; ++c)
            difference = std::max(difference, std::abs(w[3 * cell + c] * (reflects ? -1.0 : 1.0) -
                                                       vorticity[3 * place + order[c]]));
        }
    EXPECT_LT(difference, 1e-9);
  }
}

TEST(FlowSymmetry, EdgesBetweenSidesDoNotDependOnTheOrderOfTheAxes) {
  constexpr BoundaryKind kinds[] = {BoundaryKind::wall, BoundaryKind::inflow, BoundaryKind::outflow,
                                    BoundaryKind::slip, BoundaryKind::wall,   BoundaryKind::outflow};
  for (const Turbulence model : {Turbulence::none, Turbulence::smagorinsky, Turbulence::vreman})
    for (std::size_t shift = 0; shift < 6; ++shift)
      for (const TimeIntegration& integration : time_integrations) {
        Parameters p;
        p.cells = {7, 6, 5};
        p.high = {1.0, 1.2, 0.9};
        p.viscosity = 0.01;
        p.fixed_dt = 0.005;
        p.turbulence = model;
        integration.set(p);
        for (std::size_t side = 0; side < 6; ++side) {
          Boundary& boundary = p.boundary[side];
          boundary.kind = kinds[(side + shift) % 6];
          boundary.velocity = {0.5, -0.4, 0.3};
          if (boundary.kind == BoundaryKind::wall) boundary.velocity[side / 2] = 0.0;
        }
        expect_equal_in_all_orders(p);
        if (HasFailure()) return;
      }
}

TEST(FlowSymmetry, LidsKeepTheirVelocityInCorners) {
  // The mean vorticity of the cell at rest in the corner: (0 - V) h along the lid, over the area, to half of
  // which the fluid in the cell contributes nothing.
  for (const std::size_t axis : {0U, 1U}) {
    Parameters p = periodic_box({8, 8, 1});
    for (const std::size_t side : {0U, 1U, 2U, 3U}) p.boundary[side].kind = BoundaryKind::wall;
    p.boundary[2 * axis + 1].velocity[1 - axis] = 1.0;
    const auto solver = started(backend, p, FlowDomain(p).zero_field());
    const std::vector<double> w = sampled(*solver, p, CellField::vorticity);
    const std::size_t cell = axis == 1 ? 7 : 56;  // at the low end of the lid
    EXPECT_DOUBLE_EQ(w[3 * cell + 2], axis == 1 ? -8.0 : 8.0);
  }
}

TEST(FlowSymmetry, PowersOfTwoInTheUnitsChangeNoBit) {
  // Velocities differ in part of the domain, there by little more than round-off.
  const auto flow = [](const FlowDomain& domain, double unit) {
    return sampled_field(domain, [&](std::size_t c, const reference::Point& at) {
      const double x = at[0] / domain.parameters().high[0];
      const double disturbance = x < 0.4 ? 0.0 : 1e-14 * std::sin(40.0 * x + 10.0 * static_cast<double>(c));
      return unit * (0.5 + 0.1 * static_cast<double>(c) + disturbance);
    });
  };
  for (const Advection scheme : {Advection::weno_js, Advection::weno_z})
    for (const double unit : {0x1p-40, 0x1p40})
      for (const TimeScheme time : {TimeScheme::ab2, TimeScheme::rk3}) {
        Parameters p = periodic_box({20, 7, 1});
        p.advection = scheme;
        p.time_scheme = time;
        p.viscosity = 1e-3;
        p.fixed_dt = 0.01;
        Parameters scaled = p;  // by the unit of length
        for (double& high : scaled.high) high *= unit;
        scaled.viscosity *= unit * unit;
        const auto solver = started(backend, p, flow(FlowDomain(p), 1.0)),
                   other = started(backend, scaled, flow(FlowDomain(scaled), unit));
        ASSERT_EQ(solver->advance(endless, 5, {}), Stop::pause);
        ASSERT_EQ(other->advance(endless, 5, {}), Stop::pause);
        const StaggeredField u = velocity(*solver);
        StaggeredField v = velocity(*other);
        for (std::vector<double>& component : v)
          for (double& value : component) value /= unit;
        EXPECT_EQ(v, u) << static_cast<int>(scheme) << " " << unit;
      }
}

}  // namespace
}  // namespace drogue::flow
