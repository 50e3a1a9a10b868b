#pragma once

#include <array>

#include "kernels/coupling/sheet/solver.hpp"
#include "perf/measure/measurement.hpp"

/// Benchmark problem of cloth in air: a C-9 parachute opens from its flat cloth in a stream of 10 m/s, its
/// payload held, in a box of 12 m by 12 m by 24 m with slip sides. Functions throw only what the solver
/// throws, unless stated otherwise.
namespace drogue::perf::inflation {

/// Parameters of a grid of `cells`, with AB2 and a Courant number of 0.25; edges of the cloth are at most 0.7
/// cells along x.
coupling::Parameters parameters(const std::array<int, 3>& cells, bool with_contact);

/// Sample of `milliseconds` of flight after `lead` seconds. Each sample begins from the same state; the first
/// reset computes it. `solver`, made for `p`, must outlive the sample. The work throws
/// Failure(numerical_failure) after a failed step.
Sample flight(const coupling::Parameters& p, coupling::Solver& solver, double lead, long milliseconds);

/// The larger one of the root-mean-square divergence times spacing over the largest speed, and the difference
/// of the force on the air from minus that on the cloth over the sum of the magnitudes.
double imbalance(const coupling::Parameters& p, coupling::Solver& solver);

}  // namespace drogue::perf::inflation
