#include "miniapps/springs/repeated_run.hpp"

#include "miniapps/springs/samples.hpp"
#include "miniapps/springs/simulation.hpp"

namespace drogue::springs_app {

Scratch::Scratch(const std::filesystem::path& folder)
    : _folder(folder), _directory(folder, run::ExistingRun::overwrite) {}

Scratch::~Scratch() {
  std::error_code ignored;
  std::filesystem::remove_all(_folder, ignored);
}

namespace {

/// One run; the first fills all but the samples. Throws Failure.
ExitCode run_once(const SpringsScene& scene, device::Backend backend, const run::RunDirectory& directory,
                  RepeatedRun& runs) {
  const bool first = runs.samples.empty();
  RunSettings settings{backend, false, true, {}, false, {}};
  if (first)
    settings.at_output = [&](const Row& now, const std::vector<fabric::Vector>& x) {
      const auto add = [&runs](const char* name, double value) { runs.series[name].push_back(value); };
      add("time", now.time);
      add("kinetic", now.kinetic);
      add("elastic", now.elastic);
      if (scene.has_lines()) add("length", total_length(scene.mesh, x));
      if (scene.has_triangles()) add("area", total_area(scene.mesh, x));
    };
  Simulation simulation(scene, settings);
  run::ResultDocument result;
  const ExitCode code = simulation.run(directory, result);
  if (code != ExitCode::ok) return code;
  runs.samples.push_back(result.timing.compute_s);
  if (!first) return code;
  runs.steps = result.steps;
  verify(scene, simulation.final_state(), directory.file("history.csv"), result);
  runs.errors = result.errors;
  for (const run::Check& check : result.checks) runs.checks.push_back(check.name);
  return code;
}

}  // namespace

RepeatedRun run_repeatedly(const SpringsScene& scene, device::Backend backend, const study::Repeats& repeats,
                           Scratch& scratch) {
  RepeatedRun runs;
  scratch.directory().begin();
  try {
    while (!repeats.reached(runs.samples))
      if (run_once(scene, backend, scratch.directory(), runs) == ExitCode::interrupted) {
        runs.code = ExitCode::interrupted;
        return runs;
      }
  } catch (const Failure& failure) {
    RepeatedRun failed;
    failed.code = failure.code();
    failed.message = failure.what();
    return failed;
  }
  return runs;
}

}  // namespace drogue::springs_app
