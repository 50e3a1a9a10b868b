#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kernels/fabric/solver.hpp"
#include "kernels/reference/fabric/bodies.hpp"
#include "kernels/reference/fabric/intersections.hpp"
#include "tests/support/backend.hpp"
#include "tests/support/expression_program.hpp"
#include "tests/support/fabric_sheets.hpp"

// Contact of fabric with itself and with bodies: crossings by the exact reference, conservation, friction.

namespace drogue::fabric {
namespace {

using namespace testing;

constexpr const auto& backend = testing::tested_backend;

struct ContactRun {
  std::size_t crossings = 0;
  double momentum = 0.0, angular_momentum = 0.0, imbalance = 0.0;  ///< largest deviations from the start
  double start_kinetic = 0.0, work = 0.0;
  double start_energy = 0.0, largest_energy = 0.0, last_energy = 0.0;
  std::optional<StepFailure> failure;
};

/// Takes `steps` steps. After every `every` steps, counts the intersections by the exact reference.
ContactRun run_with_contact(Sheets& s, int steps, int every) {
  const auto solver = create_solver(backend, s.p);
  solver->upload(s.x, s.v);
  const Totals start = solver->totals();
  ContactRun run;
  run.start_kinetic = start.kinetic;
  run.start_energy = start.energy();
  for (int step = 0; step < steps; step += every) {
    solver->enqueue_steps(every);
    run.failure = solver->failure();
    if (run.failure) break;
    solver->download(s.x, s.v);
    run.crossings += reference::intersections(s.x, s.p.mesh.triangles, s.p.mesh.lines).size();
    const Totals now = solver->totals();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      run.momentum = std::max(run.momentum, std::abs(now.momentum[axis] - start.momentum[axis]));
      run.angular_momentum =
          std::max(run.angular_momentum, std::abs(now.angular_momentum[axis] - start.angular_momentum[axis]));
    }
    run.imbalance =
        std::max(run.imbalance, std::abs(now.energy() - now.contact - now.friction - start.energy()));
    run.work = now.contact + now.friction;
    run.last_energy = now.energy();
    run.largest_energy = std::max(run.largest_energy, run.last_energy);
  }
  return run;
}

/// Expects no crossing, conservation of both momenta to round-off, and an energy balance with the contact
/// work to `energy_tolerance` times the initial kinetic energy.
void expect_conservation(const char* name, Sheets s, int steps, double energy_tolerance) {
  const ContactRun o = run_with_contact(s, steps, 5);
  EXPECT_FALSE(o.failure) << name;
  EXPECT_EQ(o.crossings, 0U) << name;
  double impulse = 0.0;
  for (std::size_t i = 0; i < s.v.size(); ++i) impulse += s.p.mass[i] * std::sqrt(2.0 * o.start_kinetic);
  EXPECT_LT(o.momentum, 1e-13 * impulse) << name;
  EXPECT_LT(o.angular_momentum, 1e-13 * impulse) << name;
  EXPECT_LT(o.imbalance, energy_tolerance * o.start_kinetic) << name;
  EXPECT_LT(o.work, -0.01 * o.start_kinetic)
      << name << ": no energy lost in contact, so the sheets never touched";
}

TEST(FabricContact, PreventsCrossingsAndConservesMomentum) {
  expect_conservation("impact", impact(3.0), 300, 5e-3);
  expect_conservation("edge on", edge_on(3.0), 300, 2e-2);
  expect_conservation("corners", corner_on(3.0), 300, 5e-2);
  expect_conservation("fold", folded(3.0), 300, 5e-2);
}

TEST(FabricContact, PreventsCrossingsInIntervalsOfSeveralSteps) {
  // Cloth without compressive stress, as that of canopies.
  const auto expect_no_crossing = [](const char* name, const Sheets& start) {
    for (const int steps : {2, 10}) {
      Sheets s = start;
      s.p.integrator = Integrator::symplectic_euler;
      s.p.material.tension_only = true;
      s.p.contact.interval = steps;
      s.p.contact.block = steps == 2 ? 64 : 0;
      const ContactRun o = run_with_contact(s, 300, 50);
      EXPECT_FALSE(o.failure) << name << ", intervals of " << steps;
      EXPECT_EQ(o.crossings, 0U) << name << ", intervals of " << steps;
      double impulse = 0.0;
      for (const double mass : s.p.mass) impulse += mass * std::sqrt(2.0 * o.start_kinetic);
      EXPECT_LT(o.momentum, 1e-12 * impulse) << name << ", intervals of " << steps;
      EXPECT_LT(o.largest_energy, 1.01 * o.start_energy) << name << ", intervals of " << steps;
      EXPECT_LT(o.last_energy, 0.9 * o.start_energy) << name << ": they never touched";
    }
  };
  expect_no_crossing("impact", impact(3.0));
  expect_no_crossing("edge on", edge_on(3.0));
  expect_no_crossing("fold", folded(3.0));
}

/// A sheet below a line of twice its width, which falls on it: the hash grid holds no lines that long.
Sheets below_a_long_line() {
  Sheets s;
  s.add(10, 0.1, level(0.0, 0.0, 0.0), {0.0, 0.0, 0.0});
  const int first = static_cast<int>(s.x.size());
  for (const double along : {-0.05, 0.15}) {
    s.p.mesh.rest.push_back({along, 0.047, 5.0});
    s.x.push_back({along, 0.047, 0.01 + 0.1 * along});
    s.v.push_back({0.0, 0.0, -3.0});
    s.p.mass.push_back(0.01);
  }
  s.p.mesh.lines.push_back({first, first + 1});
  s.p.material.axial_stiffness = 500.0;
  s.p.material.tension_only = true;
  s.p.integrator = Integrator::symplectic_euler;
  s.p.contact.friction = 0.0;
  return s;
}

TEST(FabricContact, LongLinesDoNotCrossCloth) {
  for (const int interval : {1, 10}) {
    Sheets s = below_a_long_line();
    s.p.contact.interval = interval;
    const ContactRun o = run_with_contact(s, 200, 10);
    EXPECT_FALSE(o.failure) << interval;
    EXPECT_EQ(o.crossings, 0U) << interval;
    EXPECT_LT(o.work, 0.0) << interval;
  }
  Sheets s = below_a_long_line();
  s.p.contact = {};
  EXPECT_GT(run_with_contact(s, 100, 10).crossings, 0U);
}

TEST(FabricContact, LinesWithoutStiffnessAreNoObstacles) {
  for (const int interval : {1, 10}) {
    Sheets s = below_a_long_line();
    s.p.contact.interval = interval;
    s.p.mesh.line_stiffness = {0.0};
    const ContactRun o = run_with_contact(s, 200, 10);
    EXPECT_FALSE(o.failure) << interval;
    EXPECT_GT(o.crossings, 0U) << interval;
    EXPECT_EQ(o.work, 0.0) << interval;
  }
}

TEST(FabricContact, VerticesMayHaveAnyNumberOfConstraints) {
  for (const int interval : {1, 10}) {
    Sheets s = above_a_fan_of_lines();
    s.p.contact.interval = interval;
    if (interval > 1) s.p.contact.friction = 0.0;
    Sheets again = s;
    const ContactRun o = run_with_contact(s, 100, 10);
    EXPECT_FALSE(o.failure) << interval;
    EXPECT_EQ(o.crossings, 0U) << interval;
    EXPECT_LT(o.work, -0.1 * o.start_kinetic) << interval;
    double impulse = 0.0;
    for (const double mass : s.p.mass) impulse += mass * 3.0;
    EXPECT_LT(o.momentum, 1e-12 * impulse) << interval;
    // The order in which constraints are found changes from run to run.
    static_cast<void>(run_with_contact(again, 100, 10));
    EXPECT_EQ(again.x, s.x) << interval;
    EXPECT_EQ(again.v, s.v) << interval;
  }
}

/// Layers closer than the margin of the lists of neighbours: some 24 of them lie within half an edge, so that
/// no list holds all of it, but few within reach. The two uppermost ones fall.
Sheets stack_of_dense_layers() {
  Sheets s;
  for (int layer = 0; layer < 24; ++layer)
    s.add(4, 0.3, level(0.003 * layer, 0.002 * layer, 0.003 * layer), {0.0, 0.0, layer < 22 ? 0.0 : -0.5});
  s.p.contact.thickness = 0.002;
  s.p.integrator = Integrator::symplectic_euler;
  return s;
}

TEST(FabricContact, DenseLayersNarrowTheMarginOfTheLists) {
  for (const int interval : {1, 2}) {
    Sheets s = stack_of_dense_layers();
    s.p.contact.interval = interval;
    const ContactRun o = run_with_contact(s, 60, 60);
    EXPECT_FALSE(o.failure) << interval;
    EXPECT_EQ(o.crossings, 0U) << interval;
    EXPECT_LT(o.work, -0.1 * o.start_kinetic) << interval << ": they never touched";
  }
  // Layers within the thickness itself are too many.
  Sheets s = stack_of_dense_layers();
  s.p.contact.thickness = 0.06;
  const ContactRun o = run_with_contact(s, 1, 1);
  ASSERT_TRUE(o.failure);
  EXPECT_EQ(o.failure->reason, FailureReason::too_dense);
}

TEST(FabricContact, SheetsCrossWithoutContact) {
  Sheets s = edge_on(3.0);
  s.p.contact = {};
  EXPECT_GT(run_with_contact(s, 100, 10).crossings, 0U);
}

TEST(FabricContact, PreventsCrossingsAtAHundredMetresPerSecond) {
  Sheets s = impact(100.0);
  s.p.material.membrane_modulus = 1e5;
  s.p.dt = 5e-6;
  const ContactRun o = run_with_contact(s, 300, 3);
  EXPECT_FALSE(o.failure);
  EXPECT_EQ(o.crossings, 0U);
  EXPECT_LT(o.work, -0.1 * o.start_kinetic);
}

// ctest-label: no-sanitizer
TEST(FabricContact, ComesToRestInAStackOfThreeSheets) {
  Sheets s = stack();
  s.p.dt = 1e-4;
  const ContactRun o = run_with_contact(s, 1500, 100);
  EXPECT_FALSE(o.failure);
  EXPECT_EQ(o.crossings, 0U);
  double fastest = 0.0, lowest = 1.0;
  for (std::size_t i = 0; i < s.v.size(); ++i) {
    fastest = std::max(fastest, std::hypot(s.v[i][0], s.v[i][1], s.v[i][2]));
    lowest = std::min(lowest, s.x[i][2]);
  }
  EXPECT_LT(fastest, 2e-2);
  EXPECT_GT(lowest, 0.9 * s.p.contact.thickness);
  EXPECT_LT(lowest, 1.1 * s.p.contact.thickness);
}

TEST(FabricContact, SeparatesInitialOverlapSlowlyForAnyTimeStep) {
  for (const double dt : {5e-5, 5e-6}) {
    Sheets s;
    s.add(6, 0.06, level(0.0, 0.0, 0.0), {0.0, 0.0, 0.0});
    s.add(5, 0.05, level(0.003, 0.004, 0.0005), {0.0, 0.0, 0.0});
    s.p.dt = dt;
    double mass = 0.0;
    for (const double m : s.p.mass) mass += m;
    const ContactRun o = run_with_contact(s, 100, 100);
    ASSERT_FALSE(o.failure);
    EXPECT_GT(o.work, 0.0) << dt;
    EXPECT_LT(o.work, mass * 10.0 * 0.0015) << dt;  // work to lift all mass by the missing 1.5 mm
  }
}

/// Sliding distance, m, and velocity, m/s, of a sheet after release at `speed` downhill on an inclined plane.
std::array<double, 2> slide_on_incline(double angle, double friction, double speed, int steps) {
  const double c = std::cos(angle), d = std::sin(angle);
  Sheets s;
  s.p.contact.self = false;
  s.add(5, 0.04,
        [=](double a, double b) {
          return Vector{c * a + d * 0.002, b, c * 0.002 - d * a};
        },
        {c * speed, 0.0, -d * speed});
  s.p.gravity = {0.0, 0.0, -9.81};
  Body slope;
  slope.kind = BodyKind::plane;
  slope.normal = {d, 0.0, c};
  slope.friction = friction;
  s.p.contact.bodies = {slope};
  s.p.dt = 5e-5;
  const auto solver = create_solver(backend, s.p);
  const std::vector<Vector> from = s.x;
  solver->upload(s.x, s.v);
  EXPECT_TRUE(solver->enqueue_steps(steps) && !solver->failure());
  solver->download(s.x, s.v);
  return {c * (s.x[12][0] - from[12][0]) - d * (s.x[12][2] - from[12][2]), c * s.v[12][0] - d * s.v[12][2]};
}

// ctest-label: no-sanitizer
TEST(FabricContact, SlidesByCoulombsLaw) {
  const double g = 9.81, angle = 0.3, dt = 5e-5;
  const int steps = 2000;  // 0.1 s
  const double t = steps * dt;
  // The acceleration is g (sin - mu cos) on the incline and -mu g on the horizontal plane.
  for (const double friction : {0.0, 0.2}) {
    const double a = g * (std::sin(angle) - friction * std::cos(angle));
    EXPECT_NEAR(slide_on_incline(angle, friction, 0.1, steps)[1], 0.1 + a * t, 2e-3 * g * t) << friction;
  }
  EXPECT_NEAR(slide_on_incline(0.0, 0.2, 0.5, steps)[1], 0.5 - 0.2 * g * t, 2e-3 * g * t);
  // It stops after v^2 / (2 mu g) and remains at rest.
  const auto stopped = slide_on_incline(0.0, 0.4, 0.2, steps);
  EXPECT_NEAR(stopped[0], 0.2 * 0.2 / (2.0 * 0.4 * g), 1e-4);
  EXPECT_NEAR(stopped[1], 0.0, g * dt);
}

// ctest-label: no-sanitizer
TEST(FabricContact, HoldsByFrictionOnAnIncline) {
  // Displacements of single steps cancel: after any number of steps the sheet has moved by less than
  // g dt^2, the displacement by one kick.
  const double g = 9.81, angle = 0.3, dt = 5e-5, most = g * dt * dt;
  for (const int steps : {1000, 4000})
    EXPECT_LT(std::abs(slide_on_incline(angle, 0.5, 0.0, steps)[0]), most) << steps;
}

// ctest-label: no-sanitizer
TEST(FabricContact, HoldsByFrictionOnAPinnedSheet) {
  // A small sheet lies on a pinned one. Gravity is inclined by less than the angle of friction.
  const double g = 9.81, angle = 0.2;
  Sheets s;
  s.add(8, 0.07, level(0.0, 0.0, 0.0), {0.0, 0.0, 0.0});
  s.p.pinned.assign(s.x.size(), 7);
  s.add(5, 0.03, level(0.0212, 0.0177, 0.002), {0.0, 0.0, 0.0});
  s.p.pinned.resize(s.x.size(), 0);
  s.p.gravity = {g * std::sin(angle), 0.0, -g * std::cos(angle)};
  s.p.damping = 50.0;
  const auto solver = create_solver(backend, s.p);
  solver->upload(s.x, s.v);
  const auto mean = [&] {
    EXPECT_FALSE(solver->failure());
    solver->download(s.x, s.v);
    double sum = 0.0;
    for (std::size_t i = 64; i < s.x.size(); ++i) sum += s.x[i][0] / 25.0;
    return sum;
  };
  EXPECT_TRUE(solver->enqueue_steps(2000));
  const double before = mean();
  EXPECT_TRUE(solver->enqueue_steps(2000));
  // Without cancellation, half a kick per step would move the sheet by 4.9e-6 m in 2000 steps.
  EXPECT_NEAR(mean(), before, 5e-7);
}

TEST(FabricContact, FrictionWorkEqualsForceTimesSlidingDistance) {
  // A sheet of weight N slides over the horizontal plane: the work over a distance s is -mu N s.
  const double mu = 0.3, g = 9.81;
  Sheets s;
  s.p.contact.self = false;
  s.add(5, 0.04, level(0.0, 0.0, 0.002), {0.5, 0.2, 0.0});
  s.p.gravity = {0.0, 0.0, -g};
  Body plane;
  plane.kind = BodyKind::plane, plane.friction = mu;
  s.p.contact.bodies = {plane};
  const auto solver = create_solver(backend, s.p);
  solver->upload(s.x, s.v);
  double weight = 0.0;
  for (const double m : s.p.mass) weight += m * g;
  const Vector from = s.x[12];
  const Totals start = solver->totals();
  Totals before = start;
  double distance_before = 0.0;
  for (int part = 0; part < 5; ++part) {
    ASSERT_TRUE(solver->enqueue_steps(200) && !solver->failure());
    solver->download(s.x, s.v);
    const double distance = std::hypot(s.x[12][0] - from[0], s.x[12][1] - from[1]);
    const Totals now = solver->totals();
    EXPECT_NEAR(now.friction, -mu * weight * distance, 1e-3 * start.kinetic);
    EXPECT_NEAR(now.kinetic - start.kinetic, now.friction, 1e-4 * start.kinetic);
    // The first step contains only half of gravity's impulse. Afterwards the balance is exact: work uses the
    // mean of the velocities before and after an impulse, the sliding distance the velocity after it.
    if (part > 0) {
      const double more = 0.5 * mu * g * s.p.dt * (200.0 * s.p.dt);
      EXPECT_NEAR(now.friction - before.friction, -mu * weight * (distance - distance_before + more),
                  1e-9 * start.kinetic);
      EXPECT_NEAR(now.kinetic - before.kinetic, now.friction - before.friction, 1e-9 * start.kinetic);
      EXPECT_NEAR(now.contact, before.contact, 1e-9 * start.kinetic);
    }
    before = now, distance_before = distance;
  }
  std::vector<ContactWork> work(s.x.size());
  solver->contact_work(work);
  for (const ContactWork& of_vertex : work) EXPECT_LT(of_vertex.friction, 0.0);
}

TEST(FabricContact, FrictionBetweenLayersDissipatesEnergy) {
  for (const double friction : {0.0, 0.3}) {
    Sheets s = impact(3.0);
    for (std::size_t i = 0; i < s.v.size(); ++i)
      if (s.x[i][2] > 0.0) s.v[i][0] += 2.0;  // the upper sheet slides over the lower one
    s.p.contact.friction = friction;
    const auto solver = create_solver(backend, s.p);
    solver->upload(s.x, s.v);
    const Totals start = solver->totals();
    double before = 0.0;
    for (int part = 0; part < 10; ++part) {
      ASSERT_TRUE(solver->enqueue_steps(20) && !solver->failure());
      const double now = solver->totals().friction;
      EXPECT_LE(now, before);
      before = now;
    }
    const Totals end = solver->totals();
    EXPECT_NEAR(end.energy() - start.energy(), end.contact + end.friction, 1e-2 * start.kinetic) << friction;
    if (friction == 0.0)
      EXPECT_EQ(end.friction, 0.0);
    else
      EXPECT_LT(end.friction, -0.01 * start.kinetic);
  }
}

// ctest-label: no-sanitizer
TEST(FabricContact, KeepsFabricOutsideBodies) {
  Body disk;
  disk.kind = BodyKind::disk, disk.radius = 0.031, disk.normal = {0.6, 0.0, 0.8};
  Body sphere;
  sphere.kind = BodyKind::sphere, sphere.radius = 0.025;
  for (Body body : {disk, sphere})
    for (const double speed : {1.0, 20.0}) {
      Sheets s;
      s.add(8, 0.09, level(-0.05, -0.043, 0.035), {0.0, 0.0, -speed});
      body.friction = 0.2;
      s.p.contact.bodies = {body};
      s.p.dt = 2e-5;
      const auto solver = create_solver(backend, s.p);
      solver->upload(s.x, s.v);
      int inside = 0;
      double least = 1.0;
      for (int look = 0; look < 80; ++look) {
        EXPECT_TRUE(solver->enqueue_steps(20) && !solver->failure());
        solver->download(s.x, s.v);
        for (const auto& t : s.p.mesh.triangles) {
          const auto at = [&](std::size_t k) { return s.x[static_cast<std::size_t>(t[k])]; };
          inside += reference::enters(body, {at(0), at(1), at(2)}) ? 1 : 0;
        }
        for (const Vector& x : s.x) least = std::min(least, reference::distance_from(body, x));
      }
      EXPECT_EQ(inside, 0);
      EXPECT_GT(least, 0.0);
      EXPECT_LT(least, 1.1 * s.p.contact.thickness) << "the sheet never touched the body";
    }
}

TEST(FabricContact, LevelSetOfASphereMatchesTheSphere) {
  Body sphere;
  sphere.kind = BodyKind::sphere, sphere.radius = 0.025;
  Body level_set;
  level_set.kind = BodyKind::level_set;
  level_set.level_set = postfix({"x", 2.0, "^", "y", 2.0, "^", "+", "z", 2.0, "^", "+", "sqrt", 0.025, "-"});
  std::vector<Vector> ends[2];
  for (const bool as_level_set : {false, true}) {
    Sheets s;
    s.p.contact.self = false;
    s.add(8, 0.05, level(-0.025, -0.024, 0.03), {0.0, 0.0, -1.0});
    s.p.contact.bodies = {as_level_set ? level_set : sphere};
    const auto solver = create_solver(backend, s.p);
    solver->upload(s.x, s.v);
    EXPECT_TRUE(solver->enqueue_steps(150) && !solver->failure());
    solver->download(s.x, s.v);
    ends[as_level_set ? 1 : 0] = s.x;
  }
  double apart = 0.0;
  for (std::size_t i = 0; i < ends[0].size(); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis)
      apart = std::max(apart, std::abs(ends[0][i][axis] - ends[1][i][axis]));
  // A sphere excludes edges and faces as well, a level set only vertices.
  EXPECT_LT(apart, 2e-3);
}

TEST(FabricContact, ReportsNonFiniteLevelSets) {
  Body body;
  body.kind = BodyKind::level_set;
  body.level_set =
      postfix({"z", 1.0, "+", 0.0, "z", "sqrt", "*", "+"});  // positive above z = 0, not a number below
  Sheets s;
  s.p.contact.self = false;
  s.add(4, 0.03, level(0.0, 0.0, 0.01), {0.0, 0.0, -1.0});
  s.p.contact.bodies = {body};
  const ContactRun o = run_with_contact(s, 300, 10);
  ASSERT_TRUE(o.failure);
  EXPECT_EQ(o.failure->reason, FailureReason::no_number);
  EXPECT_NEAR(static_cast<double>(o.failure->step), 200.0, 2.0);  // 10 mm at 1 m/s in steps of 50 us
}

TEST(FabricContact, RestartsWithIdenticalBits) {
  Sheets s = folded(3.0);
  const auto whole = create_solver(backend, s.p);
  whole->upload(s.x, s.v);
  ASSERT_TRUE(whole->enqueue_steps(150));
  std::vector<Vector> x = s.x, v = s.v;
  whole->download(x, v);
  std::vector<ContactWork> work(x.size()), end_work = work, other_work = work;
  whole->contact_work(work);
  const auto part = create_solver(backend, s.p);
  part->set_time_state(whole->time_state());
  part->upload(x, v);
  part->set_contact_work(work);
  ASSERT_TRUE(whole->enqueue_steps(150) && part->enqueue_steps(70) && part->enqueue_steps(80));
  whole->download(s.x, s.v), part->download(x, v);
  whole->contact_work(end_work), part->contact_work(other_work);
  EXPECT_EQ(x, s.x);
  EXPECT_EQ(v, s.v);
  EXPECT_EQ(end_work, other_work);
  EXPECT_NE(end_work, work);
}

TEST(FabricContact, ReportsCrossingsOfPrescribedMotions) {
  // All vertices of two sheets have prescribed motions that cross.
  Sheets s;
  s.add(4, 0.03, level(0.0, 0.0, 0.0), {0.0, 0.0, 0.0});
  s.add(4, 0.03, level(0.003, 0.004, 0.01), {0.0, 0.0, 0.0});
  s.p.motions = {{2, {}, postfix({0.0})}, {2, {}, postfix({-160.0, "t", -10.0, "*", "+", 0.01, "+"})}};
  for (int i = 0; i < 16; ++i)
    s.p.motions[0].vertices.push_back(i), s.p.motions[1].vertices.push_back(16 + i);
  s.p.pinned.assign(32, 7);
  const ContactRun o = run_with_contact(s, 60, 1);
  ASSERT_TRUE(o.failure);
  EXPECT_EQ(o.failure->reason, FailureReason::crossing);
  EXPECT_EQ(o.failure->step, 20);  // 10 mm at 10 m/s in steps of 50 us
  EXPECT_EQ(o.crossings, 0U);
}

TEST(FabricContact, ReportsStepsTooLongForTheVelocity) {
  Sheets s = impact(2000.0);
  const ContactRun o = run_with_contact(s, 10, 1);
  ASSERT_TRUE(o.failure);
  EXPECT_NE(o.failure->reason, FailureReason::not_finite);
}

TEST(FabricContact, RejectsInvalidContactParameters) {
  const auto expect_rejected = [](auto change) {
    Sheets s = impact(1.0);
    change(s.p.contact);
    EXPECT_THROW(static_cast<void>(create_solver(backend, s.p)), std::invalid_argument);
  };
  expect_rejected([](Contact& c) { c.thickness = 0.0; });
  expect_rejected([](Contact& c) { c.thickness = 0.02; });  // triangles are 8 mm high
  expect_rejected([](Contact& c) { c.friction = -1.0; });
  expect_rejected([](Contact& c) { c.bodies.resize(1); });  // a sphere without radius
  expect_rejected([](Contact& c) {
    c.bodies.resize(1);
    c.bodies[0].kind = BodyKind::plane, c.bodies[0].normal = {0.0, 0.0, 2.0};
  });
  expect_rejected([](Contact& c) {
    c.bodies.resize(1);
    c.bodies[0].kind = BodyKind::level_set;
  });
}

}  // namespace
}  // namespace drogue::fabric
