#include "kernels/coupling/sheet/solver_adapter.hpp"

namespace drogue::coupling {

template class CoupledSolver<DROGUE_INSTANCE_SPACE>;
template std::unique_ptr<Solver> make_solver<DROGUE_INSTANCE_SPACE>(const Parameters&,
                                                                    const linear::RankGroup&);

}  // namespace drogue::coupling
