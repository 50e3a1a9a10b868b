#include "kernels/flow/advection/momentum_impl.hpp"

namespace drogue::flow {

template <class ExecutionSpace>
void dispatch_momentum(const ExecutionSpace& space, const MomentumSetup<ExecutionSpace>& setup,
                       Advection advection) {
  choose_momentum<false>(space, setup, advection);
}
template void dispatch_momentum(const DROGUE_INSTANCE_SPACE&, const MomentumSetup<DROGUE_INSTANCE_SPACE>&,
                                Advection);

}  // namespace drogue::flow
