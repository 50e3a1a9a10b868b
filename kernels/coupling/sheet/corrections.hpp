#pragma once

#include "kernels/coupling/parameters.hpp"

namespace drogue::coupling {

// Corrections of the exchange by delta functions that suit all sheets. `SheetParameters` has none by itself.

/// `SheetParameters::leak_filter`: the running mean follows within some steps.
inline constexpr double standard_leak_filter = 0.5;

/// `SheetParameters::edge_inset`, cells, that gives disks and plates across a steady stream their drag on 6
/// to 24 cells, at a Courant number > 0 of the run, for sheets with this `leak_filter`: 0.37 to 1. Fitted for
/// cbs43 by `scripts/studies/fit_edge_inset.py`, in proportion to their widths for the others. Does not
/// throw.
[[nodiscard]] double standard_edge_inset(DeltaFunction delta, double courant);

}  // namespace drogue::coupling
