#include "kernels/gas/stepping/launch_tiles.hpp"

namespace drogue::gas {

template void launch_step<Reconstruction::js>(const DROGUE_INSTANCE_SPACE&,
                                              const StageSetup<DROGUE_INSTANCE_SPACE>&, Precision, bool);
template void launch_persistent_steps<Reconstruction::js>(const StageSetup<DROGUE_INSTANCE_SPACE>&,
                                                          const PersistentSetup<DROGUE_INSTANCE_SPACE>&,
                                                          Precision, std::int64_t);
template void launch_step<Reconstruction::z1>(const DROGUE_INSTANCE_SPACE&,
                                              const StageSetup<DROGUE_INSTANCE_SPACE>&, Precision, bool);
template void launch_persistent_steps<Reconstruction::z1>(const StageSetup<DROGUE_INSTANCE_SPACE>&,
                                                          const PersistentSetup<DROGUE_INSTANCE_SPACE>&,
                                                          Precision, std::int64_t);
template void launch_step<Reconstruction::z2>(const DROGUE_INSTANCE_SPACE&,
                                              const StageSetup<DROGUE_INSTANCE_SPACE>&, Precision, bool);
template void launch_persistent_steps<Reconstruction::z2>(const StageSetup<DROGUE_INSTANCE_SPACE>&,
                                                          const PersistentSetup<DROGUE_INSTANCE_SPACE>&,
                                                          Precision, std::int64_t);
template void launch_step<Reconstruction::m>(const DROGUE_INSTANCE_SPACE&,
                                             const StageSetup<DROGUE_INSTANCE_SPACE>&, Precision, bool);
template void launch_persistent_steps<Reconstruction::m>(const StageSetup<DROGUE_INSTANCE_SPACE>&,
                                                         const PersistentSetup<DROGUE_INSTANCE_SPACE>&,
                                                         Precision, std::int64_t);
template void launch_step<Reconstruction::teno5>(const DROGUE_INSTANCE_SPACE&,
                                                 const StageSetup<DROGUE_INSTANCE_SPACE>&, Precision, bool);
template void launch_persistent_steps<Reconstruction::teno5>(const StageSetup<DROGUE_INSTANCE_SPACE>&,
                                                             const PersistentSetup<DROGUE_INSTANCE_SPACE>&,
                                                             Precision, std::int64_t);

}  // namespace drogue::gas
