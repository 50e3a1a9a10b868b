#pragma once

#include <string>

#include "common/run/history_reader.hpp"
#include "common/run/result_document.hpp"
#include "miniapps/parachute/scene/scene.hpp"
#include "miniapps/parachute/verify/peak_pulls.hpp"

namespace drogue::parachute_app {

/// Describes the flight of canopy i with a payload in the group `canopy_i` of the result, the keys of which
/// are in docs/parachute-output.md. Means are those of the second half of the run, or of its part after the
/// last cut of a reefing line; each has a 95 % error by its scatter in time, unless the run is too short
/// for one. Warns of a largest force at the end, of a height that a drop does not reach, and of a lean beyond
/// the room in the core. What a run does
/// not show is left out: all means without rows, without a stream or after a release of the payload. Throws
/// only std::bad_alloc.
void describe_flights(const FlowScene& scene, const PeakPulls& peaks, const run::History& history,
                      run::ResultDocument& result);

/// Lines that print these groups and those of bodies; empty without one. Throws only std::bad_alloc.
[[nodiscard]] std::string flight_report(const run::ResultDocument& result);

/// A quantity of a study with its unit for the terminal: `canopy_0.drift` as "canopy[0] drift, m/s"; other
/// names as they are. Throws only std::bad_alloc.
[[nodiscard]] std::string flight_title(const std::string& quantity);

}  // namespace drogue::parachute_app
