#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "kernels/coupling/sheet/solver.hpp"
#include "perf/measure/measurement.hpp"
#include "perf/memory/memory.hpp"

/// Benchmark problems of cloth in air: a C-9 parachute opens in a stream of 10 m/s, its payload fixed, in a
/// box of 12 m by 12 m by 24 m with slip sides. Functions throw only what the solver throws, unless stated
/// otherwise.
namespace drogue::perf::inflation {

/// Discretization of a problem.
struct Discretization {
  std::array<int, 3> cells{};
  flow::TimeScheme time_scheme = flow::TimeScheme::ab2;
  double cfl = 0.25;
  double edge = 0.7;  ///< longest edges of the cloth over the length of a cell along x, at most 1 / 1.4
  coupling::DeltaFunction delta = coupling::DeltaFunction::cbs43;
  double edge_inset = 0.0;  ///< cells
  bool corrected = false;   ///< against leak, wide edges and late forces, as by default in drogue-parachute
  bool with_contact = false;
};

/// Parameters of a solver, and the cloth at the start.
struct Problem {
  coupling::Parameters parameters;
  std::vector<fabric::Vector> positions;  ///< of the vertices, m
};
/// From flat cloth of MIL-C-7020.
Problem problem(const Discretization& discretization);
/// From a cone that is nearly open, of cloth that lets 3.6 times as much air pass and hardly breathes.
Problem porous_problem(const Discretization& discretization);

/// `milliseconds` of flight by a solver on `backend` after `lead` seconds. Each sample begins from the same
/// state; the first reset computes it. The error is `imbalance`. The work throws Failure(numerical_failure)
/// after a failed step.
Sample flight(device::Backend backend, const Problem& problem, double lead, long milliseconds);

/// The same with `steps` steps of the flow between two copies of the whole state: to the device, and back.
/// The arrays of the flow, nearly all of it, are in `memory`. Its parts are h2d, compute and d2h.
Sample copied_steps(device::Backend backend, const Problem& problem, double lead, long steps,
                    HostMemory memory);

/// Tolerance of the imbalance.
inline constexpr double largest_imbalance = 1e-12;

/// Force of a canopy on the air against the stream.
struct Forces {
  double interval = 0.0;       ///< s
  std::vector<double> values;  ///< N, 0 at the start and then after each interval
  double seconds = 0.0;        ///< duration of the computation, s
  std::int64_t steps = 0;      ///< of the flow

  /// Momentum given to the air, N s, by the trapezoidal rule.
  [[nodiscard]] double impulse() const;
  /// Time, s, at which half of it is given.
  [[nodiscard]] double half_time() const;
  /// Mean of the second half of the time, N.
  [[nodiscard]] double late_mean() const;
};

/// Flies to `end_time`, s, in fifty equal intervals. Returns nothing after a signal. Throws
/// Failure(numerical_failure) after a failed step.
std::optional<Forces> forces(const Problem& problem, coupling::Solver& solver, double end_time);

/// The larger one of the root-mean-square divergence times spacing over the largest speed, and the difference
/// of the force on the air from minus that on the cloth over the sum of the magnitudes.
double imbalance(const coupling::Parameters& p, coupling::Solver& solver);

}  // namespace drogue::perf::inflation
