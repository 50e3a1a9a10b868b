#pragma once

#include "miniapps/framework/simulation.hpp"
#include "miniapps/parachute/verify/canopy_record.hpp"

namespace drogue::parachute_app {

/// Checks of canopies in the rows of a run. Throws only std::bad_alloc.
void check_canopies(const Verify& wanted, const CanopyRecord& record, run::ResultDocument& result);

/// Checks of the oscillations of columns of history.csv. Throws `Failure` (io_error).
void check_oscillations(const Verify& wanted, const run::RunDirectory* directory,
                        run::ResultDocument& result);

/// Strain below which energies of cloth are round-off: that of a cloth drop at rest is compared with the
/// elastic energy of its cloth at this strain along one direction.
inline constexpr double least_strain = 1e-6;

/// Check of the energy of a cloth drop in history.csv. Throws `Failure` (io_error).
void check_energy_drift(const FlowScene& scene, const run::RunDirectory* directory,
                        run::ResultDocument& result);

}  // namespace drogue::parachute_app
