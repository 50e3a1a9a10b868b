#include "kernels/gas/seed_solver.hpp"
#include "kernels/gas/solver_on.hpp"

namespace drogue::gas {

template std::unique_ptr<Solver> make_solver<DROGUE_INSTANCE_SPACE>(const Parameters&);
template std::unique_ptr<Solver> make_seed_solver<DROGUE_INSTANCE_SPACE>(const Parameters&);

}  // namespace drogue::gas
