#include "kernels/options/batch/pricer_adapter.hpp"

namespace drogue::options {

template class PidePricer<DROGUE_INSTANCE_SPACE>;
template std::unique_ptr<Pricer> make_pide<DROGUE_INSTANCE_SPACE>(const Settings&);

}  // namespace drogue::options
