#include "perf/raw/kernel_pair.hpp"

#include <Kokkos_Core.hpp>
#include <stdexcept>
#include <type_traits>

#if defined(KOKKOS_ENABLE_CUDA)
#include "perf/raw/fabric_pair.hpp"
#include "perf/raw/flow_pair.hpp"
#include "perf/raw/gas_pair.hpp"
#endif

namespace drogue::perf::raw {

#if !defined(KOKKOS_ENABLE_CUDA)
using GasPair = void;
using FabricPair = void;
using FlowPair = void;
#endif

namespace {

template <class Pair, class Problem>
std::unique_ptr<KernelPair> pair_of([[maybe_unused]] device::Backend backend,
                                    [[maybe_unused]] const Problem& problem) {
  if constexpr (!std::is_void_v<Pair>)
    if (backend == device::Backend::cuda) return std::make_unique<Pair>(problem);
  throw std::invalid_argument("kernels written by hand exist for the backend cuda alone");
}

}  // namespace

std::unique_ptr<KernelPair> create_pair(device::Backend backend, const GasProblem& problem) {
  return pair_of<GasPair>(backend, problem);
}
std::unique_ptr<KernelPair> create_pair(device::Backend backend, const FabricProblem& problem) {
  return pair_of<FabricPair>(backend, problem);
}
std::unique_ptr<KernelPair> create_pair(device::Backend backend, const FlowProblem& problem) {
  return pair_of<FlowPair>(backend, problem);
}

}  // namespace drogue::perf::raw
