#include <gtest/gtest.h>

#include <map>
#include <set>

#include "kernels/fabric/fabric_solver.hpp"
#include "kernels/fabric/stepping/persistent_euler.hpp"
#include "kernels/fabric/stepping/persistent_pairs.hpp"
#include "kernels/fabric/stepping/persistent_rings.hpp"
#include "tests/support/emulated_grid.hpp"
#include "tests/support/expression_program.hpp"
#include "tests/support/fabric_mesh.hpp"

// Patches of a mesh, and persistent kernels that step all patches in one launch, emulated by host threads.

namespace drogue::fabric {
namespace {

using testing::random_patch;
using testing::shaken;

constexpr int most_threads = 64;

/// Without fused multiply-add, all drivers give the same bits.
#if defined(DROGUE_EXACT)
constexpr double rounding = 0.0;
#else
constexpr double rounding = 1.0;
#endif

Mesh mesh_of(int nx, int ny) {
  Mesh mesh = random_patch(nx, ny, 3);
  mesh.line_stiffness.assign(mesh.lines.size(), 300.0);
  return mesh;
}

Patches cut(const Mesh& mesh, int count) {
  return make_patches(mesh.rest, ring_adjacency(mesh), spring_adjacency(mesh, {}), count);
}

/// Vertices that share a triangle or a line with each vertex.
std::vector<std::set<int>> neighbours(const Mesh& mesh) {
  std::vector<std::set<int>> of(mesh.rest.size());
  const auto add = [&](int i, int j) { of[static_cast<std::size_t>(i)].insert(j); };
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) add(t[k], t[(k + 1) % 3]), add(t[k], t[(k + 2) % 3]);
  for (const auto& [i, j] : mesh.lines) add(i, j), add(j, i);
  return of;
}

TEST(FabricPatches, ContainEveryVertexOnceAndItsNeighbours) {
  const Mesh mesh = mesh_of(13, 9);
  const auto of = neighbours(mesh);
  for (const int count : {1, 2, 5, 16}) {
    const Patches patches = cut(mesh, count);
    ASSERT_EQ(patches.count(), count);
    EXPECT_EQ(patches.team % slice, 0);
    std::map<int, int> patch_of, place_of;
    std::set<int> places;
    for (std::size_t at = 0; at < patches.vertex.size(); ++at) {
      if (patches.vertex[at] < 0) continue;
      EXPECT_TRUE(patch_of.emplace(patches.vertex[at], at / static_cast<std::size_t>(patches.team)).second);
      if (patches.message[at] < 0) continue;
      EXPECT_TRUE(places.insert(patches.message[at]).second);
      place_of[patches.vertex[at]] = patches.message[at];
    }
    EXPECT_EQ(patch_of.size(), mesh.rest.size());
    EXPECT_EQ(static_cast<int>(places.size()), patches.messages);
    for (const int used : places) EXPECT_LT(used, patches.messages);
    std::set<int> read;
    std::set<std::array<int, 2>> pairs;
    for (int p = 0; p < count; ++p) {
      std::set<int> expected_halo, own;
      for (const auto& [i, patch] : patch_of) {
        if (patch != p) continue;
        own.insert(i);
        for (const int j : of[static_cast<std::size_t>(i)])
          if (patch_of[j] != p) expected_halo.insert(j), read.insert(j), pairs.insert({p, patch_of[j]});
      }
      EXPECT_LT(std::abs(static_cast<double>(own.size()) - static_cast<double>(mesh.rest.size()) / count),
                1.0);
      const auto begin = static_cast<std::size_t>(patches.first_halo[static_cast<std::size_t>(p)]),
                 end = static_cast<std::size_t>(patches.first_halo[static_cast<std::size_t>(p) + 1]);
      std::set<int> halo;
      for (std::size_t k = begin; k < end; ++k) {
        halo.insert(patches.halo_vertex[k]);
        EXPECT_EQ(patches.halo_message[k], place_of.at(patches.halo_vertex[k]));
      }
      EXPECT_EQ(halo, expected_halo);
      EXPECT_EQ(halo.size(), end - begin);
    }
    EXPECT_EQ(read.size(), place_of.size()) << "each message is read";
    for (const auto& [p, q] : pairs)
      EXPECT_EQ(pairs.count({q, p}), 1U) << "neighbourhood of patches is symmetric";
  }
}

TEST(FabricPatches, KeepTheOrderOfNeighbours) {
  const Mesh mesh = mesh_of(13, 9);
  const RingAdjacency rings = ring_adjacency(mesh);
  const Patches patches = cut(mesh, 4);
  const auto slot = [](const RingAdjacency& slots, std::size_t i, int k) {
    return static_cast<std::size_t>(slots.first[i / slice] + k) * slice + i % slice;
  };
  for (std::size_t at = 0; at < patches.vertex.size(); ++at) {
    if (patches.vertex[at] < 0) continue;
    const auto i = static_cast<std::size_t>(patches.vertex[at]);
    const std::size_t patch = at / static_cast<std::size_t>(patches.team);
    const auto mesh_vertex = [&](int number) {
      return number < patches.team ? patches.vertex[patch * static_cast<std::size_t>(patches.team) +
                                                    static_cast<std::size_t>(number)]
                                   : patches.halo_vertex[static_cast<std::size_t>(patches.first_halo[patch] +
                                                                                  number - patches.team)];
    };
    const int here = patches.triangles.first[at / slice + 1] - patches.triangles.first[at / slice];
    for (int k = 0; k < here; ++k) {
      const std::size_t mine = slot(patches.triangles, at, k);
      if (rings.first[i / slice] + k >= rings.first[i / slice + 1]) {
        EXPECT_EQ(patches.triangles.value[2][mine], 0.0) << "padding has no stiffness";
        continue;
      }
      const std::size_t original = slot(rings, i, k);
      EXPECT_EQ(mesh_vertex(patches.triangles.neighbour[mine]), rings.neighbour[original]);
      for (std::size_t a = 0; a < 3; ++a)
        EXPECT_EQ(patches.triangles.value[a][mine], rings.value[a][original]);
    }
  }
}

Parameters cloth_of(const Mesh& mesh) {
  Parameters p;
  p.mesh = mesh;
  for (std::size_t i = 0; i < mesh.rest.size(); ++i)
    p.mass.push_back(0.01 + 0.001 * static_cast<double>(i % 7));
  p.pinned.assign(p.mass.size(), 0);
  p.pinned[3] = 7, p.pinned[50] = 2;
  p.load = shaken(std::vector<Vector>(p.mass.size(), Vector{}), 0.1, 4);
  p.gravity = {0.5, -1.0, -9.81};
  p.damping = 0.3;
  p.dt = 1e-4;
  return p;
}

using Space = Kokkos::Serial;

template <class Loads>
constexpr bool is_loaded = std::is_same_v<Loads, PersistentLoads<Space, true>>;

/// True for the persistent kernel of the symplectic Euler method.
template <class Functor>
constexpr bool is_euler = requires(const Functor& functor) {
  functor.damping;
};

/// Takes steps with the persistent driver; each entry of `cuts` is the number of steps of one launch.
template <ConstitutiveModel model, class Functor, class VertexForce = NoVertexForce,
          class Loads = PersistentLoads<Space, false>>
void run_emulated(const Parameters& p, int count, const std::vector<std::int64_t>& cuts,
                  std::vector<Vector>& x, std::vector<Vector>& v, const VertexForce& vertex_force = {},
                  const Loads& loads = {}) {
  const Space space;
  Material material = p.material;
  material.model = model.model;
  const bool rings = has_triangles(model.model) || !p.follower_pressures.empty();
  const Mesh cloth_mesh = rings ? p.mesh : Mesh{p.mesh.rest, {}, {}, {}, {}, {}};
  const Patches patches =
      make_patches(p.mesh.rest, ring_adjacency(cloth_mesh), spring_adjacency(p.mesh, material), count);
  const PatchViews<Space> views = patch_views(space, patches);
  const std::size_t n = p.mass.size();
  FabricViews<Space> fabric;
  fabric.inverse_mass = decltype(fabric.inverse_mass)("inverse mass", n);
  fabric.fixed_dofs = decltype(fabric.fixed_dofs)("fixed_dofs", n);
  fabric.load = PointsView<Space>("load", n);
  fabric.moduli = moduli(material.membrane_modulus, material.poisson);
  fabric.gravity = {p.gravity[0], p.gravity[1], p.gravity[2]};
  fabric.damping = is_euler<Functor> ? 0.0 : p.damping;
  const PointsView<Space> at("x", n), velocity("v", n);
  for (std::size_t i = 0; i < n; ++i) {
    fabric.inverse_mass(i) = 1.0 / p.mass[i];
    fabric.fixed_dofs(i) = p.pinned[i];
    for (std::size_t axis = 0; axis < 3; ++axis)
      fabric.load(i, axis) = p.load[i][axis], at(i, axis) = x[i][axis], velocity(i, axis) = v[i][axis];
  }
  const StepMonitor<Space> monitor = stepping::make_monitor<Space>(StepMonitor<Space>::StatusView("status"));
  stepping::reset_monitor(space, monitor, 0);
  testing::EmulatedGrid grid(count, team_threads(patches, patches.max_rows, most_threads),
                             Functor::scratch_bytes(views), static_cast<std::size_t>(patches.messages));
  std::int64_t previous_steps = 0;
  std::uint64_t epoch = 0;
  for (const std::int64_t steps : cuts) {
    const PersistentSteps<Space, VertexForce, is_loaded<Loads>> of{
        views, fabric,         at,    velocity, monitor,
        p.dt,  previous_steps, steps, epoch,    {vertex_force, {0, p.dt, 0, 0.0}, static_cast<int>(n)},
        loads};
    if constexpr (is_euler<Functor>)
      grid.launch(Functor{{of}, p.damping});
    else
      grid.launch(Functor{of});
    previous_steps += steps;
    epoch += (is_euler<Functor> ? 1 : 4) * static_cast<std::uint64_t>(steps);
    EXPECT_EQ(monitor.steps(0), previous_steps);
  }
  EXPECT_FALSE(grid.overwritten()) << "two message buffers are too few";
  EXPECT_FALSE(monitor.has_failed());
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t axis = 0; axis < 3; ++axis) x[i][axis] = at(i, axis), v[i][axis] = velocity(i, axis);
}

