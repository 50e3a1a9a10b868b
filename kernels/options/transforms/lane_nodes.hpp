#pragma once

#include <Kokkos_Core.hpp>

namespace drogue::options {

/// Two adjacent elements of an array in shared memory, for a single load or store.
struct alignas(16) NodePair {
  double first, second;
};

/// Permuted index of a pair of nodes. It avoids bank conflicts for lanes that write eight nodes each and for
/// lanes that read `block` nodes each.
KOKKOS_INLINE_FUNCTION int swizzled(int pair) { return (pair & ~3) | ((pair & 3) ^ ((pair >> 3) & 3)); }

/// Nodes of a lane, loaded and stored by pairs if `block` > 1.
template <int block>
struct LaneNodes {
  double node[block];

  /// For arrays in plain order.
  KOKKOS_INLINE_FUNCTION static LaneNodes load(int lane, const double* from) {
    return load(lane, from, [](int pair) { return pair; });
  }
  KOKKOS_INLINE_FUNCTION void store(int lane, double* to) const {
    store(lane, to, [](int pair) { return pair; });
  }
  /// For arrays whose pairs are `swizzled`.
  KOKKOS_INLINE_FUNCTION static LaneNodes load_swizzled(int lane, const double* from) {
    return load(lane, from, [](int pair) { return swizzled(pair); });
  }
  KOKKOS_INLINE_FUNCTION void store_swizzled(int lane, double* to) const {
    store(lane, to, [](int pair) { return swizzled(pair); });
  }

 private:
  template <class Place>
  KOKKOS_INLINE_FUNCTION static LaneNodes load(int lane, const double* from, const Place& place) {
    LaneNodes nodes;
    if constexpr (block == 1) {
      nodes.node[0] = from[2 * place(lane / 2) + lane % 2];
    } else {
      for (int m = 0; m < block; m += 2) {
        const NodePair pair = reinterpret_cast<const NodePair*>(from)[place((lane * block + m) / 2)];
        nodes.node[m] = pair.first;
        nodes.node[m + 1] = pair.second;
      }
    }
    return nodes;
  }
  template <class Place>
  KOKKOS_INLINE_FUNCTION void store(int lane, double* to, const Place& place) const {
    if constexpr (block == 1) {
      to[2 * place(lane / 2) + lane % 2] = node[0];
    } else {
      for (int m = 0; m < block; m += 2)
        reinterpret_cast<NodePair*>(to)[place((lane * block + m) / 2)] = {node[m], node[m + 1]};
    }
  }
};

}  // namespace drogue::options
