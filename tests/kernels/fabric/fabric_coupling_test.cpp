// ctest-label: exact
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "kernels/fabric/fabric_solver.hpp"
#include "tests/support/backend.hpp"
#include "tests/support/expression_program.hpp"
#include "tests/support/fabric_mesh.hpp"
#include "tests/support/fabric_sheets.hpp"
#include "tests/support/profiled.hpp"

// Coupling of a fabric to other kernels on the device: forces of the caller, and the state in device Views.

namespace drogue::fabric {
namespace {

using device::ProfilingCounters;
using testing::postfix;
using testing::random_patch;
using testing::shaken;

using Space = DROGUE_TEST_SPACE;
using Points = PointsView<Space>;
constexpr bool on_device = !device::is_host<Space>;

/// Without fused multiply-add, all drivers give the same bits.
#if defined(DROGUE_EXACT)
constexpr double rounding = 0.0;
#else
constexpr double rounding = 1.0;
#endif

struct Motions {
  std::vector<Vector> x, v;
};

double distance(const Motions& a, const Motions& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.x.size(); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis)
      largest =
          std::max({largest, std::abs(a.x[i][axis] - b.x[i][axis]), std::abs(a.v[i][axis] - b.v[i][axis])});
  return largest;
}

/// Sheet whose corners hang on springs from pinned anchors.
Parameters mounted_sheet(Integrator integrator, Driver driver, Model model = Model::biquadratic) {
  Parameters p;
  p.mesh = random_patch(11, 9, 3);
  const int corners[] = {0, 10, 88, 98};
  for (const int corner : corners) {
    Vector anchor = p.mesh.rest[static_cast<std::size_t>(corner)];
    anchor[2] += 2.0;
    p.mesh.lines.push_back({corner, static_cast<int>(p.mesh.rest.size())});
    p.mesh.rest.push_back(anchor);
  }
  p.material.model = model;
  p.material.axial_stiffness = 50.0;
  p.mass.assign(p.mesh.rest.size(), 0.01);
  p.pinned.assign(p.mass.size(), 0);
  for (std::size_t k = 1; k <= 4; ++k) p.pinned[p.pinned.size() - k] = 7;
  p.gravity = {0.0, 0.0, -9.81};
  p.damping = 0.2;
  p.integrator = integrator;
  p.driver = driver;
  p.dt = 1e-4;
  return p;
}

Points on_device_points(const Space& space, const std::vector<Vector>& from) {
  const Points to("points", from.size());
  const auto mirror = Kokkos::create_mirror_view(to);
  for (std::size_t i = 0; i < from.size(); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis) mirror(i, axis) = from[i][axis];
  device::copy(space, to, mirror);
  space.fence("test");
  return to;
}

/// Vertex force equal to a timed load, strength(x, y, z, t) times direction, N, or without directions of a
/// damped spring to the rest position. One type for both: each compiles a solver.
struct PushOrMount {
  Points rest, direction;
  device::ExpressionProgram strength;
  double stiffness = 0.0, damping = 0.0;

