#pragma once

#include <cstdint>

#include "kernels/gas/parameters.hpp"

namespace drogue::gas {

/// Why a solver stopped stepping.
enum class Stop : int { running, target, pause, max_steps, failed, interrupted };

/// What went wrong in a cell, or with dt.
enum class Quantity : int { density, pressure, not_finite, time_step };

struct Failed {
  Quantity quantity = Quantity::density;
  std::int64_t cell = -1;  ///< -1: no single cell
  std::int64_t step = 0;   ///< the step that could not be taken, counted from 1
  double time = 0.0;       ///< s, where that step began
  double dt = 0.0;         ///< s
};

/// How far a run has come.
struct Progress {
  double time = 0.0;
  std::int64_t step = 0;
  int current = 0;              ///< buffer that holds U^n
  int limited = 0;              ///< the flux limiter is on
  int limited_left = 0;         ///< accepted steps until `automatic` turns it off again
  int halvings = 0;             ///< of dt since the last accepted step
  double dt_scale = 1.0;        ///< 2^-halvings
  std::uint64_t speed[3] = {};  ///< bits of max |u-c|, |u|, |u+c| of U^n
  std::int64_t redone = 0;      ///< rejected attempts
  std::int64_t touches = 0;     ///< faces limited in accepted steps, all stages
  double last_dt = 0.0, dt_min = 0.0, dt_max = 0.0;
};

/// The part of the device's control block that a restart file carries beside the fields.
struct Resume : Progress {
  double boundary[2][3] = {};  ///< time-integrated fluxes of mass, momentum, energy through the two ends
  double compensation[2][3] = {};
};

/// What the host sees of a running device, without a copy.
struct Status {
  std::int64_t launches = 0;  ///< kernels that have reported, whether they found something to do or not
  std::int64_t step = 0;
  double time = 0.0;
  double dt = 0.0;
  int limited = 0;
  Stop stop = Stop::running;
  std::int64_t rows = 0;
};

/// One row of the history, in SI units per unit area.
struct HistoryRow {
  double time = 0.0;
  std::int64_t step = 0;
  double dt = 0.0, mass = 0.0, momentum = 0.0, energy = 0.0;
  double boundary[3] = {};  ///< what has left through both ends so far
  double max_speed = 0.0;   ///< max |u| + c
  std::int64_t touches = 0, redone = 0;
};

}  // namespace drogue::gas
