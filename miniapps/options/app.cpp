#include "miniapps/options/app.hpp"

#include <iostream>

#include "common/program/communicator.hpp"
#include "common/program/provenance.hpp"
#include "common/program/signals.hpp"
#include "miniapps/options/batch_run.hpp"
#include "miniapps/options/input/shipped_batches.hpp"

namespace drogue::options_app {

ExitCode run_command(const Command& command) {
  const auto print = [](const std::string& text) {
    std::cout << text;
    return ExitCode::ok;
  };
  switch (command.action) {
    case Action::help:
      return print(command.help);
    case Action::version:
      return print(version_text("drogue-options"));
    case Action::list_batches:
      return print(batch_list());
    case Action::convert:
      return convert_parameters(command.conversion);
    case Action::price:
    case Action::surface:
      break;
  }
  Communicator communicator;
  install_signal_handlers();
  try {
    return run_batch(communicator, command);
  } catch (const Failure&) {
    // All ranks throw the same failure; rank 0 reports it.
    if (communicator.is_root()) throw;
    return ExitCode::ok;
  }
}

}  // namespace drogue::options_app
