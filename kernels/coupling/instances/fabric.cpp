#include "kernels/coupling/sheet/coupled_fabric.hpp"

namespace drogue::fabric {

template class FabricSolver<DROGUE_INSTANCE_SPACE, coupling::AirRelaxation<DROGUE_INSTANCE_SPACE>>;

}  // namespace drogue::fabric
