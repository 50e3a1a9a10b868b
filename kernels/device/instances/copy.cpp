#include "kernels/device/copy_impl.hpp"

namespace drogue::device {

template void copy_bytes(const DROGUE_INSTANCE_SPACE&, CopyKind, void*, const void*, std::size_t);

}  // namespace drogue::device
