#pragma once

#include "kernels/flow/views.hpp"
#include "kernels/stepping/step_loop.hpp"

namespace drogue::flow {

/// First kernel of an advance.
template <class ExecutionSpace>
struct BeginAdvanceFunctor {
  ControlView<ExecutionSpace> control;
  typename stepping::StepLoop<ExecutionSpace>::StatusView status;
  StepConstants constants;
  stepping::AdvanceRequest request;
  std::int64_t output_step;

  KOKKOS_FUNCTION void operator()(int) const {
    Control& c = control();
    Progress now = c.now;
    stepping::StepTrial trial = c.trial;
    if (stepping::begin_advance(now, trial, request, output_step, constants.max_steps))
      prepare_step(now, trial, constants);
    stepping::publish_status(now, trial, 0, status());
    c.trial = trial;
  }
};

/// Records that the pressure solver did not converge, with the relative residual that it reached first.
template <class ExecutionSpace>
struct PressureFailureFunctor {
  ControlView<ExecutionSpace> control;
  double residual;
  KOKKOS_FUNCTION void operator()(int) const {
    Control& c = control();
    if (c.pressure_failed == 0) c.pressure_residual = residual;
    c.pressure_failed = 1;
  }
};

/// Largest stable dt, s, of the velocity at the end of a step.
KOKKOS_INLINE_FUNCTION double stable_dt_of_result(const Control& c, const StepConstants& k) {
  Progress result;
  result.rate_bits =
      Kokkos::bit_cast<std::uint64_t>(Kokkos::bit_cast<double>(c.next_rate_bits) +
                                      k.eddy_weight * Kokkos::bit_cast<double>(c.eddy_viscosity));
  return stable_dt(result, k);
}

/// Last kernel of a step: accepts it or stops the run.
template <class ExecutionSpace>
struct FinishStepFunctor {
  ControlView<ExecutionSpace> control;
  typename stepping::StepLoop<ExecutionSpace>::StatusView status;
  StepConstants constants;

  KOKKOS_FUNCTION void operator()(int) const {
    Control& c = control();
    Progress now = c.now;
    stepping::StepTrial trial = c.trial;
    if (trial.stop == Stop::running) {
      if (c.has_failed() || !Kokkos::isfinite(Kokkos::bit_cast<double>(c.next_rate_bits))) {
        trial.stop = Stop::failed;
        now.last_dt = 0.0;  // the rates of the failed step must not enter another one
      } else {
        now.longest_dt = longest_next_dt(c, constants);
        now.velocity_rate_bits = c.next_rate_bits;
        const double stable = stable_dt_of_result(c, constants);
        now.rate_bits = limiting_rate_bits(c, constants);
        stepping::advance_time(now, trial);
        if (trial.dt > largest_excess * stable) {
          // The velocity has grown beyond what the step could resolve.
          trial.dt = stable;
          trial.stop = Stop::failed;
        } else if (stepping::continues(now, trial, constants.max_steps)) {
          prepare_step(now, trial, constants);
          if (c.interrupted != 0 && trial.stop == Stop::running) trial.stop = Stop::interrupted;
        }
        c.forget_step();
      }
    }
    stepping::publish_status(now, trial, 0, status());
    c.now = now;
    c.trial = trial;
  }
};

}  // namespace drogue::flow
