#pragma once

#include "kernels/fabric/results.hpp"
#include "kernels/fabric/stepping/divergence.hpp"
#include "kernels/fabric/views.hpp"

namespace drogue::fabric {

/// Saved part of a run: positions, m, velocities, m/s, and the work of contact, which is empty without.
template <class ExecutionSpace>
struct SavedState {
  PointsView<ExecutionSpace> x, v;
  ListView<ExecutionSpace, ContactWork> work;
  ListView<ExecutionSpace, PeakPull> peaks;
};

/// Copies the state of vertex i, for `stepping::Checkpoint`.
template <class ExecutionSpace>
struct CopyStateFunctor {
  SavedState<ExecutionSpace> from, to;

  KOKKOS_FUNCTION void operator()(const int i) const {
    store_points(to.x, i, load_points<double>(from.x, i));
    store_points(to.v, i, load_points<double>(from.v, i));
    if (i < static_cast<int>(from.work.extent(0))) to.work(i) = from.work(i);
    if (i < static_cast<int>(from.peaks.extent(0))) to.peaks(i) = from.peaks(i);
  }
};

}  // namespace drogue::fabric
