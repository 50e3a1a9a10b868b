#include "kernels/options/cos/bermudan_impl.hpp"

namespace drogue::options {

template std::unique_ptr<BermudanSolver> make_bermudan_solver<DROGUE_INSTANCE_SPACE>(int block);

}  // namespace drogue::options
