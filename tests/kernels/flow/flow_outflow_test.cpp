// ctest-label: no-sanitizer
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/support/flow_case.hpp"

// Outflows: no shear stress, fluid that enters, energy and symmetry.

namespace drogue::flow {
namespace {

using namespace drogue::testing;  // NOLINT: helpers of these tests
using reference::GridIndex;

constexpr const auto& backend = testing::tested_backend;
constexpr Advection schemes[] = {Advection::central, Advection::weno_js, Advection::weno_z};

void set_outflows(Parameters& p, const std::vector<std::size_t>& sides) {
  for (const std::size_t side : sides) p.boundary[side].kind = BoundaryKind::outflow;
}

/// Largest difference of the velocity along x to 1 m/s after a disturbance of 1e-6 m/s of a stream along
/// outflows.
double deviation_of_stream(Parameters p, double end) {
  const double pi = std::acos(-1.0);
  const auto solver =
      started(backend, p, sampled_field(FlowDomain(p), [&](std::size_t c, const reference::Point& at) {
                const double x = 2.0 * pi * at[0], y = 2.0 * pi * at[1];
                return c == 0   ? 1.0 + 1e-6 * std::cos(x) * std::sin(y)
                       : c == 1 ? -1e-6 * std::sin(x) * std::cos(y)
                                : 0.0;
              }));
  EXPECT_EQ(solver->advance(end, -1, {}), Stop::target);
  std::vector<double> u = download(*solver, "velocity_x");
  for (double& value : u) value -= 1.0;
  return largest(u);
}

TEST(FlowOutflow, HasNoShearStressWhereFluidEntersSlowly) {
  for (const TimeIntegration& integration : time_integrations) {
    Parameters p = periodic_box({16, 16, 1});
    p.viscosity = 0.01;
    p.max_dt = 0.02;
    integration.set(p);
    set_outflows(p, {2U, 3U});
    // Fluid outside at rest brings a deficit of at most the speed of 1e-6 m/s times a time of half a second,
    // in which the disturbance decays, over the width of a cell.
    EXPECT_LT(deviation_of_stream(p, 1.0), 1e-5);
    for (const std::size_t side : {2U, 3U}) p.boundary[side].velocity = {1.0, 0.0, 0.0};
    EXPECT_LT(deviation_of_stream(p, 1.0), 1e-6);
    EXPECT_LT(deviation_of_stream(p, 20.0), 1e-6);
  }
}

TEST(FlowOutflow, EnteringFluidIsOfTheOrderOfTheSchemeInTime) {
  // A body force f draws fluid in through an outflow and out through another one: du/dt = f - u^2 / (2 L).
  constexpr double f = 0.5, length = 2.0, end = 6.0;
  const double exact = std::sqrt(2.0 * f * length) * std::tanh(end * std::sqrt(f / (2.0 * length)));
  EXPECT_NEAR(exact, 1.374146, 1e-6);
  for (const TimeIntegration& integration : time_integrations)
    for (const double nu : {0.0, 0.02})
      for (const bool reversed : {false, true}) {
        Parameters p = periodic_box({16, 4, 1});
        p.high[0] = length;
        p.body_force[0] = reversed ? -f : f;
        p.viscosity = nu;
        integration.set(p);
        set_outflows(p, {0U, 1U});
        const FlowDomain domain(p);
        std::vector<double> errors;
        for (const double dt : {0.04, 0.02, 0.01}) {
          p.fixed_dt = dt;
          const auto solver = started(backend, p, domain.zero_field());
          ASSERT_EQ(solver->advance(end, -1, {}), Stop::target);
          std::vector<double> u = download(*solver, "velocity_x");
          for (double& value : u) value = std::abs(value) - exact;
          errors.push_back(largest(u));
        }
        const double order = p.time_scheme == TimeScheme::rk3 ? 2.9 : 1.9;
        EXPECT_LT(errors.back(), 2e-5);
        for (std::size_t i = 1; i < errors.size(); ++i)
          EXPECT_GE(std::log2(errors[i - 1] / errors[i]), order) << errors[i - 1] << " " << errors[i];
      }
}

TEST(FlowOutflow, RandomFlowsNeverGainEnergy) {
  for (const TimeIntegration& integration : time_integrations)
    for (const Advection scheme : schemes)
      for (const std::array<double, 3>& size :
           {std::array<double, 3>{1.0, 1.0, 1.0}, {50.0, 1.0, 1.0}, {1.0, 1.0, 8.0}})
        for (unsigned seed = 1; seed <= 8; ++seed) {
          const bool plane = seed % 2 == 0;
          Parameters p = periodic_box(plane ? std::array<int, 3>{12, 1, 10} : std::array<int, 3>{8, 7, 6});
          p.high = size;
          p.viscosity = seed % 4 < 2 ? 1e-3 : 1e-2;
          p.advection = scheme;
          p.max_dt = 0.05;
          integration.set(p);
          set_outflows(p, {0U, 1U, 2U, 3U, 4U, 5U});
          if (plane) p.boundary[2].kind = p.boundary[3].kind = BoundaryKind::periodic;
          const auto solver = started(backend, p, random_field(FlowDomain(p), seed));
          double before = solver->totals().kinetic_energy;
          for (int step = 1; step <= 100; ++step) {
            ASSERT_EQ(solver->advance(endless, step, {}), Stop::pause);
            const double energy = solver->totals().kinetic_energy;
            EXPECT_LE(energy, (1.0 + 1e-12) * before)
                << "step " << step << " seed " << seed << " advection " << static_cast<int>(scheme)
                << " diffusion " << static_cast<int>(p.diffusion) << " time "
                << static_cast<int>(p.time_scheme) << " size " << size[0] << " " << size[2];
            if (energy > before) break;
            before = energy;
          }
        }
}

TEST(FlowOutflow, VorticesThatLeaveKeepTheirMirrorSymmetry) {
  for (const TimeIntegration& integration : time_integrations) {
    Parameters p = periodic_box({32, 24, 1});
    p.low = {0.0, -1.5, 0.0};
    p.high = {4.0, 1.5, 1.0};
    p.viscosity = 1e-3;
    integration.set(p);
    set_outflows(p, {1U, 2U, 3U});
    p.boundary[0].kind = BoundaryKind::inflow;
    p.boundary[0].velocity = {0.2, 0.0, 0.0};
    const FlowDomain domain(p);
    // Stream function of two vortices that turn against one another.
    const auto stream = [](double x, double y) {
      const auto vortex = [&](double centre) {
        return std::exp(-((x - 3.0) * (x - 3.0) + (y - centre) * (y - centre)) / 0.1);
      };
      return 0.4 * (vortex(0.5) - vortex(-0.5));
    };
    const auto pair = sampled_field(domain, [&](std::size_t c, const reference::Point& at) {
      constexpr double d = 1e-5;
      if (c == 0) return 0.2 + (stream(at[0], at[1] + d) - stream(at[0], at[1] - d)) / (2.0 * d);
      return c == 1 ? -(stream(at[0] + d, at[1]) - stream(at[0] - d, at[1])) / (2.0 * d) : 0.0;
    });
    const auto solver = started(backend, p, pair);
    ASSERT_EQ(solver->advance(3.0, -1, {}), Stop::target);
    const StaggeredField u = velocity(*solver);
    double asymmetry = 0.0;
    domain.for_each_face([&](std::size_t c, const GridIndex& face) {
      GridIndex mirror = face;
      mirror[1] = p.cells[1] - face[1] - (c == 1 ? 0 : 1);
      const double image = u[c][domain.at(c, mirror)] * (c == 1 ? -1.0 : 1.0);
      asymmetry = std::max(asymmetry, std::abs(u[c][domain.at(c, face)] - image));
    });
    EXPECT_LT(asymmetry, 1e-11);
  }
}

TEST(FlowOutflow, StillAirStaysAtRestInMovingFrames) {
  // The stream that an observer sees who moves through fluid at rest enters and leaves through outflows.
  for (const TimeIntegration& integration : time_integrations)
    for (const double speed : {0.7, -0.7}) {
      Parameters p = periodic_box({9, 8, 7});
      p.viscosity = 1e-2;
      integration.set(p);
      set_outflows(p, {0U, 1U, 4U, 5U});
      for (Boundary& side : p.boundary) side.velocity = {speed, 0.0, 0.5 * speed};
      const auto stream = sampled_field(
          FlowDomain(p), [&](std::size_t c, const reference::Point&) { return p.boundary[0].velocity[c]; });
      const auto solver = started(backend, p, stream);
      ASSERT_EQ(solver->advance(endless, 50, {}), Stop::pause);
      EXPECT_LT(largest_difference(velocity(*solver), stream), 1e-13);
      // A disturbance decays.
      StaggeredField disturbed = random_field(FlowDomain(p), 3);
      for (std::size_t c = 0; c < 3; ++c)
        for (double& value : disturbed[c]) value = 0.3 * value + p.boundary[0].velocity[c];
      const auto restless = started(backend, p, disturbed);
      const double before = rms_difference(velocity(*restless), stream);
      ASSERT_EQ(restless->advance(20.0, -1, {}), Stop::target);
      EXPECT_LT(rms_difference(velocity(*restless), stream), 0.05 * before);
    }
}

}  // namespace
}  // namespace drogue::flow
