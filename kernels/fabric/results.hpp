#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "kernels/stepping/status.hpp"

namespace drogue::fabric {

using stepping::TimeState;

/// Reason of a failed step.
enum class FailureReason {
  not_finite,
  crossing,              ///< parts of cloth, or cloth and a body, cross in spite of rigid impact zones
  too_fast,              ///< a vertex moved beyond the margin of the neighbour lists
  too_dense,             ///< the neighbours of a part exceed the capacity
  no_number,             ///< the expression of a level set, or its slope, is NaN at a vertex
  too_many_constraints,  ///< the constraints of a vertex, or of all, exceed the capacity
};

/// First failed step; `index` is the least vertex that failed in it.
using StepFailure = stepping::StepFailure<FailureReason>;

/// Work of contact on a vertex, negative for dissipation, and the velocity change on which friction depends.
struct ContactWork {
  double normal = 0.0;                              ///< J, of normal impulses and rigid impact zones
  double friction = 0.0;                            ///< J, of friction
  double kick_x = 0.0, kick_y = 0.0, kick_z = 0.0;  ///< m/s, velocity change by forces in the last step
  bool operator==(const ContactWork&) const = default;
};

/// Lines that pull on a vertex.
struct Pull {
  int vertex = 0;
  std::vector<int> lines;  ///< numbers in the mesh
};

/// Largest magnitude so far of the force of a pull, and when it first acted.
struct PeakPull {
  double force = 0.0;  ///< N
  double time = 0.0;   ///< s
};

/// Sums over all vertices.
struct Totals {
  double kinetic = 0.0;  ///< J
  double elastic = 0.0;  ///< J
  double gravity = 0.0;  ///< J, -sum of m g x
  double load = 0.0;     ///< J, minus the work of dead loads from the origin to the present positions
  std::array<double, 3> momentum{};          ///< kg m/s
  std::array<double, 3> angular_momentum{};  ///< kg m^2/s, about the origin
  double contact = 0.0;   ///< J, work of contact without friction since the construction of the solver
  double friction = 0.0;  ///< J, work of friction in contact

  /// Total energy, J, which is constant without damping, moving pins and loads that change. Does not throw.
  [[nodiscard]] double energy() const { return kinetic + elastic + gravity + load; }
};

/// Force per length at rest (nominal) or per present length (Cauchy).
enum class StressMeasure { nominal, cauchy };

/// Stress of a membrane, force per length, N/m.
struct Stress {
  double major = 0.0, minor = 0.0;    ///< principal values
  std::array<double, 3> direction{};  ///< of the major one: unit vector in the present plane
  std::array<double, 3> across{};     ///< of the minor one: unit vector

  /// Stress tensor, N/m: xx, xy, xz, yy, yz, zz. Does not throw.
  [[nodiscard]] std::array<double, 6> tensor() const {
    std::array<double, 6> sum{};
    std::size_t k = 0;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = i; j < 3; ++j)
        sum[k++] = major * direction[i] * direction[j] + minor * across[i] * across[j];
    return sum;
  }

  /// Von Mises stress of plane stress, N/m ([Shi], eq. (2.19)). Does not throw.
  [[nodiscard]] double von_mises() const { return std::sqrt(major * major - major * minor + minor * minor); }
};

}  // namespace drogue::fabric
