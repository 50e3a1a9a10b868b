#pragma once

#include <Kokkos_Core.hpp>
#include <cstdint>

#include "kernels/device/relaxed_access.hpp"
#include "kernels/flow/observables/extremes.hpp"
#include "kernels/flow/views.hpp"

namespace drogue::flow {

/// Contribution of a rank to the control block of a step, of integers alone: of each, the ranks agree on the
/// largest.
struct Agreement : StepMaxima {
  std::uint64_t before_failure;  ///< complement of `Control::first_failure`
  std::uint64_t pressure_failed, failed_side;
  std::uint64_t interrupted;  ///< 1 if this rank asks for the end of the advance
};

/// Writes the contribution of this rank. `interrupt`: its wish, in host memory; null: none.
template <class ExecutionSpace>
struct ContributeFunctor {
  ControlView<ExecutionSpace> control;
  Agreement* agreement;
  const int* interrupt;

  KOKKOS_FUNCTION void operator()(int) const {
    const Control& c = control();
    *agreement = {c, ~c.first_failure, static_cast<std::uint64_t>(c.pressure_failed),
                  static_cast<std::uint64_t>(c.failed_side),
                  interrupt != nullptr ? static_cast<std::uint64_t>(device::relaxed_load(interrupt)) : 0};
  }
};

/// Takes over what the ranks agreed on.
template <class ExecutionSpace>
struct AdoptFunctor {
  ControlView<ExecutionSpace> control;
  const Agreement* agreement;

  KOKKOS_FUNCTION void operator()(int) const {
    Control& c = control();
    static_cast<StepMaxima&>(c) = *agreement;
    c.first_failure = ~agreement->before_failure;
    c.pressure_failed = static_cast<int>(agreement->pressure_failed);
    c.failed_side = static_cast<int>(agreement->failed_side);
    c.interrupted = static_cast<int>(agreement->interrupted);
  }
};

/// Fails for the net inflow of all ranks, from the net inflow and the magnitude of each, m^3/s.
template <class ExecutionSpace>
struct CheckInflowOfRanksFunctor {
  ControlView<ExecutionSpace> control;
  const double* of_ranks;
  int ranks;

  KOKKOS_FUNCTION void operator()(int) const {
    Control& c = control();
    if (c.is_unbalanced != 0) return;
    double net = 0.0, magnitude = 0.0;
    for (int rank = 0; rank < ranks; ++rank) {
      net += of_ranks[2 * rank];
      magnitude += of_ranks[2 * rank + 1];
    }
    c.is_unbalanced = is_unbalanced(net, magnitude);
    if (c.is_unbalanced != 0) c.net_inflow = net;
  }
};

/// Combines the energies of all ranks, in the order of the ranks.
template <class ExecutionSpace>
struct CombineEnergiesOfRanksFunctor {
  EnergyView<ExecutionSpace> whole;
  const double* of_ranks;
  int ranks;

  KOKKOS_FUNCTION void operator()(int) const {
    double sum = 0.0, largest = 0.0;
    for (int rank = 0; rank < ranks; ++rank) {
      sum += of_ranks[2 * rank];
      largest = larger_or_nan(largest, of_ranks[2 * rank + 1]);
    }
    whole(0, 0) = sum;
    whole(0, 1) = largest;
  }
};

}  // namespace drogue::flow
