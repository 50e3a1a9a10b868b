#include "perf/models/fabric_step.hpp"

namespace drogue::perf {

double fabric_step_bytes(FabricKernels kernels, std::int64_t vertices, std::int64_t slots) {
  constexpr double vector = 24.0, number = 4.0, vertex = 8.0 + 1.0;  // inverse mass and fixed axes
  const auto n = static_cast<double>(vertices), rings = static_cast<double>(slots);
  if (kernels == FabricKernels::halves) {
    // Position and velocity to two positions and velocities; then these and the state to the new state.
    const double begin = 2.0 * vector + 4.0 * vector, end = 2.0 * vector + 4.0 * vector + 2.0 * vector;
    const double rest = vector;  // in both
    return n * (begin + end + 2.0 * (rest + vertex)) + 2.0 * number * rings;
  }
  const double slot = number + 3.0 * 8.0;
  // Position of the stage and of the step, both velocities, next position and velocity. The first stage has
  // one velocity; the last one reads those of the second and the third, too.
  const double stage = 6.0 * vector;
  return n * (4.0 * (stage + vertex) - vector + 2.0 * vector) + 4.0 * slot * rings;
}

}  // namespace drogue::perf
