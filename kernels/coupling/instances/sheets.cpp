#include "kernels/coupling/sharp/sharp_sheet.hpp"
#include "kernels/coupling/sheet/air_drag.hpp"
#include "kernels/coupling/sheet/immersed_sheet.hpp"

namespace drogue::coupling {

template class AirDrag<DROGUE_INSTANCE_SPACE>;
template class Sheet<DROGUE_INSTANCE_SPACE>;
template class ImmersedSheet<DROGUE_INSTANCE_SPACE>;
template class SharpSheet<DROGUE_INSTANCE_SPACE>;

}  // namespace drogue::coupling
