#include "kernels/device/ceilings_on.hpp"

namespace drogue::device {

template std::unique_ptr<CeilingKernel> make_ceiling<DROGUE_INSTANCE_SPACE>(Ceiling);

}  // namespace drogue::device
