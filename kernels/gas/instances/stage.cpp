#include "kernels/gas/stepping/launch_tiles.hpp"

namespace drogue::gas {

template void launch_stage<Reconstruction::js>(const DROGUE_INSTANCE_SPACE&,
                                               const StageSetup<DROGUE_INSTANCE_SPACE>&, Precision, bool,
                                               int);
template void launch_stage<Reconstruction::z1>(const DROGUE_INSTANCE_SPACE&,
                                               const StageSetup<DROGUE_INSTANCE_SPACE>&, Precision, bool,
                                               int);
template void launch_stage<Reconstruction::z2>(const DROGUE_INSTANCE_SPACE&,
                                               const StageSetup<DROGUE_INSTANCE_SPACE>&, Precision, bool,
                                               int);
template void launch_stage<Reconstruction::m>(const DROGUE_INSTANCE_SPACE&,
                                              const StageSetup<DROGUE_INSTANCE_SPACE>&, Precision, bool, int);
template void launch_stage<Reconstruction::teno5>(const DROGUE_INSTANCE_SPACE&,
                                                  const StageSetup<DROGUE_INSTANCE_SPACE>&, Precision, bool,
                                                  int);

}  // namespace drogue::gas
