#pragma once

#include <array>
#include <string>
#include <vector>

#include "kernels/flow/solver.hpp"
#include "perf/measure/measurement.hpp"

/// Benchmark problems of flow steps: vortices of Taylor and Green of wave length 2 pi m in cubic cells, in SI
/// units, at a Reynolds number of 1600. Functions throw only what the solver throws.
namespace drogue::perf::flow_box {

/// Periodic box; the largest speed of the vortices is 1 m/s.
flow::Parameters periodic(const std::array<int, 3>& cells);

/// Inflow of 1 m/s through z low, outflow at z high, slip sides; the vortices have 0.3 m/s.
flow::Parameters through(const std::array<int, 3>& cells);

/// Number of cells, and their numbers per axis as in "64x64x64". Do not throw.
std::int64_t cell_count(const flow::Parameters& p);
std::string grid_name(const flow::Parameters& p);

/// Velocity components on their faces at the start, m/s.
using Velocity = std::array<std::vector<double>, 3>;
Velocity start(const flow::Parameters& p);

/// Sample of `count` steps after two untimed ones from the initial state: the first step of AB2 has no
/// predecessor, and a captured graph is made in it. `solver`, made for `p`, must outlive the sample.
/// Blocking.
Sample steps(const flow::Parameters& p, flow::Solver& solver, long count);

/// RMS of the divergence, 1/s; infinite after a failed step, or if the kinetic energy is not between half
/// and 1.5 times that of the start. Blocking.
double divergence(const flow::Parameters& p, flow::Solver& solver);

/// Tolerance of the divergence, 1/s. A velocity before its projection has 1e-3 1/s or more.
inline constexpr double tolerance = 1e-10;

}  // namespace drogue::perf::flow_box
