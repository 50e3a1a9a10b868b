#pragma once

#include "kernels/device/host_cores.hpp"
#include "kernels/gas/parameters.hpp"

namespace drogue::gas {

/// Number of host threads for a mesh. A thread with fewer than four tiles costs more than it saves. Does not
/// throw.
inline int host_threads(const Parameters& p) { return device::useful_threads(p.cells, 1024); }

}  // namespace drogue::gas
