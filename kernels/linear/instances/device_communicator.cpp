#include "kernels/linear/device_communicator.hpp"

namespace drogue::linear {

template class DeviceCommunicator<DROGUE_INSTANCE_SPACE>;

}  // namespace drogue::linear
