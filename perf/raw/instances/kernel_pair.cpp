#include "perf/raw/kernel_pair_impl.hpp"

namespace drogue::perf::raw {

template std::unique_ptr<KernelPair> make_pair<DROGUE_INSTANCE_SPACE>(const GasProblem&);
template std::unique_ptr<KernelPair> make_pair<DROGUE_INSTANCE_SPACE>(const FabricProblem&);
template std::unique_ptr<KernelPair> make_pair<DROGUE_INSTANCE_SPACE>(const FlowProblem&);

}  // namespace drogue::perf::raw
