#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "common/program/program.hpp"
#include "common/scene/nearest.hpp"
#include "perf/cases/cases.hpp"
#include "perf/command/command.hpp"
#include "perf/profile/kernel_profile.hpp"

namespace drogue::perf {
namespace {

struct NcuOptions {
  std::string name, out;
  int launches = 300;
};

/// Throws Failure(usage) with the nearest name for a case that this machine cannot run. Without a GPU the
/// list of its cases is missing, and any size passes with a notice.
void require_case(const std::string& name) {
  if (!device::is_present(device::Backend::cuda)) {
    print_notice("drogue-perf", "this build or machine has no cases on cuda: only the kind of '" + name +
                                    "' is checked; drogue-perf list prints the names where ncu runs");
    return;
  }
  std::vector<std::string> names;
  for (const Case& c : all_cases(false))
    if (c.on_device) names.push_back(c.name);
  if (std::ranges::find(names, name) == names.end())
    throw Failure(ExitCode::usage, "there is no case '" + name + "'" +
                                       (scene::nearest(name, names) ? "; " + scene::suggestion(name, names)
                                                                    : "; see drogue-perf list"));
}

ExitCode print_command(NcuOptions options) {
  if (options.out.empty()) {
    options.out = options.name + ".csv";
    std::ranges::replace(options.out, '/', '-');
  }
  const std::string program = std::filesystem::read_symlink("/proc/self/exe").string();
  const std::string text = profiling_command(options.name, program, options.out, options.launches);
  require_case(options.name);
  std::printf("%s\n", text.c_str());
  return ExitCode::ok;
}

}  // namespace

Command ncu_command(CLI::App& program) {
  const auto options = std::make_shared<NcuOptions>();
  CLI::App* app = program.add_subcommand(
      "ncu", "Print the command that profiles the kernels of a case by ncu, for table occupancy --profile");
  app->add_option("CASE", options->name, "Name of a case on cuda, as of drogue-perf list")->required();
  app->add_option("--out", options->out, "CSV file that ncu writes; default: the name of the case");
  app->add_option("--launches", options->launches, "Launches to profile; then ncu ends the run")
      ->check(CLI::Range(1, 100'000))
      ->capture_default_str();
  return {app, [options](const std::vector<std::string>&) { return print_command(*options); }};
}

}  // namespace drogue::perf
