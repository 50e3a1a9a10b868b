#include "miniapps/parachute/verify/peak_pulls.hpp"

#include <string>

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

void PeakPulls::write(run::RestartWriter& writer) const {
  write_watch(writer);
  for (std::size_t i = 0; i < _peaks.size(); ++i) {
    writer.number("peak_force_" + std::to_string(i), _peaks[i].force);
    writer.number("peak_force_time_" + std::to_string(i), _peaks[i].time);
  }
}

void PeakPulls::read(const run::RestartReader& reader) {
  require_watch(reader);
  for (std::size_t i = 0; i < _peaks.size(); ++i)
    _peaks[i] = {reader.number("peak_force_" + std::to_string(i)),
                 reader.number("peak_force_time_" + std::to_string(i))};
}

}  // namespace drogue::parachute_app
