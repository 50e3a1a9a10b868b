#pragma once

#include "kernels/reference/gas/run.hpp"

namespace drogue::reference {

/// Second-order reference scheme: MUSCL-Hancock (Toro 2009, section 14.4, primitive form) with monotonised
/// central slopes (van Leer 1977) and the HLLC flux (Toro 2009, section 10.6, wave speeds of Batten et al.
/// 1997). It computes one flux per face and step in loops that a compiler can vectorise.
///
/// Advances `run` until `end_time` (s) by dt = ramp cfl dx / max(|u|+c), cfl <= 1, and shortens the last step
/// to meet it. It reads gamma, mesh, boundaries, cfl, ramp_steps and max_steps of `p`. Sets `failed` and
/// returns early for an inadmissible state. Throws `std::bad_alloc`.
void muscl_hancock(GasRun& run, const gas::Parameters& p, double end_time);

}  // namespace drogue::reference
