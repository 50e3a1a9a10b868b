#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <cstdio>

#include "common/program/command_line.hpp"
#include "common/program/mpi_guard.hpp"
#include "common/program/program.hpp"
#include "common/program/provenance.hpp"
#include "perf/command/command.hpp"

namespace {

using namespace drogue;

ExitCode run_program_body(int argc, char** argv) {
  bool version = false;
  CLI::App app("Measures the kernels: median of the samples with its 95 % interval, beside the error.",
               "drogue-perf");
  app.add_flag("--version", version, "Print the version and what it was built with");
  const std::vector<perf::Command> commands = {perf::list_command(app),
                                               perf::run_command(app),
                                               perf::table_command(app),
                                               perf::benchmark_command(app),
                                               perf::work_precision_command(app),
                                               perf::ladder_command(app),
                                               perf::compare_command(app),
                                               perf::report_command(app),
                                               perf::ncu_command(app),
                                               perf::messages_command(app),
                                               perf::extrapolate_command(app)};
  const Arguments arguments = split_arguments(argc, argv);
  if (const std::string help = parse_command_line(app, arguments.program); !help.empty()) {
    std::fputs(help.c_str(), stdout);
    return ExitCode::ok;
  }
  if (version) {
    std::fputs(version_text("drogue-perf").c_str(), stdout);
    return ExitCode::ok;
  }
  std::string names;
  for (const perf::Command& command : commands) {
    if (command.app->parsed()) {
      const std::string name = command.app->get_name();
      if (name != "list" && name != "messages") require_one_rank();
      return command.execute(arguments.kokkos);
    }
    names += (names.empty() ? "" : ", ") + command.app->get_name();
  }
  throw Failure(ExitCode::usage, "a subcommand is required: " + names + "; see drogue-perf --help");
}

}  // namespace

int main(int argc, char** argv) {
  return drogue::run_program("drogue-perf", [&] { return run_program_body(argc, argv); });
}
