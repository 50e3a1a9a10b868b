#pragma once

#include "kernels/fabric/status.hpp"
#include "kernels/fabric/watch.hpp"

namespace drogue::fabric {

/// The time at which a kernel works: the steps taken are read where it runs, so that no step waits for the
/// host's word and a recorded step stays true.
template <class ExecutionSpace>
struct Timing {
  Watch<ExecutionSpace> watch;
  Clock clock;  ///< of which `step` says nothing
  int hand;     ///< of the watch, that tells the steps taken
  double part;  ///< of a step that has gone by since

  KOKKOS_FUNCTION double time() const {
    return clock.start + (static_cast<double>(watch.steps(hand) - clock.since) + part) * clock.dt;
  }
};

}  // namespace drogue::fabric
