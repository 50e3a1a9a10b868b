#pragma once

#include "perf/work_precision/solution.hpp"

namespace drogue::perf {

/// Name of the problem and of the shipped scene.
inline constexpr const char* cavity_problem = "cavity";

/// Runs the lid-driven cavity at Re 100 until it is steady by the schemes of `flow_schemes` that solve
/// directly. The error is the largest deviation of an extreme velocity on the centre lines, m/s. Blocks, or
/// returns false after a signal. Throws Failure for a scene that cannot be read.
bool cavity_work_precision(const Selection& selection, const SolutionSink& sink);

}  // namespace drogue::perf
