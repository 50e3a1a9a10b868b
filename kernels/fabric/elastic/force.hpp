#pragma once

#include "kernels/fabric/launch.hpp"

namespace drogue::fabric {

/// Elastic forces and loads, N, at given positions.
template <class ExecutionSpace, ConstitutiveModel model>
struct ForceFunctor {
  using R = PackedReal<ExecutionSpace>;
  using Bounds = Kokkos::LaunchBounds<>;
  FabricViews<ExecutionSpace> fabric;
  PointsView<ExecutionSpace> x, out;

  KOKKOS_FUNCTION void operator()(const int pack) const {
    const int i = pack * device::Access<R>::lanes;
    store_points(out, i, force<model, R>(fabric, x, i));
  }
};

}  // namespace drogue::fabric
