#include "kernels/options/batch/pricer_impl.hpp"

namespace drogue::options {

template std::unique_ptr<Pricer> make_pide<DROGUE_INSTANCE_SPACE>(const Settings&);

}  // namespace drogue::options
