#include "kernels/flow/advection/momentum_impl.hpp"

namespace drogue::flow {

template void dispatch_stretched_momentum(const DROGUE_INSTANCE_SPACE&,
                                          const MomentumSetup<DROGUE_INSTANCE_SPACE>&, Advection);

}  // namespace drogue::flow
