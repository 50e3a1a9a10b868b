#pragma once

#include "kernels/coupling/face_stencil.hpp"
#include "kernels/spatial/points.hpp"

namespace drogue::coupling {

/// Point where a triangle crosses the line between the centres of two neighbouring cells, and so separates
/// them: the face between the cells carries its pressure jump.
struct Crossing {
  int component;     ///< axis of the line, normal of the face
  FaceIndex face;    ///< between the cells
  double weight[3];  ///< of the corners of the triangle at the point; their sum is 1
};

/// Calls `visit(Crossing)` for all crossings of a triangle with corners in m, whose numbers in the mesh are
/// `vertex`. Lines of the sides of bounded axes and axes of one cell have none.
///
/// Centres are displaced by some 1e-7 cells, so that none lies on an edge of a mesh with round coordinates.
/// Triangles that share an edge decide on which side of it a line passes by the same numbers: a line through
/// a mesh crosses exactly one of them. Hence a closed surface leaves no gap. Does not throw.
template <class Visit>
KOKKOS_INLINE_FUNCTION void for_each_crossing(const GridAxes& grid, const spatial::Point (&corner)[3],
                                              const int (&vertex)[3], const Visit& visit) {
  const double displaced[3] = {0.5 + 1.41421356e-7, 0.5 + 1.73205081e-7, 0.5 + 2.23606798e-7};
  double q[3][3];  // corners in cells; centres are integers
  for (int k = 0; k < 3; ++k) {
    const double x[3] = {corner[k].x, corner[k].y, corner[k].z};
    for (int axis = 0; axis < 3; ++axis)
      q[k][axis] = (x[axis] - grid.axis[axis].origin) * grid.axis[axis].inverse_spacing - displaced[axis];
  }
  for (int d = 0; d < 3; ++d) {
    if (grid.axis[d].cells == 1) continue;
    const int e = cyclic_axis(d, 1), f = cyclic_axis(d, 2);
    const auto least = [&](int axis) {
      return Kokkos::ceil(Kokkos::fmin(q[0][axis], Kokkos::fmin(q[1][axis], q[2][axis])));
    };
    const auto most = [&](int axis) {
      return Kokkos::fmax(q[0][axis], Kokkos::fmax(q[1][axis], q[2][axis]));
    };
    // Doubled area of the triangle of an edge and the line, positive to its left.
    const auto side = [&](int from, int to, double a, double b) {
      const bool ascends = vertex[from] < vertex[to];
      const int i = ascends ? from : to, j = ascends ? to : from;
      const double area = (q[j][e] - q[i][e]) * (b - q[i][f]) - (q[j][f] - q[i][f]) * (a - q[i][e]);
      return ascends ? area : -area;
    };
    const auto inside = [](const GridAxis& axis, double index) {
      return axis.periodic || (index >= 0.0 && index < axis.cells);
    };
    const auto wrapped = [](const GridAxis& axis, double index) {
      return static_cast<int>(index - axis.cells * Kokkos::floor(index / axis.cells));
    };
    for (double a = least(e); a <= most(e); a += 1.0)
      for (double b = least(f); b <= most(f); b += 1.0) {
        if (!inside(grid.axis[e], a) || !inside(grid.axis[f], b)) continue;
        const double s0 = side(1, 2, a, b), s1 = side(2, 0, a, b), s2 = side(0, 1, a, b);
        const bool is_left = s0 > 0.0 && s1 > 0.0 && s2 > 0.0, is_right = s0 < 0.0 && s1 < 0.0 && s2 < 0.0;
        if (!is_left && !is_right) continue;
        const double inverse = 1.0 / (s0 + s1 + s2);
        const double weight[3] = {s0 * inverse, s1 * inverse, s2 * inverse};
        // Centres below and above the point.
        const double below = Kokkos::floor(weight[0] * q[0][d] + weight[1] * q[1][d] + weight[2] * q[2][d]),
                     above = below + 1.0;
        if (!inside(grid.axis[d], below) || !inside(grid.axis[d], above)) continue;
        visit(Crossing{d,
                       {wrapped(grid.axis[d], above), wrapped(grid.axis[e], a), wrapped(grid.axis[f], b)},
                       {weight[0], weight[1], weight[2]}});
      }
  }
}

}  // namespace drogue::coupling
