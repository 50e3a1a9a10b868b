#pragma once

#include <string>

#include "kernels/gas/solver.hpp"

namespace drogue::gas_app {

/// One sentence on the reason of a premature stop: quantity, cell, x (m), step and time (s). `end_time`: of
/// the scene, s.
std::string failure_text(gas::Solver& solver, const gas::Parameters& parameters, double end_time,
                         gas::Stop stop);

}  // namespace drogue::gas_app
