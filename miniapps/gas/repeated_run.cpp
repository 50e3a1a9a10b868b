#include "miniapps/gas/repeated_run.hpp"

#include "miniapps/gas/simulation.hpp"

namespace drogue::gas_app {

RepeatedRun run_repeatedly(const GasScene& scene, device::Backend backend, const ExactSolution& exact,
                           const Repeats& repeats) {
  GasScene silent = scene;
  silent.output = {};  // a step shortened to meet an output that is not written would only cost time
  RepeatedRun runs;
  while (!repeats.reached(runs.samples)) {
    Simulation simulation(silent, {backend, false, true, {}});
    run::ResultDocument result;
    try {
      runs.code = simulation.run(nullptr, result);
      if (runs.code == ExitCode::interrupted) return runs;
    } catch (const Failure& failure) {
      RepeatedRun failed;
      failed.code = failure.code();
      failed.message = failure.what();
      return failed;
    }
    runs.samples.push_back(result.timing.compute_s);
    if (runs.samples.size() > 1) continue;
    runs.steps = result.steps;
    runs.errors = error_norms(simulation.solver(), silent.parameters, exact);
    runs.conservation = simulation.conservation();
  }
  return runs;
}

}  // namespace drogue::gas_app
