#pragma once

#include "common/program/failure.hpp"
#include "miniapps/options/command.hpp"

namespace drogue::options_app {

/// Does what the command line asks for. Throws Failure: also when rows are invalid or failed, after every
/// other row is priced and written.
ExitCode run_app(const Command& command);

}  // namespace drogue::options_app
