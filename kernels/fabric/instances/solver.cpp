#include "kernels/fabric/solver_adapter.hpp"

namespace drogue::fabric {

template class FabricSolver<DROGUE_INSTANCE_SPACE>;
template std::unique_ptr<Solver> make_solver<DROGUE_INSTANCE_SPACE>(const Parameters&);

}  // namespace drogue::fabric
