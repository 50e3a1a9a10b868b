#include "kernels/options/pricer_on.hpp"

namespace drogue::options {

template std::unique_ptr<Pricer> make_pide<DROGUE_INSTANCE_SPACE>(const Settings&);

}  // namespace drogue::options
