#pragma once

#include <filesystem>

#include "miniapps/framework/mini_app.hpp"

namespace drogue::framework {

/// Runs the scene `file` in the run directory of the options. result.json describes the end of the run,
/// however it ended; a scene or command line with an error leaves a former run as it is. Throws `Failure`;
/// returns `ok` or `interrupted`. `communicator`: of several ranks, called on rank 0; null: one rank.
ExitCode run_scene(const MiniApp& app, const MiniAppOptions& options, const std::filesystem::path& file,
                   Communicator* communicator);

}  // namespace drogue::framework