  KOKKOS_FUNCTION Vector3<double> operator()(const VertexStage& at) const {
    const Vector3<double> place = load_points<double>(rest, at.vertex);
    if (direction.extent(0) > 0)
      return device::evaluate(strength, place.x, place.y, place.z, at.time) *
             load_points<double>(direction, at.vertex);
    return stiffness * (place - at.position) - damping * at.velocity;
  }
};
using ForcedSolver = FabricSolver<Space, PushOrMount>;

PushOrMount mount(const Space& space, const std::vector<Vector>& rest, double stiffness, double damping) {
  return {on_device_points(space, rest), {}, {}, stiffness, damping};
}

/// Kernel launches of 1000 steps after 256 steps to warm up. `end`: the initial state, overwritten with the
/// final one. Also expects no fence, allocation or copy.
template <class Solver>
std::int64_t launches_of(Solver& solver, Motions& end) {
  solver.upload(end.x, end.v);
  solver.enqueue_steps(256);
  const ProfilingCounters before = testing::profiled();
  solver.enqueue_steps(1000);
  const ProfilingCounters after = testing::profiled();
  EXPECT_EQ(after.fences, before.fences);
  EXPECT_EQ(after.allocations, before.allocations);
  EXPECT_EQ(after.copies, before.copies);
  EXPECT_EQ(after.h2d_bytes + after.d2h_bytes, before.h2d_bytes + before.d2h_bytes);
  EXPECT_FALSE(solver.failure());
  EXPECT_EQ(solver.time_state().step, 1256);
  solver.download(end.x, end.v);
  return after.kernel_launches - before.kernel_launches;
}

/// Bound of the launches of 1000 steps from step 256, of which three checkpoints end three of four batches.
/// `has_load`: a load needs a kernel per evaluation, except in the persistent driver.
std::int64_t most_launches(Integrator integrator, Driver driver, bool has_load) {
  const std::int64_t steps = 1000, batches = 4, checkpoints = 3, kernels = has_load ? 2 : 1;
  if (integrator == Integrator::verlet) return kernels * (steps + batches) + checkpoints;
  if (!on_device) return 4 * kernels * steps + checkpoints;
  if (driver == Driver::plain) return (has_load ? 4 * kernels : 2) * steps + checkpoints;
  const bool is_graph = driver == Driver::graph || driver == Driver::stages;
  return (is_graph ? steps : batches) + checkpoints;
}

void expect_force_like_load(Integrator integrator, Driver driver, Model model, double tolerance) {
  const device::Instance<Space> instance(1);
  const Space& space = instance.space();
  const device::ExpressionProgram strength = postfix({"x", "t", 60.0, "*", "+", "sin", "y", 0.1, "*", "+"});
  Parameters p = mounted_sheet(integrator, driver, model);
  std::vector<Vector> direction;
  // Products with powers of two are exact, so fused multiply-add does not change them.
  for (std::size_t i = 0; i < p.mass.size(); ++i) direction.push_back({0.125, i % 2 == 0 ? 0.25 : 0.0, -0.5});
  const Motions start{shaken(p.mesh.rest, 0.05, 1),
                      shaken(std::vector<Vector>(p.mass.size(), Vector{}), 0.1, 2)};

  ForcedSolver forced(instance, p,
                      {on_device_points(space, p.mesh.rest), on_device_points(space, direction), strength});
  Motions by_force = start;
  const std::int64_t of_forced = launches_of(forced, by_force);
  EXPECT_LE(of_forced, most_launches(integrator, driver, false));

  FabricSolver<Space> free(instance, p);
  Motions without = start;
  EXPECT_LE(of_forced, launches_of(free, without)) << "forces add no launches";
  EXPECT_STREQ(forced.driver(), free.driver());
  EXPECT_GT(distance(by_force, without), 1e-3);

  p.timed_loads = {{strength, direction}};
  FabricSolver<Space> loaded(instance, p);
  Motions by_load = start;
  EXPECT_LE(launches_of(loaded, by_load), most_launches(integrator, driver, true));
  EXPECT_STREQ(loaded.driver(), free.driver()) << "loads do not change the driver";
  EXPECT_LE(distance(by_force, by_load), tolerance);
}

// ctest-label: no-sanitizer
TEST(FabricCoupling, VertexForceMatchesALoadWithoutExtraLaunches) {
  for (const Driver driver : {Driver::plain, Driver::graph, Driver::stages, Driver::persistent})
    expect_force_like_load(Integrator::rk4, driver, Model::biquadratic, rounding * 1e-9);
  expect_force_like_load(Integrator::verlet, Driver::plain, Model::biquadratic, rounding * 1e-9);
  expect_force_like_load(Integrator::rk4, Driver::automatic, Model::edge, rounding * 1e-9);
}

TEST(FabricCoupling, LinesHaveTheirNewStiffnessAsIfGivenAtTheStart) {
  const device::Instance<Space> instance(1);
  for (const auto& [integrator, driver] : {std::pair{Integrator::symplectic_euler, Driver::automatic},
                                           {Integrator::verlet, Driver::automatic},
                                           {Integrator::rk4, Driver::plain},
                                           {Integrator::rk4, Driver::graph},
                                           {Integrator::rk4, Driver::persistent}}) {
    Parameters p = mounted_sheet(integrator, driver);
    const Motions start{shaken(p.mesh.rest, 0.05, 1), std::vector<Vector>(p.mass.size(), Vector{})};
    std::vector<double> stiffness(p.mesh.lines.size(), 40.0);
    stiffness.back() = 0.0;
    FabricSolver<Space> changed(instance, p);
    Motions one = start, other = start;
    changed.upload(one.x, one.v);
    ASSERT_TRUE(changed.enqueue_steps(20));
    changed.set_line_stiffness(stiffness);
    changed.upload(start.x, start.v);
    ASSERT_TRUE(changed.enqueue_steps(20) && !changed.failure());
    changed.download(one.x, one.v);
    p.mesh.line_stiffness = stiffness;
    FabricSolver<Space> given(instance, p);
    given.upload(other.x, other.v);
    ASSERT_TRUE(given.enqueue_steps(20) && !given.failure());
    given.download(other.x, other.v);
    EXPECT_EQ(distance(one, other), 0.0);
    EXPECT_EQ(changed.fastest_frequency(), given.fastest_frequency());
    EXPECT_EQ(changed.totals().elastic, given.totals().elastic);
    EXPECT_THROW(changed.set_line_stiffness(std::vector<double>(2, 1.0)), std::invalid_argument);
    stiffness.front() = -1.0;
    EXPECT_THROW(changed.set_line_stiffness(stiffness), std::invalid_argument);
  }
}

TEST(FabricCoupling, ClothMovesThroughALineThatIsCut) {
  // A sheet flies at a line between two heavy vertices.
  const device::Instance<Space> instance(1);
  testing::Sheets s;
  s.add(8, 0.07, testing::level(0.0, 0.0, 0.005), {0.0, 0.0, -3.0});
  const int first = static_cast<int>(s.x.size());
  for (const double along : {-0.05, 0.15}) {
    s.p.mesh.rest.push_back({along, 0.033, 5.0});
    s.x.push_back({along, 0.033, 0.0});
    s.v.push_back({0.0, 0.0, 0.0});
    s.p.mass.push_back(10.0);
  }
  s.p.mesh.lines.push_back({first, first + 1});
  s.p.mesh.line_stiffness = {1e6};
  for (const int interval : {1, 8}) {
    s.p.contact.interval = interval;
    FabricSolver<Space> solver(instance, s.p);
    Motions end{s.x, s.v};
    const auto middle_after = [&](int steps) {
      EXPECT_TRUE(solver.enqueue_steps(steps) && !solver.failure());
      solver.download(end.x, end.v);
      return end.x[27][2];
    };
    solver.upload(s.x, s.v);
    EXPECT_GT(middle_after(64), 0.0) << "0.005 m above the line, at 3 m/s for 0.0032 s";
    solver.set_line_stiffness(std::vector<double>{0.0});
    solver.upload(s.x, s.v);
    EXPECT_NEAR(middle_after(64), 0.005 - 3.0 * 64 * 5e-5, 1e-9);
  }
}

/// Final state after one call per entry of `cuts`, which is the number of steps of the call.
Motions mounted_motions(Integrator integrator, Driver driver, const std::vector<std::int64_t>& cuts) {
  const device::Instance<Space> instance(1);
  const Parameters p = mounted_sheet(integrator, driver);
  ForcedSolver solver(instance, p, mount(instance.space(), p.mesh.rest, 20.0, 0.05));
  Motions now{shaken(p.mesh.rest, 0.05, 1), std::vector<Vector>(p.mass.size(), Vector{})};
  solver.upload(now.x, now.v);
  for (const std::int64_t steps : cuts) solver.enqueue_steps(steps);
  solver.download(now.x, now.v);
  return now;
}

TEST(FabricCoupling, ForcesOfPositionAndVelocityAreThoseOfEveryDriverAndDivisionOfSteps) {
  const Motions plain = mounted_motions(Integrator::rk4, Driver::plain, {20});
  for (const Driver driver : {Driver::graph, Driver::persistent})
    EXPECT_LE(distance(plain, mounted_motions(Integrator::rk4, driver, {20})), rounding * 1e-11);
  for (const Integrator integrator : {Integrator::rk4, Integrator::verlet, Integrator::symplectic_euler}) {
    const Motions whole = mounted_motions(integrator, Driver::automatic, {20});
    EXPECT_EQ(distance(whole, mounted_motions(integrator, Driver::automatic, {7, 1, 12})), 0.0);
  }
}

/// Halves the velocity of each vertex in each step and counts the steps, at a push along x.
struct Halving {
  Kokkos::View<int*, Space::memory_space> steps;

