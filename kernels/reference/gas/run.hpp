#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "kernels/gas/parameters.hpp"
#include "kernels/reference/gas/euler.hpp"

namespace drogue::reference {

/// State and counters of a run.
struct GasRun {
  std::vector<Conserved> state;  ///< n cells, left to right
  double time = 0.0;             ///< s
  std::int64_t steps = 0;
  std::int64_t redone_steps = 0;        ///< trials repeated with half the dt or with the limiter
  std::int64_t limited_faces = 0;       ///< summed over the stages of accepted steps
  std::int64_t limited_steps_left = 0;  ///< of positivity automatic
  bool failed =
      false;  ///< density or pressure not positive, or max_steps reached; `state` is the last admissible one
};

/// Centre of cell i, m. Does not throw.
[[nodiscard]] double cell_centre(const gas::Parameters& parameters, std::size_t i);

/// Initial state, sampled at the cell centres (m). Throws `std::bad_alloc`.
[[nodiscard]] GasRun start_run(const gas::Parameters& parameters,
                               const std::function<Primitive(double)>& initial);

/// Steps until `end_time` (s) and shortens the last step to meet it. Sets `failed` and returns early on
/// failure. Throws `std::bad_alloc`.
void advance(GasRun& run, const gas::Parameters& parameters, double end_time);

/// Complete run to `end_time`, s. Meets each of `output_times`, s, exactly, as a run with output does. Throws
/// `std::bad_alloc`.
[[nodiscard]] GasRun reference_run(const gas::Parameters& parameters,
                                   const std::function<Primitive(double)>& initial, double end_time,
                                   std::span<const double> output_times = {});

/// Discrete L1 error of the density, sum |rho - exact(x)| dx over the cell centres, kg/m^2. Does not throw.
[[nodiscard]] double l1_density(const GasRun& run, const gas::Parameters& parameters,
                                const std::function<double(double)>& exact);

}  // namespace drogue::reference
