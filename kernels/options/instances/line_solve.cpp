#include "kernels/options/line_solve_on.hpp"

namespace drogue::options {

template std::unique_ptr<linear::BatchSolve> make_line_solve<DROGUE_INSTANCE_SPACE>(const Lines&);

}  // namespace drogue::options