  KOKKOS_FUNCTION Vector3<double> operator()(const VertexStage&) const { return {0.02, 0.0, 0.0}; }
  KOKKOS_FUNCTION Vector3<double> relaxed_velocity(const VertexStage& at) const {
    ++steps(at.vertex);
    return 0.5 * at.velocity;
  }
};

TEST(FabricCoupling, RelaxesVelocitiesOncePerStepBetweenKickAndDrift) {
  const device::Instance<Space> instance(1);
  Parameters p;
  p.mesh.rest = {{0, 0, 0}, {1, 0, 0}};
  p.mass = {2.0, 2.0};
  p.pinned = {0, 7};
  p.integrator = Integrator::symplectic_euler;
  p.dt = 0.5;
  const Halving halving{decltype(Halving::steps)("steps", 2)};
  FabricSolver<Space, Halving> solver(instance, p, halving);
  Motions now{p.mesh.rest, {{1.0, 4.0, 0.0}, {1.0, 0.0, 0.0}}};
  solver.upload(now.x, now.v);
  solver.enqueue_steps(2);
  solver.download(now.x, now.v);
  // Kicks of 0.005 m/s along x.
  const double first = 0.5 * 1.005, second = 0.5 * (first + 0.005);
  EXPECT_DOUBLE_EQ(now.v[0][0], second);
  EXPECT_DOUBLE_EQ(now.x[0][0], 0.5 * (first + second));
  EXPECT_DOUBLE_EQ(now.v[0][1], 1.0);
  EXPECT_EQ(now.v[1][0], 1.0) << "pinned axes keep their velocity";
  EXPECT_EQ(now.x[1][0], 2.0);
  const auto taken = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), halving.steps);
  EXPECT_EQ(taken(0), 2);
  for (const Integrator integrator : {Integrator::rk4, Integrator::verlet}) {
    p.integrator = integrator;
    EXPECT_THROW((FabricSolver<Space, Halving>(instance, p, halving)), std::invalid_argument);
  }
}

