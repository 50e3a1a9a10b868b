#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <memory>

#include "common/program/signals.hpp"
#include "perf/bisect/bisection.hpp"
#include "perf/command/command.hpp"

namespace drogue::perf {

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
            bisect(*options);
            return ExitCode::ok;
          }};
}

}  // namespace drogue::perf
