#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <iterator>
#include <memory>

#include "common/program/signals.hpp"
#include "perf/bisect/bisection.hpp"
#include "perf/cases/cases.hpp"
#include "perf/command/command.hpp"
#include "perf/command/filter.hpp"
#include "perf/profile/kernel_profile.hpp"

namespace drogue::perf {
namespace {

/// Throws Failure(usage) with the nearest name for a case that this program does not have. Of a backend that
/// cannot run here it has no cases, while the built programs may: then the kind alone is checked.
void require_known(const std::string& name) {
  if (missing_backend(name))
    return require_name("kind of cases", name.substr(0, name.find('/')), case_kinds());
  std::vector<Case> cases = all_cases(false);
  std::ranges::move(all_cases(true), std::back_inserter(cases));
  require_case(name, cases);
}

}  // namespace

Command bisect_command(CLI::App& program) {
  const auto options = std::make_shared<BisectOptions>();
  CLI::App* app =
      program.add_subcommand("bisect", "Find the commit that changed the time or the error of a case");
  app->add_option("CASE", options->name, "Name of the case, as list prints it")->required();
  app->add_option("GOOD", options->good, "Commit before the change")->required();
  app->add_option("BAD", options->bad, "Commit after the change, a descendant of GOOD")->required();
  app->add_option("--repository", options->repository, "Folder of the git repository")->capture_default_str();
  app->add_option("--build", options->build, "Shell command that builds a commit")->capture_default_str();
  app->add_option("--program", options->program, "Program that the build makes")->capture_default_str();
  return {app, [options](const std::vector<std::string>&) {
            install_signal_handlers();
            require_known(options->name);
            bisect(*options);
            return ExitCode::ok;
          }};
}

}  // namespace drogue::perf
