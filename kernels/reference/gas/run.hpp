#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "kernels/gas/parameters.hpp"
#include "kernels/reference/gas/euler.hpp"

namespace drogue::reference {

/// Where a run stands, and what it took to come there.
struct GasRun {
  std::vector<Conserved> state;  ///< n cells, left to right
  double time = 0.0;             ///< s
  std::int64_t steps = 0;
  std::int64_t redone_steps = 0;        ///< repeated with half the dt, or with the limiter
  std::int64_t limited_faces = 0;       ///< faces, summed over the stages of accepted steps
  std::int64_t limited_steps_left = 0;  ///< of positivity automatic
  bool failed =
      false;  ///< density or pressure not positive, or max_steps reached; `state` is the last good one
};

/// Centre of cell i [m].
[[nodiscard]] double cell_centre(const gas::Parameters& parameters, std::size_t i);

/// Initial state sampled at the cell centres.
[[nodiscard]] GasRun start_run(const gas::Parameters& parameters,
                               const std::function<Primitive(double)>& initial);

/// Steps until `end_time`, the last step shortened to meet it; returns early with `failed` set.
void advance(GasRun& run, const gas::Parameters& parameters, double end_time);

/// A whole run, through all `output_times` if given (each is met exactly, as a run that writes pictures
/// does).
[[nodiscard]] GasRun reference_run(const gas::Parameters& parameters,
                                   const std::function<Primitive(double)>& initial, double end_time,
                                   std::span<const double> output_times = {});

/// sum |rho - exact(x)| dx over the cell centres.
[[nodiscard]] double l1_density(const GasRun& run, const gas::Parameters& parameters,
                                const std::function<double(double)>& exact);

}  // namespace drogue::reference
