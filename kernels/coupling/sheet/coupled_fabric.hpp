#pragma once

#include "kernels/coupling/sheet/local_air.hpp"
#include "kernels/fabric/fabric_solver.hpp"

namespace drogue::fabric {

// One translation unit per backend compiles the cloth of coupled solvers.
DROGUE_EXTERN_INSTANCES(class FabricSolver, coupling::AirRelaxation)

}  // namespace drogue::fabric
