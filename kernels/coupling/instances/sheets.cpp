#include "kernels/coupling/sheet/immersed_sheet.hpp"

namespace drogue::coupling {

template class ImmersedSheet<DROGUE_INSTANCE_SPACE>;
template class SharpSheet<DROGUE_INSTANCE_SPACE>;

}  // namespace drogue::coupling
