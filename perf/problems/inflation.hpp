#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <memory_resource>
#include <optional>
#include <vector>

#include "kernels/coupling/sheet/solver.hpp"
#include "perf/measure/measurement.hpp"

/// Benchmark problem of cloth in air: a C-9 parachute opens from its flat cloth in a stream of 10 m/s, its
/// payload fixed, in a box of 12 m by 12 m by 24 m with slip sides. Functions throw only what the solver
/// throws, unless stated otherwise.
namespace drogue::perf::inflation {

/// Discretization of the problem.
struct Discretization {
  std::array<int, 3> cells{};
  flow::TimeScheme time_scheme = flow::TimeScheme::ab2;
  double cfl = 0.25;
  double edge = 0.7;  ///< longest edges of the cloth over the length of a cell along x, at most 1 / 1.4
  coupling::DeltaKernel kernel = coupling::DeltaKernel::cbs43;
  bool with_contact = false;
};

/// Parameters of a solver, and the cloth at the start.
struct Problem {
  coupling::Parameters parameters;
  std::vector<fabric::Vector> positions;  ///< of the vertices, m
};
Problem problem(const Discretization& discretization);

/// Sample of `milliseconds` of flight after `lead` seconds. Each sample begins from the same state; the first
/// reset computes it. `solver`, made for the problem, must outlive the sample. The work throws
/// Failure(numerical_failure) after a failed step.
Sample flight(const Problem& problem, coupling::Solver& solver, double lead, long milliseconds);

/// Sample of `steps` steps of the flow between two copies of the whole state: to the device, and back. The
/// arrays of the flow, nearly all of it, are in `memory`. Each sample begins from the same state, after
/// `lead` seconds, which the first reset computes. Its parts are h2d, compute and d2h. `solver`, made for the
/// problem, must outlive the sample. The work throws Failure(numerical_failure) after a failed step.
Sample copied_steps(const Problem& problem, coupling::Solver& solver, double lead, long steps,
                    const std::shared_ptr<std::pmr::memory_resource>& memory);

/// Momentum that the canopy gives the air along the stream while it opens.
struct Opening {
  double impulse = 0.0;    ///< N s, to the end
  double half_time = 0.0;  ///< s, at which half of it is given
  double seconds = 0.0;    ///< duration of the computation, s
  std::int64_t steps = 0;  ///< of the flow
};

/// Flies to `end_time`, s, and integrates the force at fifty equal intervals by the trapezoidal rule. Returns
/// nothing after a signal. Throws Failure(numerical_failure) after a failed step.
std::optional<Opening> opening(const Problem& problem, coupling::Solver& solver, double end_time);

/// The larger one of the root-mean-square divergence times spacing over the largest speed, and the difference
/// of the force on the air from minus that on the cloth over the sum of the magnitudes.
double imbalance(const coupling::Parameters& p, coupling::Solver& solver);

}  // namespace drogue::perf::inflation
