#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "kernels/stepping/status.hpp"

namespace drogue::fabric {

using stepping::TimeState;

/// Reason of a lost state.
enum class FailureReason {
  not_finite,
  crossing,   ///< parts of cloth, or cloth and a body, that no zone keeps from crossing
  too_fast,   ///< a vertex moved farther in a step than contact looks
  too_dense,  ///< more parts near one another than there is room for
  no_number,  ///< the expression of a level set, or its slope, is none where a vertex is
};

/// First failed step; `index` is the least vertex that failed in it.
using StepFailure = stepping::StepFailure<FailureReason>;

/// Work of contact on a vertex, negative for dissipation, and the velocity change that friction needs.
struct ContactWork {
  double normal = 0.0;    ///< J, of what keeps parts apart: impulses along normals, and zones
  double friction = 0.0;  ///< J, of friction
  double kick_x = 0.0, kick_y = 0.0, kick_z = 0.0;  ///< m/s, that forces gave in the last step
  bool operator==(const ContactWork&) const = default;
};

/// Sums over all vertices.
struct Totals {
  double kinetic = 0.0;  ///< J
  double elastic = 0.0;  ///< J
  double gravity = 0.0;  ///< J, -sum of m g x
  double load = 0.0;     ///< J, minus the work of dead loads from the origin to where the vertices are
  std::array<double, 3> momentum{};          ///< kg m/s
  std::array<double, 3> angular_momentum{};  ///< kg m^2/s, about the origin
  double contact = 0.0;   ///< J, work that contact has done since the solver was made, friction apart
  double friction = 0.0;  ///< J, work that friction in contact has done

  /// Total energy, J, which is constant without damping, moving pins and loads that change. Does not throw.
  [[nodiscard]] double energy() const { return kinetic + elastic + gravity + load; }
};

/// Per length at rest, or per length as it is now.
enum class StressMeasure { nominal, cauchy };

/// Stress of a membrane, force per length, N/m.
struct Stress {
  double major = 0.0, minor = 0.0;    ///< principal values
  std::array<double, 3> direction{};  ///< of the major one: a unit vector in the plane of the cloth now
  std::array<double, 3> across{};     ///< of the minor one

  /// Stress tensor, N/m: xx, xy, xz, yy, yz, zz. Does not throw.
  [[nodiscard]] std::array<double, 6> tensor() const {
    std::array<double, 6> sum{};
    std::size_t place = 0;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = i; j < 3; ++j)
        sum[place++] = major * direction[i] * direction[j] + minor * across[i] * across[j];
    return sum;
  }

  /// Von Mises stress of plane stress, N/m ([Shi], eq. (2.19)). Does not throw.
  [[nodiscard]] double von_mises() const { return std::sqrt(major * major - major * minor + minor * minor); }
};

}  // namespace drogue::fabric
