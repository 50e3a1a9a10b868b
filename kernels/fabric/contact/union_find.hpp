#pragma once

#include <Kokkos_Core.hpp>

#include "kernels/device/relaxed_access.hpp"

namespace drogue::fabric {

/// Root of element i in a lock-free union-find forest; `parent(i) == i` at a root. Concurrent calls of
/// `unite` are allowed.
template <class Parents>
KOKKOS_INLINE_FUNCTION int find_root(const Parents& parent, int i) {
  for (int up = device::relaxed_load(&parent(i)); up != i; up = device::relaxed_load(&parent(i))) i = up;
  return i;
}

/// Unites the sets of i and j under the smallest element of both. The resulting sets do not depend on the
/// order of concurrent calls.
template <class Parents>
KOKKOS_INLINE_FUNCTION void unite(const Parents& parent, int i, int j) {
  for (;;) {
    i = find_root(parent, i), j = find_root(parent, j);
    if (i == j) return;
    const int low = i < j ? i : j, high = i < j ? j : i;
    if (Kokkos::atomic_compare_exchange(&parent(high), high, low) == high) return;
  }
}

}  // namespace drogue::fabric
