#pragma once

#include "kernels/gas/solver.hpp"
#include "perf/measurement.hpp"

namespace drogue::perf {

/// Some steps of Sod's problem in seed mode. `parts` takes from the phases of a sample what is timed.
Case seed_case(const std::string& name, const std::string& bound, device::Backend backend,
               const gas::Parameters& parameters,
               const std::function<std::map<std::string, double>(const gas::PhaseTimes&)>& parts);

}  // namespace drogue::perf
