#pragma once

#include <cstdint>

#include <Kokkos_Core.hpp>

#include "kernels/device/relaxed_access.hpp"
#include "kernels/flow/state.hpp"
#include "kernels/stepping/failure_code.hpp"
#include "kernels/stepping/motion_steps.hpp"
#include "kernels/stepping/step_control.hpp"

namespace drogue::flow {

using stepping::no_failure;

/// Maxima of a step over the cells, of integers alone. Ranks agree on the largest of each.
struct StepMaxima {
  std::uint64_t next_rate_bits;  ///< of the state after the step, as `Progress::rate_bits`
  std::uint64_t eddy_viscosity;  ///< bits of the largest one since the last step, m^2/s; 0 without a model
  /// Bits of the largest acceleration of each prescribed velocity component in the last step, in cells,
  /// 1/s^2.
  std::uint64_t side_acceleration[3];
  // In a step of implicit diffusion:
  std::uint64_t viscous_acceleration;  ///< bits of the largest one at its beginning, m/s^2
  std::uint64_t change;                ///< bits of the largest change of the predicted velocity, m/s
  /// Range of each velocity component at its beginning, sides included: `ordered_bits` of the largest value,
  /// and of minus the least one; 0: no value.
  std::uint64_t highest[3], lowest[3];
};

/// Device-resident control block of a step. Only kernels write it during a run.
struct Control : StepMaxima {
  Progress now;
  stepping::StepTrial trial;
  std::uint64_t first_failure;  ///< least cell whose predicted velocity is not finite, or `no_failure`
  int pressure_failed;          ///< 1 after an iterative pressure solver did not converge
  int failed_side;              ///< 1 + a side whose prescribed velocity is not finite; 0: none
  int is_unbalanced;            ///< 1 if `net_inflow` is more than round-off
  int interrupted;              ///< 1 if a rank of several has asked for the end of the advance
  double pressure_residual;     ///< relative residual of the solve that did not converge
  double net_inflow;            ///< m^3/s, of velocities that change in time where no side is an outflow
  double inflow_magnitude;      ///< m^3/s, sum of the magnitudes of the parts of `net_inflow`

  /// Resets the maxima of a step. Does not throw.
  KOKKOS_FUNCTION void forget_step() { static_cast<StepMaxima&>(*this) = {}; }

  /// True if the step must leave the state as it is. Does not throw.
  [[nodiscard]] KOKKOS_FUNCTION bool has_failed() const {
    return first_failure != no_failure || pressure_failed != 0 || failed_side != 0 || is_unbalanced != 0;
  }
};

/// Integer that orders reals as they are, above 0. Does not throw.
KOKKOS_INLINE_FUNCTION std::uint64_t ordered_bits(double value) {
  const auto bits = Kokkos::bit_cast<std::uint64_t>(value);
  return bits >> 63U != 0 ? ~bits : bits | std::uint64_t{1} << 63U;
}

/// Value of `ordered_bits`. Does not throw.
KOKKOS_INLINE_FUNCTION double ordered_value(std::uint64_t bits) {
  return Kokkos::bit_cast<double>(bits >> 63U != 0 ? bits ^ std::uint64_t{1} << 63U : ~bits);
}

/// Raises a maximum that other threads may raise at the same time. The load spares most values, which do not
/// exceed it, an atomic operation. Does not throw.
KOKKOS_INLINE_FUNCTION void raise(std::uint64_t& largest, std::uint64_t value) {
  if (value > device::relaxed_load(&largest)) Kokkos::atomic_max(&largest, value);
}

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
  double implicit_dt;   ///< s, `diffusive_dt` that explicit diffusion would have; infinite if it is explicit
  double acceleration;  ///< m/s^2, the largest component of that by body force and pressure drop
  std::int64_t max_steps;
  const stepping::MotionInterval* motion;  ///< prescribed motion
  int motions;                             ///< number of its intervals; 0 without any
};

/// Part of the limit of explicit diffusion that a variable dt may reach.
inline constexpr double diffusive_reserve = 0.9;

/// Largest ratio of two successive steps.
inline constexpr double largest_growth = 1.5;

/// Part of the range of the velocity by which viscosity may change it in a step of implicit diffusion.
inline constexpr double largest_viscous_change = 0.05;

/// Largest ratio of dt to the stable one of the velocity at the end of the step.
inline constexpr double largest_excess = 2.0;

/// Largest dt of the next step that is stable, s; NaN if the velocity is not finite. Implicit diffusion damps
/// the waves that the explicit advection amplifies while rate^2 dt is at most twice `damping_rate`.
KOKKOS_INLINE_FUNCTION double stable_dt(const Progress& now, const StepConstants& k) {
  const double rate = Kokkos::bit_cast<double>(now.rate_bits);
  if (!(rate >= 0.0)) return rate;  // NaN
  const double dt = 1.0 / (rate / k.stable_cfl + 1.0 / k.diffusive_dt);
  const double damped = 2.0 * k.damping_rate / (rate * rate);
  return damped > dt ? damped : dt;
}

/// Admissible dt of the next step, s. NaN or zero if there is none. Does not bound a fixed dt.
KOKKOS_INLINE_FUNCTION double admissible_dt(const Progress& now, const StepConstants& k) {
  if (k.fixed_dt > 0.0) return k.fixed_dt;
  const double rate = Kokkos::bit_cast<double>(now.rate_bits);
  if (!(rate >= 0.0)) return rate;  // NaN
  // Advection and diffusion share the stability region: the sum of their rates limits dt. A tenth is kept in
  // reserve for the dissipation of upwind-biased fluxes.
  double dt = 1.0 / (rate / k.cfl + 1.0 / (diffusive_reserve * k.diffusive_dt));
  if (now.longest_dt > 0.0 && now.longest_dt < dt) dt = now.longest_dt;
  return k.max_dt > 0.0 && !(dt < k.max_dt) ? k.max_dt : dt;
}

