#pragma once

#include "kernels/coupling/grid_transfer.hpp"

namespace drogue::coupling {

template <class Base, class T, class Results>
struct InterpolateFunctor : Base {
  FaceArrays<T> faces;
  Results result;

  KOKKOS_FUNCTION void operator()(const int n) const {
    const auto at = this->item(n);
    result(at.point, at.component) = this->weighted_sum(
        at, [&](int component, const FaceIndex& face) { return faces.at(component, face); });
  }
};

/// Interpolates values at faces (any unit, such as velocities in m/s) to the frozen positions: `result`
/// (points, 3). Adjoint of `spread`. A position that is not finite gives NaN. Asynchronous; allocates nothing
/// and may be captured into a CUDA graph. Throws std::invalid_argument for Views of the wrong extents.
template <class ExecutionSpace, class View, class Results>
void interpolate(const ExecutionSpace& space, const GridTransfer<ExecutionSpace>& transfer,
                 const FaceViews<View>& faces, const Results& result) {
  static_assert(spatial::accessible_from<ExecutionSpace, View, Results>);
  require_points(transfer, result);
  const auto arrays = face_arrays(transfer.window, faces);
  for_each_point_and_component(space, "drogue::coupling::interpolate", transfer,
                               [&]<class Base>(const Base& base) {
                                 using T = typename View::value_type;
                                 return InterpolateFunctor<Base, T, Results>{base, arrays, result};
                               });
}

}  // namespace drogue::coupling
