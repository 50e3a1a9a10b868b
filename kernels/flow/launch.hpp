#pragma once

#include <cstdint>

#include <Kokkos_Core.hpp>

#include "kernels/device/memory.hpp"

namespace drogue::flow {

/// Threads of a team on a device, as columns of a tile of 32 x 4 cells.
inline constexpr int tile_x = 32, tile_y = 4;

/// Calls `functor(i, j, k)` for all indices below `extent`, i fastest. Asynchronous; may be captured into a
/// CUDA graph.
template <class ExecutionSpace, class Functor>
void launch_cells(const ExecutionSpace& space, const char* label, const int extent[3],
                  const Functor& functor) {
  using Policy =
      Kokkos::MDRangePolicy<ExecutionSpace, Kokkos::Rank<3, Kokkos::Iterate::Left, Kokkos::Iterate::Left>>;
  using Indices = Kokkos::Array<std::int64_t, 3>;
  // Warps along x on a device; the defaults of a host are rows.
  const Indices tile = device::is_host<ExecutionSpace> ? Indices{} : Indices{tile_x, tile_y, 1};
  Kokkos::parallel_for(
      label,
      Kokkos::Experimental::require(Policy(space, Indices{}, Indices{extent[0], extent[1], extent[2]}, tile),
                                    Kokkos::Experimental::WorkItemProperty::HintLightWeight),
      functor);
}

/// Planes of a march along z of a tile of columns on a device: at most `longest`, a power of two, and fewer
/// if that would leave multiprocessors without work. Does not throw.
inline int march_planes(int tiles, int nz, int longest) {
  constexpr int enough_teams = 1024;  // about two waves of a large device
  int planes = longest;
  while (planes > 2 && tiles * ((nz + planes - 1) / planes) < enough_teams) planes /= 2;
  return planes;
}

}  // namespace drogue::flow
