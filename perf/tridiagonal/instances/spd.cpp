#include "perf/tridiagonal/spd_impl.hpp"

namespace drogue::perf::tridiagonal {

template std::unique_ptr<BatchSolver> make_spd_solver<DROGUE_INSTANCE_SPACE>(const SpdBatch&);

}  // namespace drogue::perf::tridiagonal
