#pragma once

#include <cstdint>

#include <Kokkos_Core.hpp>

#include "kernels/flow/state.hpp"
#include "kernels/stepping/failure_code.hpp"
#include "kernels/stepping/step_control.hpp"

namespace drogue::flow {

using stepping::no_failure;

/// Device-resident control block of a step. Only kernels write it during a run.
struct Control {
  Progress now;
  stepping::StepTrial trial;
  std::uint64_t next_rate;       ///< reduction of the state after the step, as `Progress::rate`
  std::uint64_t eddy_viscosity;  ///< bits of the largest one since the last step, m^2/s; 0 without a model
  /// Bits of the largest acceleration of each prescribed velocity component in the last step, in cells,
  /// 1/s^2.
  std::uint64_t side_acceleration[3];
  std::uint64_t first_failure;  ///< least cell whose predicted velocity is not finite, or `no_failure`
  int pressure_failed;          ///< 1 after an iterative pressure solver did not converge
  int failed_side;              ///< 1 + a side whose prescribed velocity is not finite; 0: none
  int is_unbalanced;            ///< 1 if `net_inflow` is more than round-off
  double pressure_residual;     ///< relative residual of the solve that did not converge
  double net_inflow;            ///< m^3/s, of velocities that change in time where no side is an outflow
  double inflow_magnitude;      ///< m^3/s, sum of the magnitudes of the parts of `net_inflow`

  /// True if the step must leave the state as it is. Does not throw.
  [[nodiscard]] KOKKOS_FUNCTION bool has_failed() const {
    return first_failure != no_failure || pressure_failed != 0 || failed_side != 0 || is_unbalanced != 0;
  }
};

/// 1 if a net inflow, m^3/s, is more than the round-off of parts with this sum of magnitudes, else 0.
KOKKOS_INLINE_FUNCTION int is_unbalanced(double net_inflow, double magnitude) {
  return Kokkos::fabs(net_inflow) > 1e-10 * magnitude ? 1 : 0;
}

/// Constants that determine dt.
struct StepConstants {
  double cfl, fixed_dt, max_dt;
  double diffusive_dt;  ///< s, bound of explicit diffusion; infinite without viscosity
  double eddy_weight;  ///< 1/m^2, by which an eddy viscosity adds to the rate of advection; 0 without a model
  double stable_cfl;   ///< largest CFL number of a fixed dt
  double damping_rate;  ///< 1/s, of implicit diffusion: nu / h^2 with the largest h; 0 if explicit
  std::int64_t max_steps;
};

/// Part of the limit of explicit diffusion that a variable dt may reach.
inline constexpr double diffusive_reserve = 0.9;

/// Largest dt of the next step that is stable, s; NaN if the velocity is not finite. Implicit diffusion damps
/// the waves that the explicit advection amplifies while rate^2 dt is at most twice `damping_rate`.
KOKKOS_INLINE_FUNCTION double stable_dt(const Progress& now, const StepConstants& k) {
  const double rate = Kokkos::bit_cast<double>(now.rate);
  if (!(rate >= 0.0)) return rate;  // NaN
  const double dt = 1.0 / (rate / k.stable_cfl + 1.0 / k.diffusive_dt);
  const double damped = 2.0 * k.damping_rate / (rate * rate);
  return damped > dt ? damped : dt;
}

/// Admissible dt of the next step, s. NaN or zero if there is none. Does not bound a fixed dt.
KOKKOS_INLINE_FUNCTION double admissible_dt(const Progress& now, const StepConstants& k) {
  if (k.fixed_dt > 0.0) return k.fixed_dt;
  const double rate = Kokkos::bit_cast<double>(now.rate);
  if (!(rate >= 0.0)) return rate;  // NaN
  // Advection and diffusion share the stability region: the sum of their rates limits dt. A tenth is kept in
  // reserve for the dissipation of upwind-biased fluxes.
  const double dt = 1.0 / (rate / k.cfl + 1.0 / (diffusive_reserve * k.diffusive_dt));
  return k.max_dt > 0.0 && !(dt < k.max_dt) ? k.max_dt : dt;
}

/// Rate that limits the next dt, as `Progress::rate`: that of advection, and that of an eddy viscosity. If
/// sides accelerate by a in cells, the sum over the components, r becomes r' with dt (r + a dt) = cfl for dt
/// = cfl / r'.
KOKKOS_INLINE_FUNCTION std::uint64_t limiting_rate(const Control& c, const StepConstants& k) {
  double rate =
      Kokkos::bit_cast<double>(c.next_rate) + k.eddy_weight * Kokkos::bit_cast<double>(c.eddy_viscosity);
  double acceleration = 0.0;
  for (const std::uint64_t bits : c.side_acceleration) acceleration += Kokkos::bit_cast<double>(bits);
  if (acceleration > 0.0 && !(k.fixed_dt > 0.0))
    rate = 0.5 * (rate + Kokkos::sqrt(rate * rate + 4.0 * acceleration * k.cfl));
  return Kokkos::bit_cast<std::uint64_t>(rate);
}

/// Prepares the next step, or stops the run if there is no admissible dt. A fixed dt that is not stable stops
/// the run too; dt of the next step is then the largest stable one. Two equal steps reach a target that
/// is between one and two steps away, so that no step is much shorter than its neighbours; a fixed dt may
/// grow by a billionth.
KOKKOS_INLINE_FUNCTION void prepare_step(const Progress& now, stepping::StepTrial& next,
                                         const StepConstants& k) {
  const double admissible = admissible_dt(now, k), left = next.target - now.time;
  double dt = admissible;
  if (left > admissible && left < (1.0 + 1e-9) * admissible)
    dt = left;
  else if (left > admissible && left < 2.0 * admissible && !(k.fixed_dt > 0.0))
    dt = 0.5 * left;
  if (!stepping::set_dt(now, next, dt, 1.0)) next.stop = Stop::failed;
  if (!(k.fixed_dt > 0.0)) return;
  const double largest = stable_dt(now, k);
  if (next.dt <= largest) return;
  next.dt = largest;
  next.stop = Stop::failed;
}

}  // namespace drogue::flow
