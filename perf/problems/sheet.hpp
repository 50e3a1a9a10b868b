#pragma once

#include <memory>
#include <vector>

#include "kernels/fabric/solver.hpp"
#include "perf/measure/measurement.hpp"

/// Benchmark problem of fabric steps: a square sheet of nearly equilateral triangles, 1 m long, stretched by
/// 2 % and pinned along its edges. It oscillates under gravity like a drum.
namespace drogue::perf::sheet {

/// Mesh of about `vertices` vertices in the order of the mini-app, with masses and material. Throws
/// std::invalid_argument for too few vertices.
fabric::Parameters square(int vertices);

/// The square with gravity and pins. Throws as `square`.
fabric::Parameters parameters(int vertices);

/// State of all vertices.
struct State {
  std::vector<fabric::Vector> x, v;  ///< positions, m; velocities, m/s
};

/// Initial state. Does not throw.
State start(const fabric::Parameters& p);

/// Half of the largest stable time step in the initial state, s. Overwrites the state of `solver`. Blocking.
double default_dt(const fabric::Parameters& p, fabric::Solver& solver);

/// Parameters of a case, whose mesh may be large: its functions share them.
using Shared = std::shared_ptr<const fabric::Parameters>;

/// `count` steps of `solver`, made for `p`, from a state with the time step `dt`, s. Without an error.
/// Blocking.
Sample steps_from(const State& start, const std::shared_ptr<fabric::Solver>& solver, double dt, long count);

/// `count` steps of `solver`, made for `p`, from the initial state. The error is `energy_drift`. Blocking.
Sample steps(const Shared& p, const std::shared_ptr<fabric::Solver>& solver, long count);

/// Change of the total energy since the initial state, relative to the initial kinetic energy. Undamped
/// motion conserves energy. Blocking.
double energy_drift(const fabric::Parameters& p, fabric::Solver& solver);

/// Energy drift of a state on the host.
double energy_drift(const fabric::Parameters& p, const State& state);

/// Tolerance of the energy drift on a mesh of a case: four to five times the largest of
/// docs/evidence/springs-step-h200.jsonl and springs-step-xeon-2.jsonl. Verlet's method, of second order,
/// exceeds that of the Runge-Kutta method on meshes of up to 100 000 vertices; on larger ones both leave the
/// round-off of the energies.
double tolerance(fabric::Integrator integrator, int vertices);

}  // namespace drogue::perf::sheet
