#include "kernels/flow/solver_adapter.hpp"

namespace drogue::flow {

template class FlowSolver<DROGUE_INSTANCE_SPACE>;
template std::unique_ptr<Solver> make_solver<DROGUE_INSTANCE_SPACE>(const Parameters&,
                                                                    const linear::RankGroup&);

}  // namespace drogue::flow
