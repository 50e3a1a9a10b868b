#include "kernels/gas/baseline/baseline_solver.hpp"
#include "kernels/gas/solver_adapter.hpp"

namespace drogue::gas {

template class GasSolver<DROGUE_INSTANCE_SPACE>;
template std::unique_ptr<Solver> make_solver<DROGUE_INSTANCE_SPACE>(const Parameters&);
template std::unique_ptr<Solver> make_baseline_solver<DROGUE_INSTANCE_SPACE>(const Parameters&);

}  // namespace drogue::gas
