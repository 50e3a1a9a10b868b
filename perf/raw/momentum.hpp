#pragma once

#include <cstdint>

#include "perf/raw/stream.hpp"

namespace drogue::perf::raw {

/// Device-resident values that a momentum stage reads.
struct MomentumControl {
  double dt, last_dt;  ///< s
  int stopped;         ///< 1: the stage does nothing
};

/// Arguments of a momentum stage on a staggered grid in the layout of `flow::MacGrid`; SI units.
struct Momentum {
  int n[3];                    ///< cells per axis
  std::int64_t stride[3];      ///< of an array with ghost cells, in numbers
  std::int64_t component;      ///< numbers of one component
  std::int64_t first;          ///< offset of cell (0, 0, 0) in a component
  double inverse_h[3];         ///< 1/m
  const double* stage;         ///< m/s, with ghost cells filled
  double *out, *old_rate;      ///< m/s; m/s^2, rate of the step before, overwritten
  const double *force, *eddy;  ///< N/m^3 and m/s^2; may be null
  const MomentumControl* control;
  double nu, specific_volume;  ///< m^2/s; m^3/kg
  double acceleration[3];      ///< m/s^2
  double epsilon;              ///< of the nonlinear weights, m^2/s^2
  int planes;                  ///< that a thread treats
};

/// Enqueues a stage of the second-order Adams-Bashforth method with WENO-Z advection: the arithmetic, march
/// and threads of `flow::MomentumFunctor`. Asynchronous. Throws std::runtime_error if CUDA rejects the
/// launch.
void launch_momentum(const Momentum& momentum, Stream stream);

}  // namespace drogue::perf::raw
