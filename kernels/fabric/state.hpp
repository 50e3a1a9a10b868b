#pragma once

#include "kernels/fabric/fabric_views.hpp"

namespace drogue::fabric {

/// Device-resident state of a fabric. The addresses are stable for the life of the solver.
///
/// Both Views have the shape (vertices, 3) in layout left. Components are `positions.stride(1)` numbers
/// apart, which is the number of vertices padded to a multiple of `slice`; the padding belongs to the solver.
template <class ExecutionSpace>
struct State {
  PointsView<ExecutionSpace> positions;   ///< m
  PointsView<ExecutionSpace> velocities;  ///< m/s; a pinned axis moves at its velocity
};

}  // namespace drogue::fabric
