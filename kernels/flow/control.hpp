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
  std::uint64_t next_rate;      ///< reduction of the state after the step, as `Progress::rate`
  std::uint64_t first_failure;  ///< least cell whose predicted velocity is not finite, or `no_failure`
  int pressure_failed;          ///< 1 after an iterative pressure solver did not converge
};

/// Constants that determine dt.
struct StepConstants {
  double cfl, fixed_dt, max_dt;
  double diffusive_dt;  ///< s, bound of explicit diffusion; infinite without viscosity
  std::int64_t max_steps;
};

/// Admissible dt of the next step, s. NaN or zero if there is none.
KOKKOS_INLINE_FUNCTION double admissible_dt(const Progress& now, const StepConstants& k) {
  if (k.fixed_dt > 0.0) return k.fixed_dt;
  const double rate = Kokkos::bit_cast<double>(now.rate);
  if (!(rate >= 0.0)) return rate;  // NaN
  // Advection and diffusion share the stability region: the sum of their rates limits dt. A tenth is kept in
  // reserve for the dissipation of upwind-biased fluxes.
  const double dt = 1.0 / (rate / k.cfl + 1.0 / (0.9 * k.diffusive_dt));
  return k.max_dt > 0.0 && !(dt < k.max_dt) ? k.max_dt : dt;
}

/// Prepares the next step, or stops the run if there is no admissible dt. Two equal steps reach a target that
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
}

}  // namespace drogue::flow
