#pragma once

#include <cstdint>

#include "kernels/flow/parameters.hpp"

namespace drogue::perf {

/// Bytes per step between memory and the kernels of `kernels/flow`, if every kernel reads each of its arrays
/// once and writes it once: a lower bound of the traffic of this division into kernels. Ghost cells and sides
/// are left out. `parameters`: without an external force, with a direct pressure solver. Does not throw.
[[nodiscard]] double flow_step_bytes(const flow::Parameters& parameters);

/// Kernels of a Runge-Kutta step of `kernels/fabric` in plain launches or a graph.
enum class FabricKernels {
  halves,  ///< two stages each, as on a device; triangles at rest follow from positions
  stages,  ///< one stage each, as on a host; slots store triangles at rest
};

/// Bytes per Runge-Kutta step between memory and the kernels of a sheet, if every kernel reads each of its
/// arrays once and writes it once: a lower bound. `slots` of the ring adjacency; no loads and no springs.
/// Does not throw.
[[nodiscard]] double fabric_step_bytes(FabricKernels kernels, std::int64_t vertices, std::int64_t slots);

}  // namespace drogue::perf
