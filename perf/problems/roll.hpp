#pragma once

#include "perf/problems/sheet.hpp"

/// Benchmark problem of contact steps: a square sheet of nearly equilateral triangles, 1 m long, rolled up
/// tightly. The distance between layers is the contact thickness, a fixed fraction of the edge length, so
/// that the share of vertices in contact does not depend on the mesh. Waves along the roll press neighbouring
/// layers against each other, on both sides of every vertex.
namespace drogue::perf::roll {

/// Mesh of about `vertices` vertices in the order of the mini-app, with material and contact. Throws
/// std::invalid_argument for too few vertices.
fabric::Parameters parameters(int vertices);

/// Initial state: positions on Archimedes' spiral, m, and radial velocities, m/s. Does not throw.
sheet::State start(const fabric::Parameters& p);

/// Half of the largest stable time step in the initial state, s, limited so that no vertex moves by more than
/// a tenth of an edge. Overwrites the state of `solver`. Blocking.
double default_dt(const fabric::Parameters& p, fabric::Solver& solver);

/// `count` steps of `solver`, made for `p`, from the initial state. The error is `imbalance`. Blocking.
Sample steps(const sheet::Shared& p, const std::shared_ptr<fabric::Solver>& solver, long count);

/// Change of the total energy less the work of contact, relative to the initial kinetic energy. Infinite
/// after a failed step, without any contact, or if the exact checker finds intersecting triangles. The
/// checker runs on meshes of up to `most_checked` vertices only, because it takes minutes for larger ones.
/// Blocking.
double imbalance(const fabric::Parameters& p, fabric::Solver& solver);
inline constexpr std::size_t most_checked = 30'000;

/// Tolerance of the imbalance, an error of friction and time step: five times the largest of
/// docs/evidence/springs-contact-h200.jsonl on that mesh, and of springs-contact/serial/640, the mesh of
/// quick runs.
constexpr double tolerance(int vertices) {
  return vertices < 10'000 ? 2e-2 : vertices < 100'000 ? 3e-4 : 3e-5;
}

}  // namespace drogue::perf::roll