double distance(const std::vector<Vector>& a, const std::vector<Vector>& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis)
      largest = std::max(largest, std::abs(a[i][axis] - b[i][axis]));
  return largest;
}

template <class ExecutionSpace, ConstitutiveModel model>
using Rings = PersistentRingsFunctor<ExecutionSpace, model>;
template <class ExecutionSpace, ConstitutiveModel model>
using Pairs = PersistentPairsFunctor<ExecutionSpace, model>;

template <ConstitutiveModel model, template <class, ConstitutiveModel> class Functor>
void expect_the_same_steps() {
  Parameters p = cloth_of(mesh_of(11, 8));
  p.material.model = model.model;
  const std::vector<Vector> start = shaken(p.mesh.rest, 0.1, 1), still(p.mass.size(), Vector{});
  std::vector<Vector> x = start, v = still, other_x = start, other_v = still;
  const auto solver = create_solver(device::Backend::serial, p);
  solver->upload(x, v);
  ASSERT_TRUE(solver->enqueue_steps(7));
  solver->download(x, v);
  EXPECT_GT(distance(x, start), 1e-5);
  for (const int count : {1, 3}) {
    other_x = start, other_v = still;
    run_emulated<model, Functor<Space, model>>(p, count, {2, 1, 4}, other_x, other_v);
    EXPECT_LE(distance(x, other_x), rounding * 1e-13) << count << " patches";
    EXPECT_LE(distance(v, other_v), rounding * 1e-11) << count << " patches";
  }
}