TEST(FabricCoupling, RejectsStepsThatDoNotExist) {
  const device::Instance<Space> instance(1);
  const Parameters p = mounted_sheet(Integrator::rk4, Driver::automatic);
  FabricSolver<Space> solver(instance, p);
  solver.upload(p.mesh.rest, std::vector<Vector>(p.mass.size()));
  EXPECT_THROW(solver.enqueue_steps(-5), std::invalid_argument);
  EXPECT_THROW(solver.enqueue_steps(std::numeric_limits<std::int64_t>::max()), std::invalid_argument);
  EXPECT_THROW(solver.set_time_state({-5, p.dt, 10, 0.0}), std::invalid_argument);
  EXPECT_THROW(solver.set_time_state({5, p.dt, 10, 0.0}), std::invalid_argument);
  EXPECT_TRUE(solver.enqueue_steps(0));
  EXPECT_EQ(solver.time_state().step, 0);
}

TEST(FabricCoupling, MassInAVertexForceSpringOscillates) {
  const device::Instance<Space> instance(1);
  for (const Integrator integrator : {Integrator::rk4, Integrator::verlet}) {
    Parameters p;
    p.mesh.rest = {{0, 0, 0}, {1, 0, 0}};
    p.mass = {2.0, 2.0};
    p.integrator = integrator;
    p.dt = 1e-3;
    ForcedSolver solver(instance, p, mount(instance.space(), p.mesh.rest, 50.0, 0.0));
    Motions now{{{0.1, 0, 0}, {1, 0.2, 0}}, std::vector<Vector>(2)};
    solver.upload(now.x, now.v);
    solver.enqueue_steps(1000);
    solver.download(now.x, now.v);
    const double tolerance = integrator == Integrator::rk4 ? 1e-9 : 1e-5;
    EXPECT_NEAR(now.x[0][0], 0.1 * std::cos(5.0), tolerance);
    EXPECT_NEAR(now.v[1][1], -1.0 * std::sin(5.0), 5.0 * tolerance);
  }
}

