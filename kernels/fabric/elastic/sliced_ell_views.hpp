#pragma once

#include <Kokkos_Core.hpp>

#include "kernels/device/pack.hpp"
#include "kernels/fabric/elastic/sliced_ell.hpp"
#include "kernels/fabric/views.hpp"

namespace drogue::fabric {

/// Calls `visit(slot)` for the slots of vertex i and the lanes after it, with `first` as in `SlicedEll`.
template <class First, class Visit>
KOKKOS_INLINE_FUNCTION void for_each_slot(const First& first, int i, const Visit& visit) {
  const int end = first(i / slice + 1);
  for (int k = first(i / slice); k < end; ++k) visit(k * slice + i % slice);
}

/// Calls `visit(read(slot))` for the slots `begin` to `end` - 1 of vertex i and the lanes after it, in their
/// order. On a device the reads of four slots overlap.
template <class Read, class Visit>
KOKKOS_INLINE_FUNCTION void for_each_read_slot(int begin, int end, int i, const Read& read,
                                               const Visit& visit) {
#if defined(__CUDA_ARCH__)
  constexpr int ahead = 4;
  for (int k = begin; k < end; k += ahead) {
    decltype(read(0)) values[ahead];
    for (int n = 0; n < ahead; ++n) values[n] = read(device::minimum(k + n, end - 1) * slice + i % slice);
    for (int n = 0; n < ahead; ++n)
      if (k + n < end) visit(values[n]);
  }
#else
  for (int k = begin; k < end; ++k) visit(read(k * slice + i % slice));
#endif
}

/// Calls `visit(before, next, slot)` for the slots but the first, with the values of `read(slot,
/// index(slot))` of the slot before and of the slot. Each slot is read once. Indices are read one slot ahead,
/// so that two dependent memory latencies overlap. Always inlined, as `edge_to` is: GCC 12 may otherwise
/// share one call between the first read and the others, which costs a tenth of a step on a host.
template <class First, class Index, class Read, class Visit>
KOKKOS_FORCEINLINE_FUNCTION void for_each_slot_pair(const First& first, int i, const Index& index,
                                                    const Read& read, const Visit& visit) {
  const int begin = first(i / slice), end = first(i / slice + 1);
  if (begin == end) return;
  const int last = (end - 1) * slice + i % slice;
  int slot = begin * slice + i % slice;
  auto before = read(slot, index(slot));
  auto ahead = index(device::minimum(slot + slice, last));
#if defined(__CUDA_ARCH__)
#pragma unroll 2  // avoids moves of the values carried from slot to slot
#endif
  for (slot += slice; slot <= last; slot += slice) {
    const auto next = read(slot, ahead);
    ahead = index(device::minimum(slot + slice, last));
    visit(before, next, slot);
    before = next;
  }
}

/// `SlicedEll` in the memory of an execution space.
template <class ExecutionSpace, int values>
struct SlicedEllViews {
  using Memory = typename ExecutionSpace::memory_space;
  Kokkos::View<int*, Memory> first, neighbour;
  Kokkos::View<double* [values], Kokkos::LayoutLeft, Memory> value;

  /// Calls `visit(slot)` for the slots of vertex i and the lanes after it.
  template <class Visit>
  KOKKOS_INLINE_FUNCTION void each(int i, const Visit& visit) const {
    for_each_slot(first, i, visit);
  }

  /// Calls `visit(read(slot))` for the slots in their order (`for_each_read_slot`).
  template <class Read, class Visit>
  KOKKOS_INLINE_FUNCTION void each_read(int i, const Read& read, const Visit& visit) const {
    for_each_read_slot(first(i / slice), first(i / slice + 1), i, read, visit);
  }

  /// Calls `visit(before, next, slot)` for the slots of a ring but the first one (`for_each_slot_pair`).
  template <class Index, class Read, class Visit>
  KOKKOS_INLINE_FUNCTION void each_pair(int i, const Index& index, const Read& read,
                                        const Visit& visit) const {
    for_each_slot_pair(first, i, index, read, visit);
  }
};

/// Copies slots to the memory of an execution space, without values if `with_values` is false. Blocks.
template <class ExecutionSpace, int values>
[[nodiscard]] SlicedEllViews<ExecutionSpace, values> sliced_ell_views(const ExecutionSpace& space,
                                                                      const SlicedEll<values>& from,
                                                                      bool with_values = true) {
  SlicedEllViews<ExecutionSpace, values> to{list_view(space, "drogue::fabric::first", from.first),
                                            list_view(space, "drogue::fabric::neighbour", from.neighbour),
                                            {}};
  if (with_values) to.value = table_view(space, "drogue::fabric::slot_values", from.value);
  return to;
}

}  // namespace drogue::fabric