TEST(FabricPatches, MatchTheStepsOfTheOtherDrivers) {
  expect_the_same_steps<ConstitutiveModel{Model::biquadratic}, Rings>();
  expect_the_same_steps<ConstitutiveModel{Model::biquadratic}, Pairs>();
  expect_the_same_steps<ConstitutiveModel{Model::edge}, Rings>();
  expect_the_same_steps<ConstitutiveModel{Model::edge}, Pairs>();
}

/// Timed loads and follower pressures of `p` in the Views of the persistent driver.
PersistentLoads<Space, true> loads_of(const Parameters& p) {
  PersistentLoads<Space, true> loads{{}, {0, p.dt, 0, 0.0}};
  External<Space>& external = loads.external;
  const std::size_t n = p.mass.size();
  external.rest = PointsView<Space>("rest", n);
  external.direction = decltype(external.direction)("direction", n, p.timed_loads.size());
  external.weight = decltype(external.weight)("weight", n, p.follower_pressures.size());
  external.load = decltype(external.load)("load", p.timed_loads.size());
  external.pressure = decltype(external.pressure)("pressure", p.follower_pressures.size());
  for (std::size_t k = 0; k < p.timed_loads.size(); ++k) external.load(k) = p.timed_loads[k].strength;
  for (std::size_t k = 0; k < p.follower_pressures.size(); ++k)
    external.pressure(k) = p.follower_pressures[k].strength;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      external.rest(i, axis) = p.mesh.rest[i][axis];
      for (std::size_t k = 0; k < p.timed_loads.size(); ++k)
        external.direction(i, k, axis) = p.timed_loads[k].direction[i][axis];
    }
    for (std::size_t k = 0; k < p.follower_pressures.size(); ++k) external.weight(i, k) = 1.0;
  }
  return loads;
}

