#pragma once

#include <vector>

#include "common/run/restart/restart_file.hpp"
#include "miniapps/parachute/canopy/canopy_state.hpp"

namespace drogue::parachute_app {

/// Largest forces of the lines on the payloads of the canopies in all steps of a run, from its first start
/// on. A run that continues has them with the state of its solver.
class PeakPulls {
 public:
  /// For a number of canopies. `watches`: whether the solver records them.
  PeakPulls(std::size_t canopies, bool watches) : _watches(watches), _peaks(canopies) {}

  /// Lets a solver of cloth record them, before its start. Throws as its `watch_pulls`.
  template <class Solver>
  void watch(Solver& solver, const Sheets& sheets) const {
    if (_watches) solver.watch_pulls(pulls_on_payloads(sheets));
  }

  /// Takes them over from the solver. Throws as its `peak_pulls`.
  template <class Solver>
  void update(Solver& solver) {
    if (_watches) _peaks = solver.peak_pulls();
  }

  /// One per canopy, of all steps up to the last update. Does not throw.
  [[nodiscard]] const std::vector<fabric::PeakPull>& values() const { return _peaks; }

  /// Writes whether the solver records them. Throws `Failure` (io_error).
  void write_watch(run::RestartWriter& writer) const;

  /// Throws `Failure` (io_error) if the file lacks those that the scene verifies.
  void require_watch(const run::RestartReader& reader) const;

 private:
  bool _watches;
  std::vector<fabric::PeakPull> _peaks;
};

}  // namespace drogue::parachute_app
