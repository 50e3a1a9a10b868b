#pragma once

#include <vector>

#include "kernels/flow/parameters.hpp"
#include "perf/work_precision/solution.hpp"

namespace drogue::perf {

/// Scheme of a flow solver: a curve of a work-precision diagram. No function throws but std::bad_alloc.
struct FlowScheme {
  flow::Advection advection;
  flow::TimeScheme time;
  flow::PressureSolver pressure;
  flow::Diffusion diffusion;

  /// Sets the scheme, and the CFL number: 0.5 with AB2, 1 with RK3, which is stable with longer steps.
  void apply(flow::Parameters& parameters) const;

  /// Sets the label of a solution and the facts of its record.
  void describe(Solution& solution) const;
};

/// All combinations of advection, time scheme and direct pressure solver, implicit diffusion with AB2, and
/// hypre with WENO-Z. `quick` selects WENO-Z, the central scheme and transforms.
std::vector<FlowScheme> flow_schemes(bool quick);

}  // namespace drogue::perf
