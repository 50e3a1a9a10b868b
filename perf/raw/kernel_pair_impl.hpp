#pragma once

#include <stdexcept>

#include "kernels/device/memory.hpp"
#include "perf/raw/kernel_pair.hpp"

#if defined(KOKKOS_ENABLE_CUDA)
#include "perf/raw/fabric_pair.hpp"
#include "perf/raw/flow_pair.hpp"
#include "perf/raw/gas_pair.hpp"
#endif

namespace drogue::perf::raw {

/// Pair on an execution space. Throws as `create_pair` does.
template <class ExecutionSpace, class Problem>
std::unique_ptr<KernelPair> make_pair_of(const Problem& problem) {
#if defined(KOKKOS_ENABLE_CUDA)
  if constexpr (std::is_same_v<ExecutionSpace, Kokkos::Cuda>) {
    if constexpr (std::is_same_v<Problem, GasProblem>) return std::make_unique<GasPair>(problem);
    if constexpr (std::is_same_v<Problem, FabricProblem>) return std::make_unique<FabricPair>(problem);
    if constexpr (std::is_same_v<Problem, FlowProblem>) return std::make_unique<FlowPair>(problem);
  }
#endif
  static_cast<void>(problem);
  throw std::invalid_argument("kernels written by hand exist for the backend cuda alone");
}

template <class ExecutionSpace>
std::unique_ptr<KernelPair> make_pair(const GasProblem& problem) {
  return make_pair_of<ExecutionSpace>(problem);
}
template <class ExecutionSpace>
std::unique_ptr<KernelPair> make_pair(const FabricProblem& problem) {
  return make_pair_of<ExecutionSpace>(problem);
}
template <class ExecutionSpace>
std::unique_ptr<KernelPair> make_pair(const FlowProblem& problem) {
  return make_pair_of<ExecutionSpace>(problem);
}

}  // namespace drogue::perf::raw
