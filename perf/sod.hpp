#pragma once

#include <array>
#include <vector>

#include "kernels/gas/solver.hpp"
#include "kernels/reference/gas/euler.hpp"
#include "perf/measurement.hpp"

/// Sod's problem on [-1, 1], the one that gas steps are timed on.
namespace drogue::perf::sod {

/// Density, momentum and energy of all cells.
using Fields = std::array<std::vector<double>, 3>;

/// WENO5-JS, SSP-RK3, alpha over the stencil, without a limiter: what the yardstick does.
gas::Parameters parameters(std::int64_t cells);

reference::Primitive initial(double x);
double centre(const gas::Parameters& p, std::size_t i);
Fields start(const gas::Parameters& p);

/// `count` steps from the start. `solver`, made for `p`, must outlive the sample.
Sample steps(const gas::Parameters& p, gas::Solver& solver, long count);

/// L1 error of the density against the exact solution at `time` (s), per unit length.
double l1_error(const gas::Parameters& p, const std::vector<double>& rho, double time);
double l1_error(const gas::Parameters& p, gas::Solver& solver);

/// First-order convergence at the discontinuities, with room: a wrong step misses it by decades.
double tolerance(const gas::Parameters& p);

}  // namespace drogue::perf::sod
