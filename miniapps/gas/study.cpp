#include "miniapps/gas/study.hpp"

#include <utility>

#include "common/study/axes.hpp"
#include "common/study/study.hpp"
#include "kernels/device/profiling_counters.hpp"
#include "miniapps/gas/repeated_run.hpp"
#include "miniapps/gas/scheme_names.hpp"
#include "miniapps/gas/simulation.hpp"

namespace drogue::gas_app {

namespace {

const study::Columns columns = {{"weno", "weno_power", "splitting", "time_scheme", "precision"},
                                "cells",
                                {"l1_density", "l1_velocity", "l1_pressure", "conservation"},
                                "l1_density",
                                "L1 density"};

study::Axes parse(const std::string& text) {
  return study::parse_axes(text, {"cells", 8, 28},
                           {{"schemes", {"js", "z", "z2", "m", "teno5"}},
                            {"splittings", {"lf-global", "lf-single", "lf-stencil"}},
                            {"times", {"ssprk3", "ssprk43"}},
                            {"precisions", {"double", "split"}}});
}

/// The `--set` assignments that make the scene one point of the study, for all points; an empty text sets
/// nothing.
std::vector<std::vector<std::string>> assignments(const study::Axes& axes, const MiniAppOptions& options) {
  const auto meshes = axes.meshes.empty() ? std::vector<std::int64_t>{0} : axes.meshes;
  std::vector<std::vector<std::string>> points;
  for (const std::string& scheme : axes.of("schemes"))
    for (const std::string& splitting : axes.of("splittings"))
      for (const std::string& time : axes.of("times"))
        for (const std::string& precision : axes.of("precisions"))
          for (const std::int64_t cells : meshes) {
            std::vector<std::string> sets = options.set;
            const auto set = [&sets](const char* key, const std::string& value) {
              if (!value.empty()) sets.push_back(std::string(key) + "=\"" + value + '"');
            };
            if (cells > 0) sets.push_back("mesh.cells=" + std::to_string(cells));
            set("scheme.weno", scheme == "z2" ? "z" : scheme);
            if (scheme.starts_with('z'))
              sets.push_back(std::string("scheme.weno_power=") + (scheme == "z2" ? "2" : "1"));
            set("scheme.splitting", splitting);
            set("scheme.time", time);
            set("scheme.precision", precision);
            points.push_back(std::move(sets));
          }
  return points;
}

study::Row row_of(const gas::Parameters& p, const RepeatedRun& run) {
  const SchemeNames names = scheme_names(p);
  study::Row row{
      names.label, {names.weno, std::int64_t{p.weno_power}, names.splitting, names.time, names.precision},
      p.cells,     run.steps,
      run.samples, run.errors,
      {},          {},
      run.code,    run.message};
  if (run.code == ExitCode::ok) row.others["conservation"] = run.conservation;
  return row;
}

}  // namespace

ExitCode run_study(const MiniAppOptions& options, const std::filesystem::path& file) {
  const study::Axes axes = parse(options.study);
  const GasScene base = read_gas_scene(file, options.set);
  if (!base.verify.exact)
    throw Failure(ExitCode::usage, "--study needs a scene with [verify] exact, to measure errors against");
  std::vector<GasScene> scenes;  // all of them, so that none is found wrong after others have run
  for (const auto& sets : assignments(axes, options)) scenes.push_back(read_gas_scene(file, sets));
  const device::Backend backend = choose_backend(options.backend);
  const std::filesystem::path out =
      options.out.empty() ? std::filesystem::path("out") / (base.name + "-study") : options.out;
  run::RunDirectory directory(out,
                              options.overwrite ? run::ExistingRun::overwrite : run::ExistingRun::refuse);
  directory.begin();
  directory.write_scene(print_gas_scene(base));
  const auto runtime = start_kokkos(options.kokkos);
  device::start_profiling();
  run::ResultDocument facts = run::new_result("drogue-gas", base.name);
  describe_device(facts, base.parameters, backend);

  std::optional<Reference> reference = Reference{};
  if (*base.verify.exact == Exact::reference) reference = run_reference(base, backend, options.quiet);
  if (!reference) return ExitCode::interrupted;
  const ExactSolution exact = exact_solution(base, base.end_time, *reference);
  const auto run_point = [&](std::size_t i, std::vector<study::Row>& rows) {
    const RepeatedRun run = run_repeatedly(scenes[i], backend, exact, {5, 1.0});
    if (run.code == ExitCode::interrupted) return false;
    rows.push_back(row_of(scenes[i].parameters, run));
    return true;
  };
  return study::run_points(directory, facts, columns, scenes.size(), run_point, options.quiet);
}

}  // namespace drogue::gas_app
