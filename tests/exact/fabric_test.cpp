#include <gtest/gtest.h>

#include <string>

#include "kernels/device/runtime.hpp"
#include "kernels/fabric/solver.hpp"
#include "tests/support/cuda_device.hpp"
#include "tests/support/expression_program.hpp"
#include "tests/support/fabric_mesh.hpp"
#include "tests/support/fabric_sheets.hpp"
#include "tests/support/in_child.hpp"

// Bitwise equality of states and measurements of fabric on all backends and numbers of threads.

namespace drogue::fabric {
namespace {

using testing::in_child;
using testing::postfix;
using testing::random_patch;
using testing::runs_in_child;
using testing::shaken;

std::vector<Vector> random_vectors(std::size_t n, double size, unsigned seed) {
  return shaken(std::vector<Vector>(n, Vector{}), size, seed);
}

Parameters cloth(Model model, bool tension_only, Integrator integrator) {
  Parameters p;
  p.mesh = random_patch(50, 41, 3);
  p.mesh.rest.resize(50 * 41);
  p.mesh.lines = {{0, 49}, {3, 4}};
  p.mesh.line_stiffness = {300.0, 700.0};
  p.material.model = model;
  p.material.tension_only = tension_only;
  p.material.bending_stiffness = 0.01;
  for (std::size_t i = 0; i < p.mesh.rest.size(); ++i)
    p.mass.push_back(0.01 + 0.001 * static_cast<double>(i % 7));
  p.gravity = {0.5, -1.0, -9.81};
  p.damping = 0.3, p.relative_damping = 4.0;
  p.follower_pressures = {{postfix({30.0, "x", "t", "*", "sin", "+"}), {}}};
  p.timed_loads = {{postfix({"t", "exp"}), random_vectors(p.mass.size(), 0.1, 9)}};
  p.motions = {{2, {0, 5}, postfix({"t", 40.0, "*", "sin"})}};
  p.integrator = integrator;
  p.dt = 1e-4;
  return p;
}

template <class T>
void append(std::string& bytes, const std::vector<T>& values) {
  bytes.append(reinterpret_cast<const char*>(values.data()),
               values.size() * sizeof(T));  // NOLINT: compares bits
}

/// Parameters that the persistent driver supports, too.
Parameters plain_cloth(Model model, bool tension_only) {
  Parameters p = cloth(model, tension_only, Integrator::rk4);
  p.material.bending_stiffness = p.relative_damping = 0.0;
  p.follower_pressures.clear(), p.timed_loads.clear(), p.motions.clear();
  p.pinned.assign(p.mass.size(), 0), p.pinned[7] = 7, p.pinned[900] = 2;
  p.load = random_vectors(p.mass.size(), 0.1, 5);
  return p;
}

/// All results of a solver after 80 steps.
std::string run_bytes(device::Backend backend, int threads, const Parameters& p) {
  const device::Runtime runtime({"--kokkos-num-threads=" + std::to_string(threads)});
  const auto solver = create_solver(backend, p);
  const std::size_t n = p.mass.size();
  std::vector<Vector> x = shaken(p.mesh.rest, 0.1, 1), v = random_vectors(n, 1.0, 2), f(n);
  solver->upload(x, v);
  if (!solver->enqueue_steps(80) || solver->failure()) throw std::runtime_error("the state was lost");
  solver->download(x, v);
  solver->forces(f);
  std::vector<Stress> triangles(p.mesh.triangles.size()), vertices(n);
  solver->stress(StressMeasure::nominal, triangles);
  solver->vertex_stress(StressMeasure::cauchy, vertices);
  std::string bytes;
  for (const auto& values : {x, v, f}) append(bytes, values);
  append(bytes, triangles);
  append(bytes, vertices);
  append(bytes, std::vector<double>{solver->fastest_frequency(), solver->fastest_decay()});
  append(bytes, std::vector<Totals>{solver->totals()});
  return bytes;
}

TEST(ExactFabric, BackendsAndThreadsAgree) {
  for (const Model model : {Model::edge, Model::quadratic, Model::biquadratic})
    for (const bool tension_only : {false, true})
      for (const Integrator integrator : {Integrator::rk4, Integrator::verlet}) {
        const Parameters p = cloth(model, tension_only, integrator);
        const std::string serial = in_child([&] { return run_bytes(device::Backend::serial, 1, p); });
        ASSERT_GT(serial.size(), 9 * sizeof(double) * p.mass.size());
        for (const device::Backend backend : device::compiled_backends()) {
          if (backend == device::Backend::serial || !runs_in_child(backend)) continue;
          for (const int threads : {1, 3})
            EXPECT_TRUE(in_child([&] { return run_bytes(backend, threads, p); }) == serial)
                << name(backend) << ", " << threads << " threads, model " << static_cast<int>(model);
        }
      }
}

TEST(ExactFabric, DriversAgree) {
  for (const Model model : {Model::edge, Model::quadratic, Model::biquadratic})
    for (const bool tension_only : {false, true}) {
      Parameters p = plain_cloth(model, tension_only);
      const std::string serial = in_child([&] { return run_bytes(device::Backend::serial, 1, p); });
      for (const device::Backend backend : device::compiled_backends()) {
        if (backend == device::Backend::serial || !runs_in_child(backend)) continue;
        for (const Driver driver : {Driver::plain, Driver::graph, Driver::persistent})
          for (const int patch : {0, 200}) {
            p.driver = driver, p.patch = patch;
            EXPECT_TRUE(in_child([&] { return run_bytes(backend, 1, p); }) == serial)
                << name(backend) << ", driver " << static_cast<int>(driver) << ", patches of " << patch
                << ", model " << static_cast<int>(model);
            if (driver != Driver::persistent) break;
          }
      }
    }
}

/// State and contact work of sheets in contact.
std::string contact_bytes(device::Backend backend, int threads, testing::Sheets s) {
  const device::Runtime runtime({"--kokkos-num-threads=" + std::to_string(threads)});
  const auto solver = create_solver(backend, s.p);
  solver->upload(s.x, s.v);
  if (!solver->enqueue_steps(200) || solver->failure()) throw std::runtime_error("the state was lost");
  solver->download(s.x, s.v);
  std::vector<ContactWork> work(s.x.size());
  solver->contact_work(work);
  std::string bytes;
  for (const auto& values : {s.x, s.v}) append(bytes, values);
  append(bytes, work);
  append(bytes, std::vector<Totals>{solver->totals()});
  return bytes;
}

void expect_agreement_in_contact(const testing::Sheets& s) {
  const std::string serial = in_child([&] { return contact_bytes(device::Backend::serial, 1, s); });
  ASSERT_GT(serial.size(), 7 * sizeof(double) * s.p.mass.size());
  for (const device::Backend backend : device::compiled_backends()) {
    if (backend == device::Backend::serial || !runs_in_child(backend)) continue;
    for (const int threads : {1, 3})
      EXPECT_TRUE(in_child([&] { return contact_bytes(backend, threads, s); }) == serial)
          << name(backend) << ", " << threads << " threads";
  }
}

TEST(ExactFabric, BackendsAndThreadsAgreeInContact) {
  for (testing::Sheets s : {testing::impact(3.0), testing::edge_on(8.0), testing::folded(6.0)})
    for (const Integrator integrator : {Integrator::rk4, Integrator::verlet}) {
      s.p.integrator = integrator;
      Body sphere;
      sphere.kind = BodyKind::sphere, sphere.radius = 0.05, sphere.centre = {0.05, 0.05, -0.06};
      sphere.friction = 0.2;
      s.p.contact.bodies = {sphere};
      s.p.gravity = {0.0, 0.0, -9.81};
      expect_agreement_in_contact(s);
    }
}

TEST(ExactFabric, BackendsAndThreadsAgreeInContactOfIntervals) {
  for (testing::Sheets s : {testing::edge_on(8.0), testing::folded(6.0), testing::above_a_fan_of_lines()}) {
    s.p.integrator = Integrator::symplectic_euler;
    s.p.material.tension_only = true;
    s.p.contact.interval = 8;
    expect_agreement_in_contact(s);
  }
}

}  // namespace
}  // namespace drogue::fabric
