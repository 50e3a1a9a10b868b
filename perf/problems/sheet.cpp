#include "perf/problems/sheet.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernels/fabric/elastic/lumped_mass.hpp"
#include "kernels/mesh/generators.hpp"
#include "kernels/mesh/renumbering.hpp"
#include "kernels/reference/fabric/membrane.hpp"
#include "kernels/reference/fabric/totals.hpp"

namespace drogue::perf::sheet {

using fabric::Vector;

fabric::Parameters square(int vertices) {
  const fabric::Mesh mesh = mesh::generate(mesh::Strip{1.0, 1.0, vertices});
  fabric::Parameters p;
  p.mesh = mesh::renumber(mesh, mesh::reverse_cuthill_mckee(mesh));
  p.mass = fabric::lumped_masses(p.mesh, 0.1, 0.0, fabric::Lumping::area);
  p.dt = 1.0;
  return p;
}

fabric::Parameters parameters(int vertices) {
  fabric::Parameters p = square(vertices);
  p.gravity = {0.0, 0.0, -9.81};
  double length = 0.0, width = 0.0;
  for (const Vector& at : p.mesh.rest) length = std::max(length, at[0]), width = std::max(width, at[1]);
  for (const Vector& at : p.mesh.rest) {
    const bool edge = at[0] == 0.0 || at[0] == length || at[1] == 0.0 || at[1] == width;
    p.pinned.push_back(edge ? 7 : 0);
  }
  return p;
}

State start(const fabric::Parameters& p) {
  State state;
  for (std::size_t i = 0; i < p.mesh.rest.size(); ++i) {
    const Vector& at = p.mesh.rest[i];
    state.x.push_back({1.02 * at[0], 1.02 * at[1], 0.0});
    const double speed = std::sin(std::numbers::pi * at[0]) * std::sin(std::numbers::pi * at[1]);
    state.v.push_back({0.0, 0.0, p.pinned[i] != 0 ? 0.0 : speed});
  }
  return state;
}

double tolerance(fabric::Integrator integrator, int vertices) {
  if (vertices > 100'000) return 5e-9;
  const bool small = vertices < 10'000;
  return integrator == fabric::Integrator::rk4 ? (small ? 1e-8 : 7e-10) : (small ? 5e-6 : 6e-7);
}

double default_dt(const fabric::Parameters& p, fabric::Solver& solver) {
  const State from = start(p);
  solver.upload(from.x, from.v);
  return 0.5 * fabric::stable_dt(p.integrator, solver.fastest_frequency(), solver.fastest_decay());
}

Sample steps_from(const State& start, const std::shared_ptr<fabric::Solver>& solver, double dt, long count) {
  solver->set_dt(dt);
  return {[=] { solver->upload(start.x, start.v); },
          [=] {
            solver->enqueue_steps(count);
            static_cast<void>(solver->failure());  // blocks until the steps are done
            return count;
          }};
}

Sample steps(const Shared& p, const std::shared_ptr<fabric::Solver>& solver, long count) {
  Sample sample = steps_from(start(*p), solver, default_dt(*p, *solver), count);
  sample.error = [=] { return energy_drift(*p, *solver); };
  return sample;
}

namespace {

double relative_to_start(const fabric::Parameters& p, double energy) {
  const State from = start(p);
  const reference::Sums sums = reference::sums(p.mass, p.gravity, {}, from.x, from.v);
  const double begin =
      static_cast<double>(sums.kinetic + sums.gravity) + reference::energy(p.material, p.mesh, from.x);
  return std::abs(energy - begin) / static_cast<double>(sums.kinetic);
}

}  // namespace

double energy_drift(const fabric::Parameters& p, fabric::Solver& solver) {
  return relative_to_start(p, solver.totals().energy());
}

double energy_drift(const fabric::Parameters& p, const State& state) {
  const reference::Sums sums = reference::sums(p.mass, p.gravity, {}, state.x, state.v);
  return relative_to_start(
      p, static_cast<double>(sums.kinetic + sums.gravity) + reference::energy(p.material, p.mesh, state.x));
}

}  // namespace drogue::perf::sheet
