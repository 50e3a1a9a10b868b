#pragma once

#include "kernels/flow/schemes.hpp"
#include "kernels/flow/views.hpp"

namespace drogue::flow {

/// Weights of a stage: W = S + state (U - S) + dt (rate L(S) + old_rate A), where A is the rate of the
/// previous step (Adams-Bashforth), or is not read. With U equal to S and no rates, W is S bit for bit.
struct StageWeights {
  double state, rate;
  bool adams_bashforth =
      false;  ///< replaces `rate` by 1 + r/2 and adds -r/2 A, r = dt / last dt; stores L(S) in A
};

/// Data of a momentum stage.
template <class ExecutionSpace>
struct MomentumSetup {
  MacGrid grid;
  List<ExecutionSpace> state;     ///< U, m/s, with ghost cells
  List<ExecutionSpace> stage;     ///< S, m/s, with ghost cells filled
  List<ExecutionSpace> out;       ///< W, m/s
  List<ExecutionSpace> old_rate;  ///< A, m/s^2
  List<ExecutionSpace> force;     ///< per volume, N/m^3; may be empty
  List<ExecutionSpace> eddy;      ///< acceleration by an eddy viscosity, m/s^2; may be empty
  ControlView<ExecutionSpace> control;
  double nu;               ///< kinematic viscosity, m^2/s
  double acceleration[3];  ///< m/s^2
  double specific_volume;  ///< 1/density, m^3/kg
  double epsilon;          ///< of the nonlinear weights, m^2/s^2
  int rows;                ///< of the tile of a team on a device
  StageWeights weights;
};

/// Coefficients of a stage after the step size is known.
struct StageFactors {
  double state, rate, old_rate;
  double force;  ///< of the force per volume, s m^3/kg
};

/// Coefficients of a stage for the dt of `control`, s. Does not throw.
template <class ExecutionSpace>
KOKKOS_INLINE_FUNCTION StageFactors stage_factors(const MomentumSetup<ExecutionSpace>& setup,
                                                  const Control& control) {
  const double dt = control.trial.dt;
  const StageWeights& w = setup.weights;
  // Forces of other kernels hold for the whole step and are not extrapolated.
  const double force = w.rate * dt * setup.specific_volume;
  if (!w.adams_bashforth) return {w.state, w.rate * dt, 0.0, force};
  const double half_ratio = control.now.last_dt > 0.0 ? 0.5 * dt / control.now.last_dt : 0.0;
  return {w.state, (1.0 + half_ratio) * dt, -half_ratio * dt, force};
}

/// Enqueues a momentum stage on a grid without stretched axes. Asynchronous. Compiled once for each backend.
/// Throws std::runtime_error for a team that does not fit the device.
template <class ExecutionSpace>
void dispatch_momentum(const ExecutionSpace& space, const MomentumSetup<ExecutionSpace>& setup,
                       Advection advection);

/// As `dispatch_momentum`, on a grid with stretched axes.
template <class ExecutionSpace>
void dispatch_stretched_momentum(const ExecutionSpace& space, const MomentumSetup<ExecutionSpace>& setup,
                                 Advection advection);

}  // namespace drogue::flow
