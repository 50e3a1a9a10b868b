#pragma once

#include "kernels/reference/gas/run.hpp"

namespace drogue::reference {

/// The second-order competitor: MUSCL-Hancock (Toro 2009, section 14.4, primitive form) with slopes limited
/// by monotonised central differences (van Leer 1977) and the HLLC flux (Toro 2009, section 10.6, signal
/// speeds of Batten et al. 1997). One flux a face and step, loops over rows that a compiler can vectorise.
///
/// Advances `run` until `end_time` by dt = ramp cfl dx / max(|u|+c), cfl <= 1, the last step shortened to
/// meet it; of `p` it reads gamma, mesh, boundaries, cfl, ramp_steps and max_steps. Returns early with
/// `failed` set.
void muscl_hancock(GasRun& run, const gas::Parameters& p, double end_time);

}  // namespace drogue::reference
