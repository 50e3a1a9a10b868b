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
  std::vector<std::string> words;  ///< name of a case, or a program and its arguments
  bool is_command = false;         ///< the words are a program and its arguments
  std::string out;
  ProfiledLaunches launches;
};

/// Throws Failure(usage) with the nearest name for a case that this machine cannot run. Without a GPU the
/// list of its cases is missing, and any size passes with a notice.
void require_case_on_cuda(const std::string& name) {
  if (!device::is_present(device::Backend::cuda)) {
    print_notice("drogue-perf", "this build or machine has no cases on cuda: only the kind of '" + name +
                                    "' is checked; drogue-perf list prints the names where ncu runs");
    return;
  }
  std::vector<Case> cases = all_cases(false);
  std::erase_if(cases, [](const Case& c) { return !c.on_device(); });
  require_case(name, cases);
}

ExitCode print_command(NcuOptions options) {
  std::string name = options.words.front();
  if (options.is_command) {
    if (options.launches.kernels.empty()) options.launches.kernels = "drogue::";
    name = std::filesystem::path(name).filename().string();
  } else {
    if (options.words.size() > 1)
      throw Failure(ExitCode::usage, "'" + options.words[1] + "' after the case " + name +
                                         " is too much; a program and its arguments follow --command --");
    const std::string kernels = kernels_of_case(name);
    if (options.launches.kernels.empty()) options.launches.kernels = kernels;
    require_case_on_cuda(name);
    options.words = {std::filesystem::read_symlink("/proc/self/exe").string(), "run", "--filter",
                     "^" + name + "$"};
  }
  if (options.out.empty()) {
    options.out = name + ".csv";
    std::ranges::replace(options.out, '/', '-');
  }
  std::printf("%s\n", profiling_command(options.words, options.out, options.launches).c_str());
  return ExitCode::ok;
}

}  // namespace

Command ncu_command(CLI::App& program) {
  const auto options = std::make_shared<NcuOptions>();
  CLI::App* app = program.add_subcommand("ncu",
                                         "Print the command that profiles the kernels of a case by ncu, for "
                                         "table occupancy or kernels --profile");
  app->add_option("CASE", options->words, "Name of a case on cuda, as of drogue-perf list")->required();
  app->add_option("--out", options->out, "CSV file that ncu writes; default: the name of the case");
  app->add_option("--launches", options->launches.count, "Launches to profile; then ncu ends the run")
      ->check(CLI::Range(1, 100'000))
      ->capture_default_str();
  app->add_option("--skip", options->launches.skip, "Launches before the first one that is profiled")
      ->check(CLI::Range(0, 10'000'000))
      ->capture_default_str();
  app->add_option(
      "--kernels", options->launches.kernels,
      "Regular expression for demangled names of kernels; default: the namespaces of the case, or "
      "all of the project");
  app->add_flag("--command", options->is_command,
                "Profile a program with its arguments, which follow --, instead of a case");
  return {app, [options](const std::vector<std::string>&) { return print_command(*options); }};
}

}  // namespace drogue::perf
