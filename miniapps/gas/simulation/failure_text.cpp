#include "miniapps/gas/simulation/failure_text.hpp"

#include <sstream>
#include <string_view>

#include "miniapps/gas/scene/scene.hpp"

namespace drogue::gas_app {

std::string failure_text(gas::Solver& solver, const gas::Parameters& parameters, double end_time,
                         gas::Stop stop) {
  std::ostringstream text;
  text.precision(9);
  if (stop == gas::Stop::max_steps) {
    const gas::RestartState now = solver.restart_state();
    text << "run.max_steps = " << parameters.max_steps << " reached at t = " << now.time
         << " s, before run.end_time = " << end_time << " s";
    return text.str();
  }
  const gas::StepFailure failed = solver.failure();
  switch (failed.reason) {
    case gas::FailureReason::density:
      text << "density is not positive";
      break;
    case gas::FailureReason::pressure:
      text << "pressure is not positive";
      break;
    case gas::FailureReason::not_finite:
      text << "the state is not finite";
      break;
    case gas::FailureReason::time_step:
      if (!(parameters.fixed_dt > 0.0))
        text << "the time step collapsed to " << failed.dt << " s (CFL)";
      else if (failed.time + failed.dt > failed.time)
        text << "scheme.fixed_dt = " << parameters.fixed_dt
             << " s moves waves by more than half a cell in a stage, which the limiter does not allow,";
      else
        text << "scheme.fixed_dt = " << parameters.fixed_dt << " s does not change the time,";
      break;
  }
  if (failed.index >= 0)
    text << " in cell " << failed.index << " (x = " << cell_centre(parameters, failed.index) << " m)";
  text << " at step " << failed.step << ", t = " << failed.time << " s";
  const bool has_limiter = std::string_view(solver.driver()) != "seed";
  if (has_limiter && parameters.positivity == gas::Positivity::off &&
      failed.reason != gas::FailureReason::time_step)
    text << "; scheme.positivity = \"auto\" may save the run";
  else if (parameters.fixed_dt > 0.0)
    text << "; a shorter scheme.fixed_dt may save the run";
  return text.str();
}

}  // namespace drogue::gas_app
