#pragma once

#include <memory>
#include <span>

#include "kernels/device/backend.hpp"
#include "kernels/fabric/parameters.hpp"

namespace drogue::fabric {

/// Cloth and strings that live on a backend and move there. Needs an initialised runtime.
///
/// Life: `upload`, then `advance` as often as wanted.
class Solver {
 public:
  virtual ~Solver() = default;

  /// Positions, m, and velocities, m/s, of all vertices. Spans of another length throw std::invalid_argument,
  /// here and below.
  virtual void upload(std::span<const Vector> positions, std::span<const Vector> velocities) = 0;
  virtual void download(std::span<Vector> positions, std::span<Vector> velocities) = 0;

  /// Takes `steps` steps of `Parameters::dt`. Returns before they are done. How steps are cut into calls
  /// changes no bit.
  virtual void advance(std::int64_t steps) = 0;

  /// The elastic and dead forces where the vertices are now, N.
  virtual void forces(std::span<Vector> forces) = 0;
};

/// Throws std::invalid_argument for parameters out of range; the backend must be available.
[[nodiscard]] std::unique_ptr<Solver> create_solver(device::Backend backend, const Parameters& parameters);

}  // namespace drogue::fabric
