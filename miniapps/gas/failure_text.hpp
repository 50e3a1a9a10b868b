#pragma once

#include <string>

#include "kernels/gas/solver.hpp"

namespace drogue::gas_app {

/// One sentence on why stepping stopped short of its target: quantity, cell, x, step and time.
std::string failure_text(gas::Solver& solver, const gas::Parameters& parameters, gas::Stop stop);

}  // namespace drogue::gas_app
