#pragma once

#include "common/run/history_reader.hpp"
#include "common/run/result_document.hpp"
#include "common/run/run_directory.hpp"
#include "miniapps/parachute/scene/scene.hpp"
#include "miniapps/parachute/verify/peak_pulls.hpp"

namespace drogue::parachute_app {

/// The history.csv of a run if one of the checks here and of curves is of its rows, or a flight is described
/// by them, else nothing. Throws `Failure` (io_error).
[[nodiscard]] run::History rows_of(const FlowScene& scene, const run::RunDirectory* directory);

/// Checks of canopies. Throws only std::bad_alloc.
void check_canopies(const Verify& wanted, const PeakPulls& peaks, const run::History& history,
                    run::ResultDocument& result);

/// Strain below which energies of cloth are round-off: that of a cloth drop at rest is compared with the
/// elastic energy of its cloth at this strain along one direction.
inline constexpr double least_strain = 1e-6;

/// Check of the energy of a cloth drop. Throws only std::bad_alloc.
void check_energy_drift(const FlowScene& scene, const run::History& history, run::ResultDocument& result);

}  // namespace drogue::parachute_app
