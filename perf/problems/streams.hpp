#pragma once

#include <array>
#include <memory>
#include <string>

#include "kernels/flow/solver.hpp"
#include "kernels/linear/poisson/problem.hpp"
#include "perf/measure/measurement.hpp"

/// Benchmark problems of flow, in SI units. Functions throw only what the solver throws,
/// unless stated otherwise.
namespace drogue::perf::streams {

/// Sides of the domain.
enum class Sides {
  periodic,  ///< vortices of Taylor and Green in a cube of 2 pi m at a Reynolds number of 1600
  walls,     ///< the same vortices between walls
  tunnel,    ///< inflow and outflow along z at 1 m/s, slip sides, with vortices in the stream
};

/// "periodic", "walls" or "tunnel". Does not throw.
const char* name(Sides sides);

/// Cells per axis as in "64x64x64".
std::string text(const std::array<int, 3>& cells);

/// Parameters with WENO-Z and AB2.
flow::Parameters parameters(const std::array<int, 3>& cells, Sides sides);

/// Pressure equation of a grid of unit spacing.
linear::PoissonProblem pressure_problem(const std::array<int, 3>& cells, Sides sides);

/// `count` steps of `solver`, made for `p`. The first sample begins from the initial state, later ones where
/// the one before ended: the work of a step does not depend on the flow. The error is `relative_divergence`.
/// The work throws Failure(numerical_failure) after a failed step.
Sample steps(const flow::Parameters& p, const std::shared_ptr<flow::Solver>& solver, long count);

/// Tolerance of the divergence: a wrong projection leaves one of order one.
inline constexpr double divergence_tolerance = 1e-12;

/// Root-mean-square divergence of the present state times spacing over the largest speed.
double relative_divergence(const flow::Parameters& p, flow::Solver& solver);

/// Root-mean-square error of the velocity after `count` steps, over that of its change, of a flow with an
/// exact solution: drifting vortices of Taylor and Green in the periodic cube, a vortex that the stream
/// carries in the tunnel. Overwrites the state of `solver`, which is made for `p` without walls and without a
/// turbulence model. Throws Failure(numerical_failure) after a failed step. Blocking.
double exact_error(const flow::Parameters& p, flow::Solver& solver, long count);

}  // namespace drogue::perf::streams
