#include "perf/raw/kernel_pair.hpp"

namespace drogue::perf::raw {

// Defined in kernel_pair_impl.hpp, instantiated for each backend in instances/.
template <class ExecutionSpace>
std::unique_ptr<KernelPair> make_pair(const GasProblem& problem);
template <class ExecutionSpace>
std::unique_ptr<KernelPair> make_pair(const FabricProblem& problem);
template <class ExecutionSpace>
std::unique_ptr<KernelPair> make_pair(const FlowProblem& problem);

namespace {

template <class Problem>
std::unique_ptr<KernelPair> pair_of(device::Backend backend, const Problem& problem) {
  return device::dispatch(backend,
                          [&]<class ExecutionSpace>() { return make_pair<ExecutionSpace>(problem); });
}

}  // namespace

std::unique_ptr<KernelPair> create_pair(device::Backend backend, const GasProblem& problem) {
  return pair_of(backend, problem);
}
std::unique_ptr<KernelPair> create_pair(device::Backend backend, const FabricProblem& problem) {
  return pair_of(backend, problem);
}
std::unique_ptr<KernelPair> create_pair(device::Backend backend, const FlowProblem& problem) {
  return pair_of(backend, problem);
}

}  // namespace drogue::perf::raw