/// Moves all vertices by a vector and gives them a velocity.
struct Shift {
  State<Space> state;
  Vector3<double> displacement, velocity;

  KOKKOS_FUNCTION void operator()(const int i) const {
    state.positions(i, 0) += displacement.x, state.positions(i, 1) += displacement.y,
        state.positions(i, 2) += displacement.z;
    state.velocities(i, 0) = velocity.x, state.velocities(i, 1) = velocity.y,
                        state.velocities(i, 2) = velocity.z;
  }
};

TEST(FabricCoupling, AnotherKernelWritesTheStateWithoutACopy) {
  const device::Instance<Space> instance(1);
  const Space& space = instance.space();
  for (const Integrator integrator : {Integrator::rk4, Integrator::verlet, Integrator::symplectic_euler}) {
    Parameters p = mounted_sheet(integrator, Driver::automatic);
    p.relative_damping = 0.5;  // with dashpots, Verlet's method alternates between two buffers of velocities
    FabricSolver<Space> solver(instance, p), other(instance, p);
    Motions now{shaken(p.mesh.rest, 0.05, 1), std::vector<Vector>(p.mass.size(), Vector{})};
    solver.upload(now.x, now.v);
    const State<Space> state = solver.state();
    ASSERT_EQ(state.positions.extent(0), p.mass.size());
    ASSERT_EQ(state.positions.extent(1), 3U);
    const ProfilingCounters before = testing::profiled();
    solver.enqueue_steps(3);
    Kokkos::parallel_for("shift", Kokkos::RangePolicy<Space>(space, 0, solver.vertices()),
                         Shift{state, {0.5, 0.25, -1.0}, {0.1, 0.2, 0.3}});
    const ProfilingCounters after = testing::profiled();
    EXPECT_EQ(after.fences, before.fences);
    EXPECT_EQ(after.copies, before.copies);
    EXPECT_EQ(solver.state().positions.data(), state.positions.data());
    EXPECT_EQ(solver.state().velocities.data(), state.velocities.data());
    Motions shifted = now;
    solver.download(shifted.x, shifted.v);

    other.upload(now.x, now.v);
    EXPECT_TRUE(other.enqueue_steps(3));
    other.download(now.x, now.v);
    for (std::size_t i = 0; i < now.x.size(); ++i) {
      EXPECT_EQ(shifted.x[i], (Vector{now.x[i][0] + 0.5, now.x[i][1] + 0.25, now.x[i][2] - 1.0}));
      EXPECT_EQ(shifted.v[i], (Vector{0.1, 0.2, 0.3}));
    }
    // Further steps start from the written state.
    solver.enqueue_steps(4);
    other.upload(shifted.x, shifted.v);
    other.enqueue_steps(4);
    solver.download(now.x, now.v);
    other.download(shifted.x, shifted.v);
    EXPECT_EQ(distance(now, shifted), 0.0);
  }
}

