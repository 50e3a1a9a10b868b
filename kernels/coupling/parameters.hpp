#pragma once

#include <array>

namespace drogue::coupling {

/// Regularised delta functions on a staggered grid. The composite B-splines (Gruninger and Griffith, J.
/// Comput. Phys. 546:114472) are products of a spline along the direction of a velocity component and splines
/// of one order less across it. They interpolate a discretely divergence-free field to a divergence-free one.
enum class DeltaFunction {
  cbs43,  ///< cubic along, quadratic across: 36 faces per component
  cbs32,  ///< quadratic along, linear across: 12 faces per component
  ib4,    ///< four-point function of Peskin (Acta Numerica 2002, eq. 6.27) in all directions: 64 faces
};

/// Staggered (MAC) grid of uniform spacing along each axis. Component d of the velocity lives at the centres
/// of the faces normal to axis d. Face (i, j, k) of component 0 has the position origin + (i, j + 1/2, k +
/// 1/2) spacing; the other components likewise. A bounded axis of n cells has n + 1 faces normal to it, a
/// periodic one n.
struct StaggeredGrid {
  std::array<int, 3> cells{1, 1, 1};
  std::array<double, 3> origin{0.0, 0.0, 0.0};   ///< lowest corner, m
  std::array<double, 3> spacing{1.0, 1.0, 1.0};  ///< m
  std::array<bool, 3> periodic{false, false, false};
};

}  // namespace drogue::coupling
