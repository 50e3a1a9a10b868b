#pragma once

#include "miniapps/framework/simulation.hpp"
#include "miniapps/parachute/verify/canopy_record.hpp"

namespace drogue::parachute_app {

/// Checks of canopies in the rows of a run. Throws only std::bad_alloc.
void check_canopies(const Verify& wanted, const CanopyRecord& record, run::ResultDocument& result);

/// Checks of the oscillations of columns of history.csv. Throws `Failure` (io_error).
void check_oscillations(const Verify& wanted, const run::RunDirectory* directory,
                        run::ResultDocument& result);

/// Check of the energy of a cloth drop in history.csv. Throws `Failure` (io_error).
void check_energy_drift(const Verify& wanted, const run::RunDirectory* directory,
                        run::ResultDocument& result);

}  // namespace drogue::parachute_app
