#pragma once

#include "kernels/flow/parameters.hpp"

namespace drogue::perf {

/// Bytes per step between memory and the kernels of `kernels/flow`, if every kernel reads each of its arrays
/// once and writes it once: a lower bound of the traffic of this division into kernels. Ghost cells and sides
/// are left out. `parameters`: without an external force, with a direct pressure solver. Does not throw.
[[nodiscard]] double flow_step_bytes(const flow::Parameters& parameters);

}  // namespace drogue::perf
