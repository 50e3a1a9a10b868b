#pragma once

#include <cstdint>

#include <Kokkos_Core.hpp>

#include "kernels/gas/status.hpp"
#include "kernels/gas/stepping/stage_table.hpp"
#include "kernels/stepping/failure_code.hpp"
#include "kernels/stepping/step_control.hpp"

namespace drogue::gas {

/// Accepted steps for which `automatic` keeps the limiter on
inline constexpr int automatic_limited_steps = 100;
inline constexpr int max_halvings = 40;
using stepping::no_failure;

/// Encodes an inadmissible cell as an integer that is least for the first stage and, within it, the leftmost
/// cell. Later stages fail as a consequence of earlier ones.
KOKKOS_INLINE_FUNCTION std::uint64_t encode_inadmissible(int stage, std::int64_t cell, FailureReason reason) {
  return stepping::encode_failure(stage, cell << 2U | static_cast<std::int64_t>(reason));
}
KOKKOS_INLINE_FUNCTION std::int64_t inadmissible_cell(std::uint64_t first_inadmissible) {
  return first_inadmissible == no_failure ? -1 : stepping::failure_index(first_inadmissible) >> 2U;
}
KOKKOS_INLINE_FUNCTION FailureReason inadmissible_reason(std::uint64_t first_inadmissible) {
  return static_cast<FailureReason>(first_inadmissible & 3U);
}

using stepping::StepTrial;

/// Reductions of the stages of a step trial, which decide on its acceptance.
struct StageReduction {
  /// Bit patterns of max |u-c|, |u|, |u+c| after each stage, m/s
  std::uint64_t stage_speed[max_stages + 1][3];
  double boundary_flux[max_stages][2][3];
  std::uint64_t first_inadmissible;  ///< minimum of `encode_inadmissible`
  std::int64_t limited_faces;
};

/// Device-resident control block of a step. Only kernels write it during a run. It replaces every decision
/// that would otherwise involve the host: the next dt, acceptance of a step, and the stop.
struct Control {
  RestartState restart;  ///< state that a restart restores
  StepTrial trial;
  StageReduction reduction;
  StepFailure failure;
};

/// Control block of one team of a persistent kernel. Every team takes the same decisions from the same
/// numbers.
struct TeamControl {
  RestartState restart;
  StepTrial trial;
  StepFailure failure;
  StageReduction reduction;  ///< of the cells of this team
  bool ends_launch;          ///< true if the launch ends
};

/// Constants of a run that the step kernels read.
struct StepConstants {
  double gamma, dx, cfl, limited_cfl, fixed_dt;
  std::int64_t cells, max_steps;
  int ramp_steps;
  int positivity;  ///< `Positivity` as an integer
};

KOKKOS_INLINE_FUNCTION double max_speed(const std::uint64_t (&bits)[3]) {
  const double slow = Kokkos::bit_cast<double>(bits[0]), fast = Kokkos::bit_cast<double>(bits[2]);
  return slow > fast ? slow : fast;
}

}  // namespace drogue::gas
