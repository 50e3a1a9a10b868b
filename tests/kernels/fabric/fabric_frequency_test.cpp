// ctest-label: no-sanitizer
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "kernels/fabric/elastic/lumped_mass.hpp"
#include "kernels/fabric/solver.hpp"
#include "kernels/reference/fabric/frequency.hpp"
#include "tests/support/backend.hpp"
#include "tests/support/fabric_mesh.hpp"

// Bounds of the largest angular frequency against the reference, and against the stability of steps.

namespace drogue::fabric {
namespace {

using testing::random_patch;
using testing::shaken;

constexpr const auto& backend = testing::tested_backend;

Parameters fabric(Model model, double line_density = 0.3) {
  Parameters p;
  p.mesh = random_patch(8, 7, 3);
  p.material.model = model;
  p.material.axial_stiffness = 400.0;
  p.mass = lumped_masses(p.mesh, 0.5, line_density, Lumping::area);
  p.dt = 1e-4;
  return p;
}

double bound_of(const Parameters& p, const std::vector<Vector>& now) {
  const auto solver = create_solver(backend, p);
  solver->upload(now, std::vector<Vector>(now.size(), Vector{}));
  return solver->fastest_frequency();
}

/// Lower bound of the largest angular frequency, rad/s.
double found_of(const Parameters& p, const std::vector<Vector>& now) {
  const auto solver = create_solver(backend, p);
  solver->upload(now, std::vector<Vector>(now.size(), Vector{}));
  return solver->frequency_at_least();
}

double truth_of(const Parameters& p, const std::vector<Vector>& now) {
  return reference::largest_frequency(p.material, p.mesh, p.mass, p.pinned, now);
}

std::vector<Vector> stretched(std::vector<Vector> points, double x, double y) {
  for (Vector& p : points) p[0] *= x, p[1] *= y;
  return points;
}

void expect_tight(const Parameters& p, const std::vector<Vector>& now, const char* what) {
  const double truth = truth_of(p, now), bound = bound_of(p, now), found = found_of(p, now);
  EXPECT_GE(found, truth * (1.0 - 1e-3)) << what << ", model " << static_cast<int>(p.material.model);
  EXPECT_LE(found, bound * (1.0 + 1e-6)) << what << ", model " << static_cast<int>(p.material.model);
  EXPECT_GE(bound, truth * (1.0 - 1e-6)) << what << ", model " << static_cast<int>(p.material.model);
  EXPECT_LE(bound, 2.0 * truth) << what << ", model " << static_cast<int>(p.material.model);
  ::testing::Test::RecordProperty(
      std::string(what) + ", " + std::to_string(static_cast<int>(p.material.model)),
      std::to_string(bound / truth));
}

TEST(FabricFrequency, EnclosesTheReferenceWithinAFactorOfTwo) {
  for (const Model model : {Model::edge, Model::quadratic, Model::biquadratic, Model::linear_vector}) {
    Parameters p = fabric(model);
    expect_tight(p, p.mesh.rest, "at rest");
    expect_tight(p, shaken(p.mesh.rest, 0.2, 5), "shaken");
    expect_tight(p, stretched(p.mesh.rest, 1.3, 1.2), "stretched");
    p.mass[11] += 4.0, p.mass.back() += 0.5;
    expect_tight(p, p.mesh.rest, "payloads");
    p.pinned.assign(p.mass.size(), 0);
    for (std::size_t i = 0; i < 8; ++i) p.pinned[i] = 7;
    p.pinned[20] = 3;
    expect_tight(p, shaken(p.mesh.rest, 0.1, 5), "pinned");
    p.mass.assign(p.mass.size(), 0.4);
    expect_tight(p, p.mesh.rest, "equal masses");
    p.mesh.triangles.clear();
    expect_tight(p, shaken(p.mesh.rest, 0.1, 6), "strings");
  }
}

TEST(FabricFrequency, IncludesLightLineEnds) {
  Parameters p = fabric(Model::biquadratic);
  const double before = bound_of(p, p.mesh.rest);
  p.mass.back() = 1e-4;
  expect_tight(p, p.mesh.rest, "light end");
  EXPECT_GT(bound_of(p, p.mesh.rest), 5.0 * before);
}

TEST(FabricFrequency, MatchesTheClosedFormOfAChain) {
  Parameters p;
  for (int i = 0; i <= 40; ++i) p.mesh.rest.push_back({0.1 * i, 0.0, 0.0});
  for (int i = 0; i < 40; ++i) p.mesh.lines.push_back({i, i + 1});
  p.material.axial_stiffness = 50.0;
  p.mass.assign(41, 0.02);
  p.dt = 1e-4;
  // omega = 2 sqrt(k / m) for an infinite chain. Bounds of block norms may exceed the norms by 1.8 %, and so
  // omega by 0.9 %.
  const double exact = 2.0 * std::sqrt(500.0 / 0.02);
  EXPECT_GE(bound_of(p, p.mesh.rest), exact * (1.0 - 1e-12));
  EXPECT_LE(bound_of(p, p.mesh.rest), 1.01 * exact);
  // Highest mode of 41 masses with free ends.
  EXPECT_NEAR(found_of(p, p.mesh.rest), exact * std::sin(std::numbers::pi * 40.0 / 82.0), 1e-5 * exact);
}

TEST(FabricFrequency, VanishesForFullyPinnedFabric) {
  Parameters p = fabric(Model::biquadratic);
  p.pinned.assign(p.mass.size(), 7);
  EXPECT_EQ(bound_of(p, p.mesh.rest), 0.0);
  EXPECT_EQ(found_of(p, p.mesh.rest), 0.0);
}

TEST(FabricFrequency, IncludesTransverseStiffnessOfTension) {
  // A mass between two fixed ends that moves only transversely: omega^2 = 2 T / (l m).
  Parameters p;
  p.mesh.rest = {{-1, 0, 0}, {0, 0, 0}, {1, 0, 0}};
  p.mesh.lines = {{0, 1}, {1, 2}};
  p.material.axial_stiffness = 30.0;
  p.mass = {1, 0.1, 1};
  p.pinned = {7, 3, 7};
  p.dt = 1e-4;
  EXPECT_EQ(bound_of(p, p.mesh.rest), 0.0);
  const double stretch = 1.25, tension = 30.0 * 0.25;
  EXPECT_NEAR(bound_of(p, stretched(p.mesh.rest, stretch, 1.0)), std::sqrt(2.0 * tension / (stretch * 0.1)),
              1e-9);
}

TEST(FabricFrequency, IncludesSpringsOfZeroLength) {
  // Two masses at one point, joined by a spring of 25 N/m: omega = 5 rad/s.
  Parameters p;
  p.mesh.rest = {{0, 0, 0}, {2, 0, 0}};
  p.mesh.lines = {{0, 1}};
  p.material.axial_stiffness = 50.0;
  p.mass = {2, 2};
  p.dt = 1e-4;
  const std::vector<Vector> one_place(2, Vector{1, 1, 0});
  EXPECT_NEAR(bound_of(p, one_place), 5.0, 0.1);
  p.material.tension_only = true;
  EXPECT_NEAR(bound_of(p, one_place), 5.0, 0.1);
  for (const Model model : {Model::edge, Model::quadratic, Model::biquadratic}) {
    const Parameters folded = fabric(model);
    const std::vector<Vector> nowhere(folded.mass.size(), Vector{});
    EXPECT_GT(bound_of(folded, nowhere), 0.3 * bound_of(folded, folded.mesh.rest)) << static_cast<int>(model);
  }
}

/// Largest displacement after 4000 steps of `dt`, s, over the initial one; infinite if the state failed.
double growth(Parameters p, double dt) {
  p.dt = dt;
  const double size = 1e-7;
  const std::vector<Vector> start = shaken(p.mesh.rest, size, 8);
  std::vector<Vector> x = start, v(start.size(), Vector{});
  const auto solver = create_solver(backend, p);
  solver->upload(x, v);
  if (!solver->enqueue_steps(4000) || solver->failure()) return INFINITY;
  solver->download(x, v);
  double most = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis)
      most = std::max(most, std::abs(x[i][axis] - p.mesh.rest[i][axis]));
  return most / size;
}

TEST(FabricFrequency, StepsAreStableAtTheBoundAndUnstableBeyondTheReference) {
  for (const Model model : {Model::edge, Model::quadratic, Model::biquadratic})
    for (const Integrator integrator : {Integrator::rk4, Integrator::verlet, Integrator::symplectic_euler}) {
      Parameters p = fabric(model);
      p.integrator = integrator;
      const double limit = stability_limit(integrator);
      EXPECT_LT(growth(p, limit / bound_of(p, p.mesh.rest)), 10.0) << static_cast<int>(model);
      const double truth = truth_of(p, p.mesh.rest);
      EXPECT_LT(growth(p, 0.98 * limit / truth), 50.0) << static_cast<int>(model);
      EXPECT_GT(growth(p, 1.02 * limit / truth), 1e4) << static_cast<int>(model);
    }
}

TEST(FabricFrequency, PredictsUnstableSteps) {
  for (const Integrator integrator : {Integrator::rk4, Integrator::verlet, Integrator::symplectic_euler})
    for (const auto& [absolute, relative] : {std::pair{0.0, 0.0}, {30.0, 0.0}, {0.0, 2.0}, {30.0, 2.0}}) {
      Parameters p = fabric(Model::biquadratic);
      p.integrator = integrator;
      p.damping = absolute, p.relative_damping = relative;
      const auto solver = create_solver(backend, p);
      solver->upload(p.mesh.rest, std::vector<Vector>(p.mass.size(), Vector{}));
      const double frequency = solver->frequency_at_least(), decay = solver->fastest_decay();
      const double stable = stable_dt(integrator, solver->fastest_frequency(), decay);
      EXPECT_FALSE(grows(integrator, stable, frequency, absolute, decay));
      double dt = stable;
      while (dt < 4.0 * stable && !grows(integrator, dt, frequency, absolute, decay)) dt *= 1.002;
      EXPECT_LT(dt, 3.0 * stable) << absolute << ' ' << relative;
      EXPECT_GT(growth(p, 1.01 * dt), 1e4) << absolute << ' ' << relative;
    }
  // Undamped oscillation: the limits are 2 sqrt(2) and 2.
  EXPECT_FALSE(grows(Integrator::symplectic_euler, 2.0, 1.0, 0.0, 0.0));
  EXPECT_TRUE(grows(Integrator::symplectic_euler, 2.0001, 1.0, 0.0, 0.0));
  EXPECT_FALSE(grows(Integrator::rk4, 2.8284, 1.0, 0.0, 0.0));
  EXPECT_TRUE(grows(Integrator::rk4, 2.8285, 1.0, 0.0, 0.0));
  EXPECT_FALSE(grows(Integrator::verlet, 2.0, 1.0, 0.0, 0.0));
  EXPECT_TRUE(grows(Integrator::verlet, 2.0001, 1.0, 0.0, 0.0));
}

TEST(FabricFrequency, GrowsWithStrain) {
  const Parameters p = fabric(Model::biquadratic);
  const double at_rest = bound_of(p, p.mesh.rest), drawn = bound_of(p, stretched(p.mesh.rest, 1.5, 1.5));
  EXPECT_GT(drawn, 1.5 * at_rest);
  Parameters from_drawn = p;
  from_drawn.dt = 1e-3;
  const auto solver = create_solver(backend, from_drawn);
  const std::vector<Vector> now = stretched(p.mesh.rest, 1.5, 1.5);
  solver->upload(now, std::vector<Vector>(now.size(), Vector{}));
  solver->set_dt(stability_limit(Integrator::rk4) / drawn);
  EXPECT_TRUE(solver->enqueue_steps(1000));
  EXPECT_FALSE(solver->failure());
}

}  // namespace
}  // namespace drogue::fabric
