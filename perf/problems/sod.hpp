#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "kernels/gas/solver.hpp"
#include "kernels/reference/gas/euler.hpp"
#include "perf/measure/measurement.hpp"

/// Benchmark problem of gas steps: Sod's shock tube on [-1, 1], in SI units. Functions throw only what the
/// solver throws.
namespace drogue::perf::sod {

/// Density, momentum and energy per volume of all cells; SI units.
using Fields = std::array<std::vector<double>, 3>;

/// WENO5-JS, SSP-RK3, alpha over the stencil and no limiter: the scheme of the dense reference loop.
gas::Parameters parameters(std::int64_t cells);

/// Initial state at x (m).
reference::Primitive initial(double x);

/// Centre of cell i, m.
double centre(const gas::Parameters& p, std::size_t i);

/// Initial state of all cells.
Fields start(const gas::Parameters& p);

/// `count` steps of `solver`, made for `p` on `backend`, from the initial state, which is kept in pinned
/// memory: pageable copies of a large one take longer than the steps. The error is `l1_error`. Blocking.
Sample steps(const gas::Parameters& p, device::Backend backend, const std::shared_ptr<gas::Solver>& solver,
             long count);

/// Steps of a sample of some milliseconds of the baseline solver; the waves stay away from the ends.
inline constexpr long baseline_steps = 20;

/// Case of `baseline_steps` steps by the baseline solver, whose parts are h2d, compute and d2h, or
/// `compute_alone`. Does not throw.
Case baseline_case(const std::string& name, const std::string& bound, device::Backend backend,
                   const gas::Parameters& parameters, bool compute_alone = false);

/// L1 error of the density (kg/m^3) against the exact solution at `time` (s), per unit length.
double l1_error(const gas::Parameters& p, const std::vector<double>& rho, double time);

/// L1 error of the density of `solver` at its time. Blocking.
double l1_error(const gas::Parameters& p, gas::Solver& solver);

/// Tolerance of the L1 error: first-order convergence at the discontinuities. A wrong step exceeds it by
/// orders of magnitude.
double tolerance(const gas::Parameters& p);

}  // namespace drogue::perf::sod
