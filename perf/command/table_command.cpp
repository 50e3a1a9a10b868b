#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
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
  std::string table, out;
  std::string app;  ///< empty: that of the table
  std::string backend = "auto";
  bool quick = false;
};

/// Tables of a mini-app.
std::vector<std::string> tables_of(const std::string& app) {
  if (app == "gas") return {"occupancy", "block-size", "transfers", "scaling"};
  if (app == "flow") return {"pressure", "memory", "scaling"};
  if (app == "parachute") return {"transfers"};
  return {"transfers", "scaling"};
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
  const device::Runtime runtime(kokkos);
  const nlohmann::json here = provenance(device::device_facts());
  if (block_size) return print_block_sizes(backend, options.quick, here);
  const auto print = options.table == "pressure" ? print_flow_pressure
                     : options.table == "memory" ? print_flow_memory
                     : options.app == "gas"      ? print_gas_transfers
                     : options.app == "springs"  ? print_fabric_transfers
                     : options.app == "options"  ? print_options_transfers
                                                 : print_parachute_transfers;
  return print(backend, options.quick, here);
}

ExitCode print_table(TableOptions options, const std::vector<std::string>& kokkos) {
  require_name("table", options.table,
               {"occupancy", "block-size", "transfers", "scaling", "pressure", "memory"});
  if (options.app.empty())
    options.app = options.table == "pressure" || options.table == "memory" ? "flow" : "gas";
  require_app(options.app);
  if (options.app == "springs" && options.table == "block-size")
    throw Failure(ExitCode::usage,
                  "kernels of springs are compiled for one block size; what can be chosen is the size of a "
                  "patch, which drogue-perf run --filter springs-step/cuda/.*/patch times");
  require_name("table of " + options.app, options.table, tables_of(options.app));
  run::require_writable(options.out);
  install_signal_handlers();
  Table table;
  if (options.table == "occupancy")
    table =
        print_occupancy(provenance({.kokkos_version = device::kokkos_version(), .gpu = "", .driver = ""}));
  else if (options.table == "scaling")
    table = print_scaling(options.app, backends_of(options.backend), options.quick);
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
                  "occupancy (computed); block-size or transfers; scaling with size and threads; pressure or "
                  "memory of flow")
      ->required();
  app->add_option("--app", options->app, app_help("Kernels that are measured"));
  app->add_option("--backend", options->backend, "Where to measure: auto takes the fastest present")
      ->check(CLI::IsMember(backend_choices()))
      ->capture_default_str();
  app->add_option("--out", options->out, "File for the records, one JSON line a row");
  app->add_flag("--quick", options->quick, "Few rows and few samples");
  return {app, [options](const std::vector<std::string>& kokkos) { return print_table(*options, kokkos); }};
}

}  // namespace drogue::perf