/// Bound of dt, s, with which implicit diffusion resolves the layers beside what begins to move.
KOKKOS_INLINE_FUNCTION double first_implicit_dt(const StepConstants& k) {
  return 2.0 * largest_viscous_change * k.implicit_dt;
}

/// `steps` equal steps from the present, each of at most `dt`, s, that resolve prescribed motion.
KOKKOS_INLINE_FUNCTION stepping::MotionBound resolved_motion(const Progress& now, double dt, double steps,
                                                             const StepConstants& k) {
  if (k.motions == 0 || !(dt > 0.0)) return {dt, Kokkos::Experimental::infinity_v<double>};
  stepping::MotionBound bound = stepping::bound_by_motion(k.motion, k.motions, now.time, dt, k.cfl, steps);
  if (bound.follows_jump && first_implicit_dt(k) < bound.dt) bound.dt = first_implicit_dt(k);
  return bound;
}

/// Rate that limits the next dt, as `Progress::rate_bits`: that of advection, and that of an eddy viscosity.
/// If sides accelerate by a in cells, the sum over the components, r becomes r' with dt (r + a dt) = cfl for
/// dt = cfl / r'. If the velocity grows so fast that dt would be unstable at the end of a step, a is that of
/// the last step and the stable CFL number takes the place of cfl.
KOKKOS_INLINE_FUNCTION std::uint64_t limiting_rate_bits(const Control& c, const StepConstants& k) {
  double rate =
      Kokkos::bit_cast<double>(c.next_rate_bits) + k.eddy_weight * Kokkos::bit_cast<double>(c.eddy_viscosity);
  double acceleration = 0.0;
  for (const std::uint64_t bits : c.side_acceleration) acceleration += Kokkos::bit_cast<double>(bits);
  if (acceleration > 0.0 && !(k.fixed_dt > 0.0))
    rate = 0.5 * (rate + Kokkos::sqrt(rate * rate + 4.0 * acceleration * k.cfl));
  const double before = Kokkos::bit_cast<double>(c.now.velocity_rate_bits),
               after = Kokkos::bit_cast<double>(c.next_rate_bits);
  if (c.trial.dt > 0.0 && after > before && !(k.fixed_dt > 0.0)) {
    const double growth = (after - before) / c.trial.dt;
    const double safe =
        0.5 * k.cfl / k.stable_cfl * (after + Kokkos::sqrt(after * after + 4.0 * growth * k.stable_cfl));
    if (safe > rate) rate = safe;
  }
  return Kokkos::bit_cast<std::uint64_t>(rate);
}

/// Bound of the dt that follows the step under way, s, before `Progress::rate_bits` is that of its end: steps
/// grow by degrees, and with implicit diffusion, which is stable for any dt, only while viscosity changes the
/// velocity little. A change that pressure and forces balance does not count.
KOKKOS_INLINE_FUNCTION double longest_next_dt(const Control& c, const StepConstants& k) {
  constexpr double infinite = Kokkos::Experimental::infinity_v<double>;
  const double dt = c.trial.dt;
  double longest = k.fixed_dt > 0.0 ? infinite : largest_growth * admissible_dt(c.now, k);
  if (k.implicit_dt < infinite) {
    // The viscous term was that before the jump.
    const bool follows_jump = resolved_motion(c.now, dt, 1.0, k).follows_jump;
    if (follows_jump && largest_growth * first_implicit_dt(k) < longest)
      longest = largest_growth * first_implicit_dt(k);
    double range = 0.0;
    for (int component = 0; component < 3; ++component) {
      if (c.highest[component] == 0) continue;
      const double highest = ordered_value(c.highest[component]),
                   lowest = -ordered_value(c.lowest[component]);
      const double extent[2] = {highest - lowest,
                                1e-12 * Kokkos::fmax(Kokkos::fabs(highest), Kokkos::fabs(lowest))};
      for (const double value : extent) range = value > range ? value : range;
    }
    // Less is round-off of forces that a pressure balances.
    if (1e-12 * dt * k.acceleration > range) range = 1e-12 * dt * k.acceleration;
    const double viscous = dt * Kokkos::bit_cast<double>(c.viscous_acceleration),
                 total = Kokkos::bit_cast<double>(c.change);
    const double change = viscous < total ? viscous : total;
    if (change > 0.0 && range > 0.0 && change * longest > largest_viscous_change * range * dt)
      longest = largest_viscous_change * range * dt / change;
  }
  return longest < infinite ? longest : 0.0;
}

/// Prepares the next step, or stops the run if there is no admissible dt. A fixed dt that is not stable stops
/// the run too; dt of the next step is then the largest stable one. Two equal steps reach a target that
/// is between one and two steps away, so that no step is much shorter than its neighbours; a fixed dt may
/// grow by a billionth.
KOKKOS_INLINE_FUNCTION void prepare_step(const Progress& now, stepping::StepTrial& next,
                                         const StepConstants& k) {
  double admissible = admissible_dt(now, k), left = next.target - now.time;
  if (!(k.fixed_dt > 0.0)) {
    const stepping::MotionBound bound = resolved_motion(now, admissible, 1.0, k);
    admissible = bound.dt;
    if (bound.jump < next.target) left = bound.jump - now.time;
  }
  double dt = left < admissible ? left : admissible;
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
