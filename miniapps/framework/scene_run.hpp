#pragma once

#include <filesystem>

#include "miniapps/framework/mini_app.hpp"

namespace drogue::framework {

/// Runs the scene `file` in the run directory of the options. result.json describes the end of the run,
/// however it ended; a scene or command line with an error leaves a former run as it is. Throws `Failure`;
/// returns `ok` or `interrupted`. Collective: every rank takes the same steps, and rank 0 prints and writes.
ExitCode run_scene(const MiniApp& app, const MiniAppOptions& options, const std::filesystem::path& file,
                   Communicator& communicator);

}  // namespace drogue::framework