template <ConstitutiveModel model>
void expect_the_same_steps_under_loads() {
  using testing::postfix;
  Parameters p = cloth_of(mesh_of(11, 8));
  p.material.model = model.model;
  p.timed_loads = {{postfix({"x", "t", 900.0, "*", "+", "sin"}),
                    shaken(std::vector<Vector>(p.mass.size(), Vector{}), 0.5, 5)}};
  p.follower_pressures = {{postfix({"t", 2e3, "*", 1.0, "+"}), {}}};
  const std::vector<Vector> start = shaken(p.mesh.rest, 0.1, 1), still(p.mass.size(), Vector{});
  std::vector<Vector> x = start, v = still;
  const auto solver = create_solver(device::Backend::serial, p);
  solver->upload(x, v);
  ASSERT_TRUE(solver->enqueue_steps(7));
  solver->download(x, v);
  for (const int count : {1, 3}) {
    std::vector<Vector> other_x = start, other_v = still;
    run_emulated<model, PersistentRingsFunctor<Space, model, NoVertexForce, true>>(
        p, count, {2, 1, 4}, other_x, other_v, NoVertexForce{}, loads_of(p));
    EXPECT_LE(distance(x, other_x), rounding * 1e-13) << count << " patches";
    EXPECT_LE(distance(v, other_v), rounding * 1e-11) << count << " patches";
  }
}

TEST(FabricPatches, ApplyTimedLoadsAndPressures) {
  expect_the_same_steps_under_loads<ConstitutiveModel{Model::biquadratic}>();
  expect_the_same_steps_under_loads<ConstitutiveModel{Model::edge}>();
}

/// Force that depends on position, velocity and time.
struct Spring {
  PointsView<Space> rest;

  KOKKOS_FUNCTION Vector3<double> operator()(const VertexStage& at) const {
    const Vector3<double> pull =
        3.0 * (load_points<double>(rest, at.vertex) - at.position) - 0.5 * at.velocity;
    return pull + Vector3<double>{0.0, 50.0 * at.time, 0.0};
  }
};

