#pragma once

#include "kernels/gas/solver.hpp"
#include "perf/measure/measurement.hpp"

namespace drogue::perf {

/// Steps of a sample of some milliseconds; the waves stay away from the ends.
inline constexpr long baseline_steps = 20;

/// The phases h2d, compute and d2h, s.
std::map<std::string, double> all_phases(const gas::PhaseTimes& times);

/// Case of `baseline_steps` steps of Sod's problem by the baseline solver. `parts` selects the timed phases
/// of a sample, s. Does not throw.
Case baseline_case(const std::string& name, const std::string& bound, device::Backend backend,
                   const gas::Parameters& parameters,
                   const std::function<std::map<std::string, double>(const gas::PhaseTimes&)>& parts);

}  // namespace drogue::perf
