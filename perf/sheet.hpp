#pragma once

#include <vector>

#include "kernels/fabric/solver.hpp"
#include "perf/measurement.hpp"

/// A square sheet of nearly equilateral triangles, 1 m long, stretched by 2 % and held all around: the one
/// that steps of fabric are timed on. It swings under gravity like a drum.
namespace drogue::perf::sheet {

/// About `vertices` of them, numbered as the mini-app does.
fabric::Parameters parameters(int vertices);

/// Positions and velocities of all vertices.
struct State {
  std::vector<fabric::Vector> x, v;
};
State start(const fabric::Parameters& p);

/// Half of the largest stable step from the start, s.
double usual_dt(const fabric::Parameters& p, fabric::Solver& solver);

/// `count` steps from the start. `solver`, made for `p`, must outlive the sample.
Sample steps(const fabric::Parameters& p, fabric::Solver& solver, long count);

/// How far the energy is from that of the start, over the kinetic energy there. Without damping steps keep
/// it.
double energy_drift(const fabric::Parameters& p, fabric::Solver& solver);

/// The same of a state that no solver holds.
double energy_drift(const fabric::Parameters& p, const State& state);

/// With room: a wrong step misses it by decades.
inline constexpr double tolerance = 1e-4;

}  // namespace drogue::perf::sheet
