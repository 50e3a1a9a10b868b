#include "miniapps/parachute/verify/peak_pulls.hpp"

#include "common/program/failure.hpp"

namespace drogue::parachute_app {

void PeakPulls::write_watch(run::RestartWriter& writer) const {
  writer.integer("watches_pulls", _watches ? 1 : 0);
}

void PeakPulls::require_watch(const run::RestartReader& reader) const {
  if (_watches && reader.integer("watches_pulls") == 0)
    throw Failure(ExitCode::io_error,
                  "verify.peak_force: the run that wrote the restart file kept no largest forces, since its "
                  "scene lacked the key; start anew, or leave the key out");
}

}  // namespace drogue::parachute_app
