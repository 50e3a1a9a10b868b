#include "miniapps/framework/study.hpp"

#include <utility>

namespace drogue::framework {

RepeatedRun repeat_run(const study::Repeats& repeats, const RunOnce& run_once) {
  RepeatedRun runs;
  try {
    while (!repeats.reached(runs.samples) && runs.code == ExitCode::ok) runs.code = run_once(runs);
  } catch (const Failure& failure) {
    RepeatedRun failed;
    failed.code = failure.code();
    failed.message = failure.what();
    return failed;
  }
  return runs;
}

StudySession::StudySession(const MiniAppOptions& options, const std::string& program,
                           const std::string& scene_name, const std::string& printed_scene,
                           int useful_threads)
    : _quiet(options.quiet),
      _backend(choose_backend(options.backend, useful_threads)),
      _directory(options.out.empty() ? std::filesystem::path("out") / (scene_name + "-study") : options.out,
                 options.overwrite ? run::ExistingRun::overwrite : run::ExistingRun::refuse_study),
      _session((_directory.begin(), _directory.write_scene(printed_scene), _backend), options.kokkos),
      _facts(run::new_result(program, scene_name)) {
  _session.describe(_facts);
  if (!_quiet) _session.print_shared_cores(program);
}

ExitCode StudySession::run(const study::Columns& columns, std::size_t count,
                           const study::RunPoint& run_point) {
  return study::run_points(_directory, _facts, columns, count, run_point, _quiet);
}

study::StudyRow study_row(RepeatedRun runs) {
  study::StudyRow row;
  row.samples = std::move(runs.samples);
  row.steps = runs.steps;
  row.errors = std::move(runs.errors);
  row.others = std::move(runs.others);
  row.series = std::move(runs.series);
  row.code = runs.code;
  row.message = std::move(runs.message);
  return row;
}

}  // namespace drogue::framework
