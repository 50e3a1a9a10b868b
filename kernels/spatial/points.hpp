#pragma once

#include <Kokkos_Core.hpp>

#include "kernels/spatial/vector3.hpp"

namespace drogue::spatial {

/// True if kernels of an execution space may access the memory of all Views.
template <class ExecutionSpace, class... Views>
inline constexpr bool accessible_from =
    (Kokkos::SpaceAccessibility<ExecutionSpace, typename Views::memory_space>::accessible && ...);

/// Row i of a View (n, 3), in the unit of the View.
template <class View>
KOKKOS_INLINE_FUNCTION Vector3<double> load_vector(const View& rows, int i) {
  return {rows(i, 0), rows(i, 1), rows(i, 2)};
}

/// Stores row i of a View (n, 3), in the unit of the View.
template <class View>
KOKKOS_INLINE_FUNCTION void store_vector(const View& rows, int i, const Vector3<double>& value) {
  rows(i, 0) = value.x, rows(i, 1) = value.y, rows(i, 2) = value.z;
}

}  // namespace drogue::spatial