template <template <class, ConstitutiveModel, class> class Functor>
void expect_the_same_steps_under_a_vertex_force() {
  constexpr ConstitutiveModel model{Model::biquadratic};
  Parameters p = cloth_of(mesh_of(11, 8));
  const std::vector<Vector> start = shaken(p.mesh.rest, 0.1, 1), still(p.mass.size(), Vector{});
  std::vector<Vector> x = start, v = still;
  const Spring spring{loads_of(p).external.rest};
  const device::Instance<Space> instance(1);
  FabricSolver<Space, Spring> solver(instance, p, spring);
  solver.upload(x, v);
  solver.enqueue_steps(7);
  solver.download(x, v);
  for (const int count : {1, 3}) {
    std::vector<Vector> other_x = start, other_v = still;
    run_emulated<model, Functor<Space, model, Spring>>(p, count, {2, 1, 4}, other_x, other_v, spring);
    EXPECT_LE(distance(x, other_x), rounding * 1e-13) << count << " patches";
    EXPECT_LE(distance(v, other_v), rounding * 1e-11) << count << " patches";
  }
}

template <class ExecutionSpace, ConstitutiveModel model, class VertexForce>
using ForcedRings = PersistentRingsFunctor<ExecutionSpace, model, VertexForce>;

TEST(FabricPatches, ApplyAVertexForce) {
  expect_the_same_steps_under_a_vertex_force<ForcedRings>();
  expect_the_same_steps_under_a_vertex_force<PersistentPairsFunctor>();
}

/// Relaxation of the velocity that depends on position, velocity and time, with a state of its own.
struct Relaxing {
  PointsView<Space> rest;
  ListView<Space, double> taken;

  KOKKOS_FUNCTION Vector3<double> relaxed_velocity(const VertexStage& at) const {
    const Vector3<double> from_rest = at.position - load_points<double>(rest, at.vertex);
    taken(at.vertex) += at.inverse_mass * at.velocity.z * at.dt;
    return (1.0 / (1.0 + 400.0 * at.dt)) * at.velocity +
           Vector3<double>{taken(at.vertex), 30.0 * at.time, -20.0 * at.dt * from_rest.y};
  }
};

template <ConstitutiveModel model>
void expect_the_same_relaxed_steps() {
  Mesh mesh = mesh_of(11, 8);
  for (int i = 5; i < 75; i += 2)
    mesh.lines.push_back({i, 4});  // more lines at a vertex than warps in a team
  mesh.line_stiffness.assign(mesh.lines.size(), 300.0);
  Parameters p = cloth_of(mesh);
  p.integrator = Integrator::symplectic_euler;
  p.material.model = model.model, p.material.tension_only = model.tension_only;
  const std::size_t n = p.mass.size();
  const std::vector<Vector> start = shaken(p.mesh.rest, 0.1, 1), still(n, Vector{});
  std::vector<Vector> x = start, v = still;
  const auto relaxing = [&] {
    return Relaxing{loads_of(p).external.rest, ListView<Space, double>("taken", n)};
  };
  const Relaxing used = relaxing();
  const device::Instance<Space> instance(1);
  FabricSolver<Space, Relaxing> solver(instance, p, used);
  solver.upload(x, v);
  solver.enqueue_steps(9);
  solver.download(x, v);
  for (const int count : {1, 3}) {
    const Relaxing other = relaxing();
    std::vector<Vector> other_x = start, other_v = still;
    run_emulated<model, PersistentEulerFunctor<Space, model, Relaxing>>(p, count, {3, 2, 4}, other_x, other_v,
                                                                        other);
    EXPECT_LE(distance(x, other_x), rounding * 1e-13) << count << " patches";
    EXPECT_LE(distance(v, other_v), rounding * 1e-11) << count << " patches";
    for (std::size_t i = 0; i < n; ++i) EXPECT_NEAR(used.taken(i), other.taken(i), rounding * 1e-13);
  }
}

TEST(FabricPatches, RelaxVelocitiesInStepsOfTheSymplecticEulerMethod) {
  expect_the_same_relaxed_steps<ConstitutiveModel{Model::biquadratic}>();
  expect_the_same_relaxed_steps<ConstitutiveModel{Model::biquadratic, true}>();
  expect_the_same_relaxed_steps<ConstitutiveModel{Model::edge}>();
}

}  // namespace
}  // namespace drogue::fabric
