#pragma once

#include <cstdint>

#include "kernels/gas/parameters.hpp"
#include "kernels/stepping/status.hpp"

namespace drogue::gas {

using stepping::Status;
using stepping::Stop;

/// Quantity that made a step inadmissible.
enum class FailureReason : int { density, pressure, not_finite, time_step };

using StepFailure = stepping::StepFailure<FailureReason>;

/// Progress of a run and counters of its adaptive step control.
struct Progress : stepping::AdaptiveTime {
  int current = 0;                 ///< index of the buffer that holds U^n
  int limited = 0;                 ///< 1 if the flux limiter is on
  int limited_left = 0;            ///< accepted steps until `automatic` turns the limiter off
  int halvings = 0;                ///< halvings of dt since the last accepted step
  double dt_scale = 1.0;           ///< 2^-halvings
  std::uint64_t speed[3] = {};     ///< bit patterns of max |u-c|, |u|, |u+c| of U^n, m/s
  std::int64_t redone = 0;         ///< rejected step trials
  std::int64_t limited_faces = 0;  ///< summed over all stages of the accepted steps
};

/// State of the step control that a restart file stores beside the fields.
struct RestartState : Progress {
  /// Time-integrated fluxes of mass, momentum and energy through the left and right end, per unit area
  double boundary[2][3] = {};
  double compensation[2][3] = {};
};

/// Row of the history: sums over the domain, SI units per unit area.
struct HistoryRow {
  double time = 0.0;
  std::int64_t step = 0;
  double dt = 0.0, mass = 0.0, momentum = 0.0, energy = 0.0;
  double boundary[3] = {};  ///< net outflow of mass, momentum and energy through both ends since the start
  double max_speed = 0.0;   ///< max |u| + c, m/s
  std::int64_t limited_faces = 0, redone = 0;
};

}  // namespace drogue::gas
