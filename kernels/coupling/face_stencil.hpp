#pragma once

#include <Kokkos_Core.hpp>
#include <cstddef>
#include <stdexcept>
#include <string>

#include "kernels/coupling/delta_function.hpp"
#include "kernels/coupling/staggered_grid.hpp"
#include "kernels/spatial/points.hpp"

namespace drogue::coupling {

/// Values at the faces of the three components: rank-3 Views (i, j, k) of any layout.
template <class View>
struct FaceViews {
  View component[3];
};

/// Face of a velocity component d: indices along axis d and along the two axes after it, cyclically.
struct FaceIndex {
  int along, across, last;
};

/// Axis k of a FaceIndex of component d.
KOKKOS_INLINE_FUNCTION int cyclic_axis(int component, int k) {
  return component + k < 3 ? component + k : component + k - 3;
}

/// Addresses of values at faces, as kernels read them.
template <class T>
struct FaceArrays {
  T* data[3];
  std::ptrdiff_t stride[3][3];  ///< by component, in the order of FaceIndex

  /// Value at a face, in the unit of the Views. Does not throw.
  KOKKOS_FUNCTION T& at(int component, const FaceIndex& face) const {
    const std::ptrdiff_t(&step)[3] = stride[component];
    return data[component][face.along * step[0] + face.across * step[1] + face.last * step[2]];
  }
};

/// Addresses of the values of Views, of any unit. Throws std::invalid_argument unless every View has the
/// faces of the window.
template <class View>
[[nodiscard]] FaceArrays<typename View::value_type> face_arrays(const FaceWindow& window,
                                                                const FaceViews<View>& faces) {
  static_assert(View::rank() == 3);
  FaceArrays<typename View::value_type> arrays{};
  for (int d = 0; d < 3; ++d) {
    const View& view = faces.component[d];
    arrays.data[d] = view.data();
    for (int k = 0; k < 3; ++k) {
      const int axis = cyclic_axis(d, k);
      const auto dimension = static_cast<std::size_t>(axis);
      if (view.extent(dimension) != static_cast<std::size_t>(window.faces(d, axis)))
        throw std::invalid_argument("grid transfer: View '" + view.label() +
                                    "' does not have one value per face");
      arrays.stride[d][k] = static_cast<std::ptrdiff_t>(view.stride(dimension));
    }
  }
  return arrays;
}

/// Sample points of a one-dimensional delta function along an axis: their indices and weights. The weights
/// add up to 1.
template <int points>
struct AxisStencil {
  int index[points];
  double weight[points];
  bool is_complete;  ///< false if faces were missing, or the coordinate is not finite
};

/// Stencil of coordinate x (m) on the faces normal to an axis, or on the cell centres along it. A periodic
/// axis wraps. Beyond the sides of a bounded axis the nearest face stands for the missing ones and receives
/// their weights: all weights stay in range and non-negative, but the first moment is lost.
template <class Spline>
KOKKOS_INLINE_FUNCTION AxisStencil<Spline::points> axis_stencil(const GridAxis& axis, double x,
                                                                bool on_faces) {
  constexpr int points = Spline::points;
  constexpr double farthest = 1073741824.0;  // 2^30 spacings
  const int count = axis.cells + (on_faces && !axis.periodic ? 1 : 0);
  const double position = (x - axis.origin) * axis.inverse_spacing - (on_faces ? 0.0 : 0.5);
  const double base = Kokkos::floor(Spline::centred ? position + 0.5 : position);
  AxisStencil<points> stencil;
  Spline::weights(position - base, stencil.weight);
  // The bounds keep the conversion defined, also for NaN.
  const double low = axis.periodic ? -farthest : -8.0, high = axis.periodic ? farthest : count + 8.0;
  const double limited = base > low ? (base < high ? base : high) : low;
  const int first = static_cast<int>(limited) - Spline::lead;
  if (axis.periodic) {
    int index = first % count;
    index += index < 0 ? count : 0;
    for (int k = 0; k < points; ++k) {
      stencil.index[k] = index;
      index = index + 1 == count ? 0 : index + 1;
    }
    stencil.is_complete = limited == base;
  } else {
    for (int k = 0; k < points; ++k) {
      const int index = first + k;
      stencil.index[k] = index < 0 ? 0 : (index < count ? index : count - 1);
    }
    stencil.is_complete = limited == base && first >= 0 && first + points <= count;
  }
  return stencil;
}

/// Faces of one velocity component that the delta function around a point covers, and their weights.
template <DeltaFunction delta>
struct FaceStencil {
  using Along = typename DeltaFactors<delta>::Along;
  using Across = typename DeltaFactors<delta>::Across;

  AxisStencil<Along::points> along;
  AxisStencil<Across::points> across, last;

  /// Faces around `x`, m, for the component of that number. Does not throw.
  KOKKOS_FUNCTION FaceStencil(const GridAxes& grid, const spatial::Point& x, int component) {
    const double coordinate[3] = {x.x, x.y, x.z};
    const int next = cyclic_axis(component, 1), other = cyclic_axis(component, 2);
    along = axis_stencil<Along>(grid.axis[component], coordinate[component], true);
    across = axis_stencil<Across>(grid.axis[next], coordinate[next], false);
    last = axis_stencil<Across>(grid.axis[other], coordinate[other], false);
  }

  /// False if the delta function extends beyond a bounded side, or the point is not finite.
  [[nodiscard]] KOKKOS_FUNCTION bool is_complete() const {
    return along.is_complete && across.is_complete && last.is_complete;
  }

  /// Face among those nearest to the point.
  [[nodiscard]] KOKKOS_FUNCTION FaceIndex centre() const {
    return {along.index[Along::lead], across.index[Across::lead], last.index[Across::lead]};
  }

  /// Calls `visit(face, weight, is_centre)` for each FaceIndex, in a fixed order.
  template <class Visit>
  KOKKOS_FUNCTION void for_each_face(const Visit& visit) const {
    for (int i = 0; i < Along::points; ++i)
      for (int j = 0; j < Across::points; ++j) {
        const double weight = along.weight[i] * across.weight[j];
        for (int k = 0; k < Across::points; ++k)
          visit(FaceIndex{along.index[i], across.index[j], last.index[k]}, weight * last.weight[k],
                i == Along::lead && j == Across::lead && k == Across::lead);
      }
  }
};

}  // namespace drogue::coupling
