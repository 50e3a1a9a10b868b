#include "kernels/fabric/solver_on.hpp"

namespace drogue::fabric {

template std::unique_ptr<Solver> make_solver<DROGUE_INSTANCE_SPACE>(const Parameters&);

}  // namespace drogue::fabric
