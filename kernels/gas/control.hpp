#pragma once

#include <cstdint>

#include <Kokkos_Core.hpp>

#include "kernels/gas/stage_table.hpp"
#include "kernels/gas/status.hpp"

namespace drogue::gas {

inline constexpr int limited_steps = 100;  ///< accepted steps for which `automatic` keeps the limiter on
inline constexpr int max_halvings = 40;
inline constexpr std::uint64_t no_cell = ~std::uint64_t{0};

/// A cell that a stage left inadmissible, as a number that is least for the first stage and its leftmost
/// cell: what later stages find is a consequence.
KOKKOS_INLINE_FUNCTION std::uint64_t inadmissible(int stage, std::int64_t cell, Quantity what) {
  return static_cast<std::uint64_t>(stage) << 60U | static_cast<std::uint64_t>(cell) << 2U |
         static_cast<std::uint64_t>(what);
}
KOKKOS_INLINE_FUNCTION std::int64_t inadmissible_cell(std::uint64_t bad) {
  return bad == no_cell ? -1 : static_cast<std::int64_t>(bad << 4U >> 6U);
}

/// The step under way, and where the stepping is to stop.
struct Attempt {
  double dt;                ///< s
  double target;            ///< s, the next time to stop at
  std::int64_t pause_step;  ///< the next step to stop at for the host
  std::int64_t row_step;    ///< the next step to stop at for a row of the history
  int reaches_target;       ///< this attempt ends at `target`
  Stop stop;
  std::int64_t rows;      ///< history rows written
  std::int64_t launches;  ///< kernels that have reported to the host
};

/// What the stages of an attempt gather for the decision whether it stands.
struct Outcome {
  std::uint64_t stage_speed[max_stages + 1][3];  ///< bits of max |u-c|, |u|, |u+c| after each stage
  double boundary_flux[max_stages][2][3];
  std::uint64_t bad;     ///< least `inadmissible`
  std::int64_t touches;  ///< faces limited
};

/// What a step needs beside the fields. It lives on the device, is written by kernels alone, and makes every
/// decision that would otherwise need the host: the next dt, whether a step stands, when to stop.
struct Control {
  Resume resume;  ///< all that a restart must bring back
  Attempt attempt;
  Outcome outcome;
  Failed failed;
};

/// A team's own control block, where the teams of a persistent kernel decide for themselves.
struct Judgement {
  Resume resume;
  Attempt attempt;
  Failed failed;
  Outcome outcome;  ///< of its own cells
  bool ends;        ///< the launch
};

/// Constants of a run that the step's kernels read.
struct StepConstants {
  double gamma, dx, cfl, limited_cfl, fixed_dt;
  std::int64_t cells, max_steps;
  int ramp_steps;
  int positivity;  ///< Positivity as an integer
};

KOKKOS_INLINE_FUNCTION double max_speed(const std::uint64_t (&bits)[3]) {
  const double slow = Kokkos::bit_cast<double>(bits[0]), fast = Kokkos::bit_cast<double>(bits[2]);
  return slow > fast ? slow : fast;
}

}  // namespace drogue::gas
