#include "kernels/fabric/fabric_forces.hpp"

namespace drogue::fabric {

template struct FabricForces<DROGUE_INSTANCE_SPACE>;

}  // namespace drogue::fabric
