#pragma once

#include <span>
#include <vector>

#include "kernels/device/copy.hpp"
#include "kernels/fabric/fabric_views.hpp"
#include "kernels/fabric/material.hpp"

namespace drogue::fabric {

/// Copies vectors to the rows of a View and fills further rows, which pad the last slice, with zeros. Blocks.
template <class ExecutionSpace>
void copy_to_points(const ExecutionSpace& space, std::span<const Vector> from,
                    const PointsView<ExecutionSpace>& to) {
  const auto mirror = Kokkos::create_mirror_view(to);
  for (std::size_t i = 0; i < mirror.extent(0); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis) mirror(i, axis) = i < from.size() ? from[i][axis] : 0.0;
  device::copy(space, to, mirror);
  space.fence("drogue::fabric::copy_to_points");
}

/// Copies the first rows of Views to host memory through a mirror that is allocated once.
template <class ExecutionSpace>
class PointsReader {
 public:
  /// Blocks. All Views of one reader must have the same extents.
  void read(const ExecutionSpace& space, const PointsView<ExecutionSpace>& from, std::span<Vector> to) {
    typename PointsView<ExecutionSpace>::host_mirror_type mirror = _mirror;
    if constexpr (device::is_host<ExecutionSpace>)
      mirror = from;
    else if (mirror.extent(0) == 0)
      mirror = _mirror = Kokkos::create_mirror(from);
    device::copy(space, mirror, from);
    space.fence("drogue::fabric::read_points");
    for (std::size_t i = 0; i < to.size(); ++i)
      for (std::size_t axis = 0; axis < 3; ++axis) to[i][axis] = mirror(i, axis);
  }

 private:
  typename PointsView<ExecutionSpace>::host_mirror_type _mirror;
};

}  // namespace drogue::fabric
