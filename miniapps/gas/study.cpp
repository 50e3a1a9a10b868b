#include "miniapps/gas/study.hpp"

#include <spawn.h>
#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "common/program/program.hpp"
#include "common/run/atomic_file.hpp"
#include "common/run/run_directory.hpp"
#include "common/run/statistics.hpp"
#include "kernels/device/ledger.hpp"
#include "kernels/device/runtime.hpp"
#include "miniapps/gas/repeated_run.hpp"
#include "miniapps/gas/scheme_names.hpp"
#include "miniapps/gas/simulation.hpp"

namespace drogue::gas_app {

namespace {

struct Row {
  std::string label, weno;
  int power = 1;
  std::string splitting, time, precision;
  std::int64_t cells = 0;
  RepeatedRun run;
};

std::string setting(const char* key, const std::string& value) {
  return std::string(key) + "=\"" + value + '"';
}

/// The `--set` assignments that make the scene one point of the study.
std::vector<std::string> assignments(const MiniAppOptions& options, const Row& row) {
  std::vector<std::string> sets = options.set;
  if (row.cells > 0) sets.push_back("mesh.cells=" + std::to_string(row.cells));
  if (!row.weno.empty()) sets.push_back(setting("scheme.weno", row.weno));
  if (row.weno == "z") sets.push_back("scheme.weno_power=" + std::to_string(row.power));
  if (!row.splitting.empty()) sets.push_back(setting("scheme.splitting", row.splitting));
  if (!row.time.empty()) sets.push_back(setting("scheme.time", row.time));
  if (!row.precision.empty()) sets.push_back(setting("scheme.precision", row.precision));
  return sets;
}

/// One entry of each axis that the study leaves alone: an empty text, which sets nothing.
std::vector<std::string> or_scene(const std::vector<std::string>& values) {
  return values.empty() ? std::vector<std::string>{""} : values;
}

std::vector<Row> points(const StudyAxes& axes) {
  const auto meshes = axes.meshes.empty() ? std::vector<std::int64_t>{0} : axes.meshes;
  const auto schemes = axes.schemes.empty() ? std::vector<StudyScheme>{{"", gas::Weno::z, 1}} : axes.schemes;
  std::vector<Row> rows;
  for (const StudyScheme& scheme : schemes)
    for (const std::string& splitting : or_scene(axes.splittings))
      for (const std::string& time : or_scene(axes.times))
        for (const std::string& precision : or_scene(axes.precisions))
          for (const std::int64_t cells : meshes) {
            Row row;
            row.weno = scheme.name == "z2" ? "z" : scheme.name;
            row.power = scheme.power;
            row.splitting = splitting, row.time = time, row.precision = precision, row.cells = cells;
            rows.push_back(row);
          }
  return rows;
}

void describe(Row& row, const gas::Parameters& p) {
  const SchemeNames names = scheme_names(p);
  row.label = names.label, row.weno = names.weno, row.splitting = names.splitting;
  row.time = names.time, row.precision = names.precision;
  row.power = p.weno_power;
  row.cells = p.cells;
}

double time_of(const Row& row) { return row.run.samples.empty() ? NAN : run::median(row.run.samples); }

std::string line_of(const Row& row) {
  char text[160];
  std::snprintf(text, sizeof text, "%-24s %8lld cells  ", row.label.c_str(),
                static_cast<long long>(row.cells));
  if (row.run.code != ExitCode::ok) return text + row.run.message + '\n';
  std::string line = text;
  std::snprintf(text, sizeof text, "%8lld steps %10.3g s  L1 density %.4g\n",
                static_cast<long long>(row.run.steps), time_of(row), row.run.errors.at("l1_density"));
  return line + text;
}

std::string csv(const std::vector<Row>& rows, const std::string& backend) {
  std::ostringstream text;
  text.precision(9);
  text << "label,weno,weno_power,splitting,time_scheme,precision,backend,cells,steps,compute_s,l1_density,l1_"
          "velocity,"
          "l1_pressure,conservation,status\n";
  for (const Row& row : rows) {
    text << row.label << ',' << row.weno << ',' << row.power << ',' << row.splitting << ',' << row.time << ','
         << row.precision << ',' << backend << ',' << row.cells << ',' << row.run.steps << ',';
    const bool ok = row.run.code == ExitCode::ok;
    if (ok) text << time_of(row);
    for (const char* name : {"l1_density", "l1_velocity", "l1_pressure"}) {
      text << ',';
      if (ok) text << row.run.errors.at(name);
    }
    text << ',';
    if (ok) text << row.run.conservation;
    text << ',' << run::status_name(row.run.code) << '\n';
  }
  return text.str();
}

nlohmann::json json(const std::vector<Row>& rows, const run::ResultDocument& facts) {
  nlohmann::json document = {{"schema", "drogue.study/1"},
                             {"program", facts.program},
                             {"version", facts.version},
                             {"git", facts.git},
                             {"scene", facts.scene},
                             {"backend", facts.backend},
                             {"device", facts.device},
                             {"threads", facts.threads},
                             {"compiler", facts.provenance.compiler},
                             {"date", facts.provenance.date}};
  for (const Row& row : rows) {
    nlohmann::json entry = {{"label", row.label},         {"weno", row.weno},
                            {"weno_power", row.power},    {"splitting", row.splitting},
                            {"time_scheme", row.time},    {"precision", row.precision},
                            {"cells", row.cells},         {"steps", row.run.steps},
                            {"samples", row.run.samples}, {"errors", row.run.errors},
                            {"message", row.run.message}, {"status", run::status_name(row.run.code)}};
    if (row.run.code == ExitCode::ok)
      entry["compute_s"] = time_of(row), entry["conservation"] = row.run.conservation;
    document["rows"].push_back(entry);
  }
  return document;
}

/// Lets `drogue-plot`, which lies beside this program, draw the study.
void draw(const std::filesystem::path& directory) {
  std::error_code error;
  const std::filesystem::path plot =
      std::filesystem::read_symlink("/proc/self/exe", error).parent_path() / "drogue-plot";
  std::string program = plot.string(), folder = directory.string();
  char* arguments[] = {program.data(), folder.data(), nullptr};
  pid_t child = 0;
  int status = 1;
  if (std::filesystem::exists(plot, error) &&
      posix_spawn(&child, program.c_str(), nullptr, nullptr, arguments, environ) == 0)
    waitpid(child, &status, 0);
  if (status != 0) std::cerr << "drogue-gas: no picture was made; run drogue-plot " << folder << '\n';
}

}  // namespace

ExitCode run_study(const MiniAppOptions& options, const std::filesystem::path& file) {
  const StudyAxes axes = parse_study(options.study);
  const GasScene base = read_gas_scene(file, options.set);
  if (!base.verify.exact)
    throw Failure(ExitCode::usage, "--study needs a scene with [verify] exact, to measure errors against");
  std::vector<Row> rows = points(axes);
  std::vector<GasScene> scenes;  // all of them, so that none is found wrong after others have run
  for (Row& row : rows) {
    scenes.push_back(read_gas_scene(file, assignments(options, row)));
    describe(row, scenes.back().parameters);
  }
  const device::Backend backend = choose_backend(options.backend);
  const std::filesystem::path out =
      options.out.empty() ? std::filesystem::path("out") / (base.name + "-study") : options.out;
  run::RunDirectory directory(out,
                              options.overwrite ? run::ExistingRun::overwrite : run::ExistingRun::refuse);
  directory.begin();
  directory.write_scene(print_gas_scene(base));
  const auto runtime = start_kokkos(options.kokkos);
  device::start_ledger();
  run::ResultDocument facts = run::new_result("drogue-gas", base.name);
  describe_device(facts, base.parameters, backend);

  std::optional<Reference> reference = Reference{};
  if (*base.verify.exact == Exact::reference) reference = run_reference(base, backend, options.quiet);
  if (!reference) return ExitCode::interrupted;
  const ExactSolution exact = exact_solution(base, base.end_time, *reference);
  std::vector<Row> done;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].run = run_repeatedly(scenes[i], backend, exact, {5, 1.0});
    if (rows[i].run.code == ExitCode::interrupted) return ExitCode::interrupted;
    done.push_back(rows[i]);
    // After every point: whatever ends a long study leaves what it has found.
    run::write_file_atomically(directory.file("study.csv"), csv(done, facts.backend));
    run::write_file_atomically(
        directory.file("study.json"),
        json(done, facts).dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
    if (!options.quiet) std::cout << line_of(rows[i]) << std::flush;
  }
  if (std::ranges::none_of(done, [](const Row& row) { return row.run.code == ExitCode::ok; }))
    throw Failure(ExitCode::numerical_failure,
                  "every run of the study failed; '" + out.string() + "/study.json' says how");
  draw(out);
  return ExitCode::ok;
}

}  // namespace drogue::gas_app
