#pragma once

#include <cstdint>

#include "kernels/fabric/fabric_views.hpp"
#include "kernels/stepping/step_monitor.hpp"

namespace drogue::fabric {

using stepping::StepMonitor;

/// Bound of a finite state: sum of the magnitudes of the positions, m, and velocities, m/s, of a vertex.
inline constexpr double divergence_limit = 1e100;

/// Records a failure for vertex i and the lanes after it whose state at the end of `step` exceeds
/// `divergence_limit` or is not a number.
template <class ExecutionSpace, class R>
KOKKOS_INLINE_FUNCTION void record_divergence(const StepMonitor<ExecutionSpace>& monitor, std::int64_t step,
                                              int i, const Vector3<R>& x, const Vector3<R>& v) {
  using device::absolute;
  const R size =
      absolute(x.x) + absolute(x.y) + absolute(x.z) + absolute(v.x) + absolute(v.y) + absolute(v.z);
  for (int lane = 0; lane < device::Access<R>::lanes; ++lane)
    if (!(device::Access<R>::lane(size, lane) < divergence_limit)) monitor.record_failure(step, i + lane);
}

}  // namespace drogue::fabric
