#pragma once

#include "perf/ladders/ladder.hpp"
#include "perf/models/gas_step.hpp"
#include "perf/problems/sod.hpp"

namespace drogue::perf::ladder {

/// Problem of the WENO ladder: steps of one size of Sod's shock tube by WENO5-JS and SSP-RK3.
struct WenoProblem {
  /// Largest error of a rung: rounding of some thousand operations per value.
  static constexpr double tolerance = 1e-12;

  gas::Parameters parameters;  ///< with `fixed_dt`, without a limiter
  long steps;
  sod::Fields start;     ///< initial state, SI units
  sod::Fields expected;  ///< state after the steps, by kernels/reference/gas

  [[nodiscard]] std::int64_t cells() const { return parameters.cells; }
  [[nodiscard]] double gamma() const { return parameters.gamma; }
  [[nodiscard]] double dt_over_dx() const;  ///< s/m
};

/// `cells` is a multiple of the cells of a tile. Takes a second for half a million cells times steps. Throws
/// std::bad_alloc.
[[nodiscard]] WenoProblem make_weno_problem(std::int64_t cells, long steps);

/// Largest difference of a field of `got` from the expected state, over the largest value of the field.
/// Infinite for values that are not finite. Does not throw.
[[nodiscard]] double difference(const WenoProblem& problem, const sod::Fields& got);

/// Work per step of kernels that read the state and write fluxes or a state: three stages with `launches`
/// kernels each, `traffic` doubles per cell and stage between them and memory, and `face` operations per
/// face. Does not throw.
[[nodiscard]] Work stage_work(const WenoProblem& problem, double launches, double traffic,
                              const Arithmetic& face);

/// Work per step of the library's solver, which computes all stages of a tile in one kernel. Does not throw.
[[nodiscard]] Work library_work(const WenoProblem& problem, double launches);

}  // namespace drogue::perf::ladder
