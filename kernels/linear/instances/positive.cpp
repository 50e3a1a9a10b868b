#include "kernels/linear/positive_on.hpp"

namespace drogue::linear {

template std::unique_ptr<BatchSolve> make_positive_solve<DROGUE_INSTANCE_SPACE>(const PositiveSystems&);

}  // namespace drogue::linear