TEST(FabricCoupling, MovesPayloadsFreelyAndPinsAtTheWrittenVelocity) {
  const device::Instance<Space> instance(1);
  const Space& space = instance.space();
  for (const Integrator integrator : {Integrator::rk4, Integrator::verlet}) {
    Parameters p = mounted_sheet(integrator, Driver::automatic);
    p.damping = 0.0;
    // A mass of 20 kg on four lines from the corners.
    const int payload = static_cast<int>(p.mesh.rest.size());
    p.mesh.rest.push_back({5.0, 4.0, -12.0});
    p.mass.push_back(20.0);
    p.pinned.push_back(0);
    for (const int corner : {0, 10, 88, 98}) p.mesh.lines.push_back({corner, payload});
    FabricSolver<Space> solver(instance, p);
    Motions now{p.mesh.rest, std::vector<Vector>(p.mass.size(), Vector{})};
    solver.upload(now.x, now.v);
    // Anchors move with 2 m/s along x.
    const auto anchors =
        Kokkos::subview(solver.state().velocities, Kokkos::make_pair(payload - 4, payload), Kokkos::ALL);
    Kokkos::deep_copy(space, Kokkos::subview(anchors, Kokkos::ALL, 0), 2.0);
    solver.enqueue_steps(101);
    solver.download(now.x, now.v);
    const double t = 101 * p.dt;
    for (int k = 1; k <= 4; ++k) {
      const auto i = static_cast<std::size_t>(payload - k);
      EXPECT_NEAR(now.x[i][0], p.mesh.rest[i][0] + 2.0 * t, 1e-12);
      EXPECT_EQ(now.v[i][0], 2.0);
    }
    // The lines are still nearly slack, so the payload falls freely.
    const auto i = static_cast<std::size_t>(payload);
    EXPECT_NEAR(now.x[i][2], -12.0 - 0.5 * 9.81 * t * t, 1e-6);
    EXPECT_NEAR(now.v[i][2], -9.81 * t, 1e-3);
  }
}

/// Solver with a VertexForce whose state another kernel changes before every 7 steps.
struct CoupledSheet {
  ForcedSolver solver;

  CoupledSheet(const device::Instance<Space>& instance, const Parameters& p)
      : solver(instance, p, mount(instance.space(), p.mesh.rest, 20.0, 0.05)) {
    solver.upload(shaken(p.mesh.rest, 0.05, 1), std::vector<Vector>(p.mass.size()));
  }

  /// Enqueues the coupling kernel and 7 steps.
  void enqueue() {
    device::launch_each(solver.space(), "shift", solver.vertices(),
                        Shift{solver.state(), {0.001, 0.0, -0.002}, {0.1, 0.2, 0.3}});
    solver.enqueue_steps(7);
  }
  [[nodiscard]] Motions motions() {
    const auto n = static_cast<std::size_t>(solver.vertices());
    Motions now{std::vector<Vector>(n), std::vector<Vector>(n)};
    solver.download(now.x, now.v);
    return now;
  }
};

void expect_replays(Integrator integrator, Driver driver, bool moves_pins) {
  const device::Instance<Space> instance(1);
  Parameters p = mounted_sheet(integrator, driver);
  if (moves_pins)
    p.motions.push_back({0, {static_cast<int>(p.mass.size()) - 1}, postfix({500.0, "t", "t", "*", "*"})});
  CoupledSheet replayed(instance, p), direct(instance, p);
  const device::CapturedGraph<Space> graph(instance, [&](const Space&) { replayed.enqueue(); });
  for (int replay = 0; replay < 10; ++replay) {
    graph.launch();
    direct.enqueue();
  }
  EXPECT_FALSE(replayed.solver.failure());
  EXPECT_EQ(replayed.solver.time_state().step, 70);
  EXPECT_LE(distance(replayed.motions(), direct.motions()), rounding * 1e-11) << direct.solver.driver();
  // Steps that are not captured follow the replays.
  for (CoupledSheet* each : {&replayed, &direct}) {
    each->solver.enqueue_steps(230);
    each->solver.synchronize();
    EXPECT_EQ(each->solver.time_state().step, 300);
  }
  graph.launch();
  direct.enqueue();
  EXPECT_LE(distance(replayed.motions(), direct.motions()), rounding * 1e-9) << direct.solver.driver();
  EXPECT_EQ(replayed.solver.time_state().step, 307);
}

