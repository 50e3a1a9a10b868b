#pragma once

#include <functional>

#include "miniapps/framework/run_output.hpp"

namespace drogue::framework {

/// Settings of a run to the end.
struct RunRequest {
  RunFiles files;
  bool quiet = false;
  bool keeps_restart = true;  ///< the run leaves restart.h5, also at its end unless the scene forbids
  /// Called at every output time, also if no fields are written; may be empty.
  std::function<void()> at_output;
  std::function<void()> before_abort = {};  ///< as of `Communicator::run_or_abort`
};

/// Sets the initial state, or the state of `files.restart`. Collective. Throws `Failure` (io_error) for a
/// restart file that is damaged, belongs to another scene, or is later than the end of the run, and for files
/// of the run directory that cannot be continued; it changes no file.
void set_up(Simulation& simulation, const RunFiles& files);

/// Runs `simulation` to its end, writes the files of the run, and fills in `result`, also if it throws.
/// Collective. Returns `interrupted` after a signal, with the restart file written; otherwise `ok`. Throws
/// `Failure`: numerical_failure once the last good state is on disk, io_error.
ExitCode run_to_end(Simulation& simulation, const RunRequest& request, run::ResultDocument& result);

}  // namespace drogue::framework
