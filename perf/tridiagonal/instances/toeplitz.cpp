#include "perf/tridiagonal/toeplitz_impl.hpp"

namespace drogue::perf::tridiagonal {

template std::unique_ptr<BatchSolver> make_toeplitz_solver<DROGUE_INSTANCE_SPACE>(const ToeplitzBatch&);

}  // namespace drogue::perf::tridiagonal
