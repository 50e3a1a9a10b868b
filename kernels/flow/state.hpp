#pragma once

#include <cstdint>

#include "kernels/stepping/status.hpp"

namespace drogue::flow {

using stepping::Poll;
using stepping::Status;
using stepping::Stop;

/// Reason why a step failed.
enum class FailureReason : int {
  not_finite,     ///< the predicted velocity is not finite, or its divergence exceeds 1e100 per second
  side_velocity,  ///< the prescribed velocity of a side, `StepFailure::index`, is not finite
  /// No admissible dt: dt would not change the time, or a fixed dt exceeds the largest stable one, which
  /// `StepFailure::dt` then holds.
  time_step,
  pressure_solver,  ///< an iterative pressure solver did not converge
  net_inflow,       ///< `StepFailure::net_inflow` enters through prescribed sides, but no side is an outflow
};

/// First failed step of a run.
struct StepFailure : stepping::StepFailure<FailureReason> {
  double net_inflow = 0.0;         ///< m^3/s
  double pressure_residual = 0.0;  ///< as `PressureSolve::residual`, of the solve that did not converge
};

/// Progress of a run. A restart that restores it and all arrays of `Solver::state` continues bit for bit.
struct Progress : stepping::AdaptiveTime {
  /// Bits of the maximum over the cells of |u|/hx + |v|/hy + |w|/hz, 1/s, without axes of one cell, plus the
  /// rate of the largest eddy viscosity; more if sides accelerate.
  std::uint64_t rate_bits = 0;
  std::uint64_t velocity_rate_bits = 0;  ///< bits of that maximum of the velocity alone, 1/s
  double longest_dt = 0.0;               ///< s, bound of the next dt by the steps so far; 0: none
};

/// Field at the cell centres that is computed from the state.
enum class CellField : int {
  velocity,     ///< 3 components, m/s, mean of the two faces
  vorticity,    ///< 3 components, 1/s, second order
  pressure,     ///< of the present velocity, Pa: density times kinematic pressure, mean zero if undetermined
  q_criterion,  ///< 1/s^2, half of (|rotation|^2 - |strain rate|^2), second order
};

/// Solve of the pressure equation by an iterative solver.
struct PressureSolve {
  int iterations = 0;
  double residual = 0.0;  ///< ratio of the 2-norms of the residual and the right-hand side
};

/// Sums over the domain. Along an axis with one cell, the domain has its given length.
struct Totals {
  std::int64_t step = 0;
  double time = 0.0, dt = 0.0;                        ///< s; dt of the next step
  double kinetic_energy = 0.0;                        ///< J
  double enstrophy = 0.0;                             ///< half the integral of the squared vorticity, m^3/s^2
  double dissipation = 0.0;                           ///< viscous dissipation, W
  double momentum[3] = {};                            ///< kg m/s
  double max_speed = 0.0;                             ///< m/s, at cell centres
  double divergence_rms = 0.0, divergence_max = 0.0;  ///< 1/s
  /// Flow rate out of the domain through each side, m^3/s: x low, x high, y low, y high, z low, z high; 0 on
  /// periodic sides.
  double outflow[6] = {};
};

/// Extremes of kinetic energy and speed over all steps since the start.
struct Extremes {
  std::int64_t step = -1;         ///< last one that counts; -1: none
  double time = 0.0;              ///< s, of it
  double energy = 0.0;            ///< J, of it
  double least_energy = 0.0;      ///< J
  double largest_rise = 0.0;      ///< J, of the energy above its least value before
  double largest_speed = 0.0;     ///< m/s, at cell centres
  double peak_dissipation = 0.0;  ///< W, largest rate at which the energy fell in a step
  double peak_time = 0.0;         ///< s, in the middle of that step
};

}  // namespace drogue::flow
