#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <memory>

#include "common/program/command_line.hpp"
#include "common/program/signals.hpp"
#include "common/run/files/atomic_file.hpp"
#include "perf/command/command.hpp"
#include "perf/measure/record.hpp"
#include "perf/tables/tables.hpp"

namespace drogue::perf {
namespace {

struct TableOptions {
  std::string table, out, profile;
  std::string app;  ///< empty: that of the table
  std::string backend = "auto";
  std::string architecture = "sm_90";
  bool quick = false;
  std::string over;  ///< units of scaling; empty: threads
  bool weak = false;
  int most = 0;

  /// True if the scaling is that of a program: over ranks, or weak.
  [[nodiscard]] bool scales_program() const { return over == "ranks" || weak; }
};

const std::vector<std::string> table_names = {"machine", "occupancy",   "kernels",  "block-size", "transfers",
                                              "scaling", "abstraction", "pressure", "memory"};

/// Tables that are computed, without a backend.
bool is_computed(const std::string& table) { return table == "occupancy" || table == "kernels"; }

/// Option that some tables use, and those.
struct SpecialOption {
  const char* name;
  std::vector<std::string> tables;
};

const std::vector<SpecialOption> special_options = {
    {"--app", {"occupancy", "block-size", "transfers", "scaling", "abstraction", "pressure", "memory"}},
    {"--backend", {"machine", "block-size", "transfers", "scaling", "abstraction", "pressure", "memory"}},
    {"--profile", {"occupancy", "kernels", "block-size"}},
    {"--architecture", {"occupancy"}},
    {"--over", {"scaling"}},
    {"--weak", {"scaling"}},
    {"--most", {"scaling"}}};

/// Tables of a mini-app.
std::vector<std::string> tables_of(const std::string& app) {
  if (app == "gas") return {"occupancy", "block-size", "transfers", "scaling", "abstraction"};
  if (app == "flow") return {"block-size", "pressure", "memory", "scaling", "abstraction"};
  if (app == "springs") return {"transfers", "scaling", "abstraction"};
  if (app == "parachute") return {"block-size", "transfers"};
  return {"block-size", "transfers", "scaling"};
}

/// Throws Failure(usage) if the command line `given` has an option that the table does not use.
void check_special_options(const std::string& table, const CLI::App& given) {
  for (const SpecialOption& option : special_options) {
    if (given.count(option.name) == 0 || std::ranges::find(option.tables, table) != option.tables.end())
      continue;
    std::string names;
    for (const std::string& name : option.tables) names += (names.empty() ? "" : ", ") + name;
    throw Failure(ExitCode::usage, "the table " + table + " does not use " + option.name + "; it is for " +
                                       (option.tables.size() == 1 ? "the table " : "the tables ") + names);
  }
}

/// Throws Failure(usage) for options of scaling that do not fit the mini-app.
void check_scaling(const TableOptions& options) {
  if (options.scales_program() && options.app != "flow")
    throw Failure(ExitCode::usage, "of " + options.app + " there is strong scaling over threads alone; " +
                                       "weak scaling and ranks have --app flow");
  if (options.most > 0 && !options.scales_program())
    throw Failure(ExitCode::usage, "--most needs --weak or --over ranks");
}

/// Scaling of a program, or of the cases of `run`.
Table scaling_table(const TableOptions& options) {
  std::vector<device::Backend> backends = backends_of(options.backend);
  if (!options.scales_program()) return print_scaling(options.app, backends, options.quick);
  const ScalingUnit unit = options.over == "ranks" ? ScalingUnit::ranks : ScalingUnit::threads;
  // Ranks have one thread each: on OpenMP they repeat those of Serial.
  if (unit == ScalingUnit::ranks && options.backend == "auto" && backends.size() > 1)
    std::erase(backends, device::Backend::openmp);
  return print_program_scaling({unit, options.weak, options.most}, backends, options.quick);
}

/// Tables that need a backend and Kokkos.
Table timed_table(const TableOptions& options, const std::vector<std::string>& kokkos) {
  const device::Backend backend = device::wanted_backend(options.backend);
  require(backend);
  const bool block_size = options.table == "block-size";
  if (block_size && backend != device::Backend::cuda)
    throw Failure(ExitCode::usage, "a block size means nothing to the host backend '" +
                                       std::string(device::name(backend)) +
                                       "', whose teams are single threads; give --backend cuda");
  const bool abstraction = options.table == "abstraction";
  if (abstraction && backend != device::Backend::cuda)
    throw Failure(ExitCode::usage,
                  "the table abstraction compares kernels in Kokkos with kernels in CUDA and "
                  "means nothing to the host backend '" +
                      std::string(device::name(backend)) + "'; give --backend cuda");
  const device::Runtime runtime(kokkos);
  const device::DeviceFacts device = device::device_facts();
  if (options.table == "machine") return print_machine(device);
  const nlohmann::json here = provenance(device);
  if (abstraction) return print_abstraction(options.app, backend, options.quick, here);
  if (block_size)
    return print_block_sizes(options.app, backend, options.quick, device.capability, options.profile, here);
  const auto print = options.table == "pressure" ? print_flow_pressure
                     : options.table == "memory" ? print_flow_memory
                     : options.app == "gas"      ? print_gas_transfers
                     : options.app == "springs"  ? print_fabric_transfers
                     : options.app == "options"  ? print_options_transfers
                                                 : print_parachute_transfers;
  return print(backend, options.quick, here);
}

ExitCode print_table(TableOptions options, const CLI::App& given, const std::vector<std::string>& kokkos) {
  require_name("table", options.table, table_names);
  check_special_options(options.table, given);
  const bool of_flow = options.table == "pressure" || options.table == "memory" || options.scales_program();
  if (options.app.empty()) options.app = of_flow ? "flow" : "gas";
  require_app(options.app);
  if (options.app == "springs" && options.table == "block-size")
    throw Failure(ExitCode::usage,
                  "kernels of springs are compiled for one block size; what can be chosen is the size of a "
                  "patch, which drogue-perf run --filter springs-step/cuda/.*/patch times");
  if (options.table == "kernels" && options.profile.empty())
    throw Failure(
        ExitCode::usage,
        "the table kernels needs --profile with a CSV file of ncu; drogue-perf ncu prints the command "
        "that makes one");
  if (options.table != "machine" && options.table != "kernels")
    require_name("table of " + options.app, options.table, tables_of(options.app));
  check_scaling(options);
  run::require_writable(options.out);
  install_signal_handlers();
  Table table;
  if (is_computed(options.table)) {
    const nlohmann::json here =
        provenance({.kokkos_version = device::kokkos_version(), .gpu = "", .driver = ""});
    table = options.table == "occupancy" ? print_occupancy(options.architecture, options.profile, here)
                                         : print_kernel_times(options.profile, here);
  } else if (options.table == "scaling")
    table = scaling_table(options);
  else
    table = timed_table(options, kokkos);
  write_records(options.out, table.records);
  return code_of(table.passed);
}

}  // namespace

Command table_command(CLI::App& program) {
  const auto options = std::make_shared<TableOptions>();
  CLI::App* app = program.add_subcommand(
      "table", "Print a table, most of them of [Shi] (README.md cites it) beside our own numbers");
  app->add_option("TABLE", options->table,
                  "machine; occupancy (computed); kernels (of a profile); block-size or transfers; scaling "
                  "with size and threads; "
                  "abstraction: "
                  "kernels in Kokkos against CUDA; pressure or memory of flow")
      ->required();
  app->add_option("--app", options->app, app_help("Kernels that are measured"));
  app->add_option("--backend", options->backend, "Where to measure: auto takes the fastest present")
      ->check(CLI::IsMember(backend_choices()))
      ->capture_default_str();
  app->add_option(
      "--profile", options->profile,
      "CSV file of ncu, or folder of them: kernels for occupancy and kernels, registers for block-size");
  app->add_option("--architecture", options->architecture,
                  "For occupancy: compute capability of the step kernels of gas, sm_20 to sm_121")
      ->capture_default_str();
  app->add_option("--out", options->out, "File for the records, one JSON line a row");
  app->add_flag("--quick", options->quick, "Few rows and few samples");
  app->add_option("--over", options->over, "Scaling over threads (default) or, of flow, ranks of mpirun")
      ->check(CLI::IsMember({"threads", "ranks"}));
  app->add_flag("--weak", options->weak, "Scaling of flow with work that grows with threads or ranks");
  app->add_option("--most", options->most, "Largest number of threads or ranks; all processors or GPUs")
      ->check(CLI::Range(1, 4096));
  return {app, [options, app](const std::vector<std::string>& kokkos) {
            return print_table(*options, *app, kokkos);
          }};
}

}  // namespace drogue::perf