TEST(FabricCoupling, ReplaysOfCapturedStepsMatchDirectSteps) {
  for (const bool moves_pins : {false, true}) {
    for (const Driver driver : {Driver::plain, Driver::graph, Driver::persistent})
      expect_replays(Integrator::rk4, driver, moves_pins);
    expect_replays(Integrator::verlet, Driver::plain, moves_pins);
  }
}

/// Expects that a failure in step 21, in a replay, returns to the checkpoint that the caller took at step 14.
void expect_failure_of_a_replay(Integrator integrator, Driver driver) {
  const device::Instance<Space> instance(1);
  const Parameters p = mounted_sheet(integrator, driver);
  // Zero, and NaN after 20.6 steps.
  const PushOrMount burst{on_device_points(instance.space(), p.mesh.rest),
                          on_device_points(instance.space(), std::vector<Vector>(p.mass.size())),
                          postfix({20.6 * p.dt, "t", "-", "sqrt"})};
  ForcedSolver solver(instance, p, burst), direct(instance, p, burst);
  const Motions start{shaken(p.mesh.rest, 0.05, 1), std::vector<Vector>(p.mass.size())};
  for (ForcedSolver* each : {&solver, &direct}) each->upload(start.x, start.v);
  const device::CapturedGraph<Space> graph(instance, [&](const Space&) { solver.enqueue_steps(7); });
  graph.launch();
  graph.launch();
  solver.enqueue_checkpoint();
  for (int replay = 0; replay < 3; ++replay) graph.launch();
  const auto failure = solver.failure();
  ASSERT_TRUE(failure) << solver.driver();
  EXPECT_EQ(failure->step, 21);
  EXPECT_EQ(failure->index, 0);
  EXPECT_NEAR(failure->time, 20.0 * p.dt, 1e-12);
  EXPECT_EQ(solver.time_state().step, 14);
  EXPECT_FALSE(solver.enqueue_steps(1));
  Motions now = start, expected = start;
  solver.download(now.x, now.v);
  direct.enqueue_steps(14);
  direct.download(expected.x, expected.v);
  EXPECT_LE(distance(now, expected), rounding * 1e-11);
  // The graph remains valid after an upload, which goes on from step 14.
  solver.upload(start.x, start.v);
  graph.launch();
  EXPECT_EQ(solver.failure().value_or(StepFailure{}).step, 21);
  // After a change of lines or of the time the graph is invalid, and the solver takes checkpoints of its own.
  solver.set_line_stiffness(std::vector<double>(p.mesh.lines.size(), 40.0));
  solver.upload(start.x, start.v);
  EXPECT_TRUE(solver.enqueue_steps(6));
  EXPECT_EQ(solver.time_state().step, 20);
  solver.set_time_state({0, p.dt, 0, -1.0});
  solver.upload(start.x, start.v);
  EXPECT_TRUE(solver.enqueue_steps(300));
  EXPECT_EQ(solver.time_state().step, 300);
  EXPECT_FALSE(solver.failure());
}

TEST(FabricCoupling, FailureInAReplayReturnsToTheCheckpointOfTheCaller) {
  for (const Driver driver : {Driver::plain, Driver::graph, Driver::persistent})
    expect_failure_of_a_replay(Integrator::rk4, driver);
  expect_failure_of_a_replay(Integrator::verlet, Driver::plain);
}

}  // namespace
}  // namespace drogue::fabric
