#include "perf/models/step_bytes.hpp"

namespace drogue::perf {

namespace {

constexpr double scalar = 8.0;           ///< bytes of a number
constexpr double vector = 3.0 * scalar;  ///< bytes of a velocity

/// Bytes per unknown of a direct solve: a transform or product forward and one backward along each axis, and
/// the scaling by the eigenvalues, each with one array read and one written.
double solve_bytes(const flow::Parameters& p) {
  int axes = 0;
  for (const int n : p.cells) axes += n > 1 ? 1 : 0;
  return (2.0 * axes + 1.0) * 2.0 * scalar;
}

}  // namespace

double flow_step_bytes(const flow::Parameters& p) {
  const double divergence = vector + scalar, correction = scalar + 2.0 * vector;
  const double projection = divergence + solve_bytes(p) + correction;
  const bool two_steps = p.time_scheme == flow::TimeScheme::ab2;
  double cell = 0.0;
  if (two_steps) {
    cell = 4.0 * vector + projection;  // velocity and old rate to new rate and predicted velocity
  } else {
    // The state of the first stage is its own velocity.
    cell = 2.0 * vector + 2.0 * 3.0 * vector + 3.0 * projection;
  }
  // The last correction writes the pressure, unless it adds an increment.
  if (p.diffusion == flow::Diffusion::explicit_) cell += scalar;
  if (p.diffusion == flow::Diffusion::crank_nicolson) {
    // Each component: predicted velocity, velocity and pressure to the source; solve; velocity and change to
    // the predicted velocity.
    cell += 3.0 * (4.0 * scalar + solve_bytes(p) + 3.0 * scalar);
    // The correction also reads the divergence and adds to the pressure.
    cell += 3.0 * scalar;
  }
  // A stage: velocity to eddy viscosity, both to an acceleration, which the momentum reads.
  if (p.turbulence != flow::Turbulence::none)
    cell += (two_steps ? 1.0 : 3.0) * (vector + scalar + vector + scalar + vector + vector);
  return cell * p.cells[0] * p.cells[1] * p.cells[2];
}

double fabric_step_bytes(FabricKernels kernels, std::int64_t vertices, std::int64_t slots) {
  constexpr double number = 4.0, vertex = 8.0 + 1.0;  // inverse mass and fixed axes
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
