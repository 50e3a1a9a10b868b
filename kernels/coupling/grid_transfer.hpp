#pragma once

#include <Kokkos_Core.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>

#include "kernels/coupling/face_stencil.hpp"
#include "kernels/coupling/fixed_point.hpp"
#include "kernels/device/launch.hpp"

namespace drogue::coupling {

/// Events since the construction of a transfer, or since its owner has set them to zero.
struct TransferCounts {
  /// Positions frozen whose delta function extends beyond a bounded side of the grid, or not finite.
  long long incomplete_points = 0;
  /// Force components that were not spread: larger than the given bound or 1e270 N, not finite, or at a
  /// position that is not finite.
  long long rejected_forces = 0;
};

/// Transfer between points and the faces of a staggered grid. Holds the frozen positions at which both
/// directions take their weights, and the fixed-point sums of `spread`. Constructed once; copies share the
/// Views. Functions of one transfer belong on one instance of the execution space.
///
/// On several ranks, which divide the faces, each has all points: `spread` gives a rank the densities on its
/// own faces, with the bits of one rank, and `interpolate` and `spread_row_sums` give the contributions of
/// its faces, to be summed over the ranks (`RankSum`).
template <class ExecutionSpace>
struct GridTransfer {
  using Memory = typename ExecutionSpace::memory_space;
  using Sums = Kokkos::View<FixedPoint***, Kokkos::LayoutLeft, Memory>;

  /// Allocates for a number of points; blocks. Memory: 24 bytes per point and 24 per cell. Throws
  /// std::invalid_argument for an invalid grid and unless 0 <= points <= 2^29. `own_faces`: those of this
  /// rank, by default all.
  GridTransfer(const ExecutionSpace& space, const StaggeredGrid& staggered_grid, DeltaFunction delta_function,
               int number_of_points, const std::optional<FaceWindow>& own_faces = {})
      : grid(staggered_grid),
        window(own_faces.value_or(whole_window(staggered_grid))),
        delta(delta_function),
        points(number_of_points) {
    check(grid);
    if (points < 0 || points > 1 << 29)
      throw std::invalid_argument("grid transfer: the number of points must be 0 to 2^29");
    positions = decltype(positions)("drogue::coupling::positions", static_cast<std::size_t>(points));
    largest = decltype(largest)("drogue::coupling::largest");
    counts = decltype(counts)("drogue::coupling::counts");
    for (int d = 0; d < 3; ++d) {
      const auto extent = [&](int axis) { return static_cast<std::size_t>(window.faces(d, axis)); };
      sums.component[d] = Sums("drogue::coupling::sums", extent(0), extent(1), extent(2));
    }
    space.fence("drogue::coupling::grid_transfer");
  }

  /// True if other ranks hold some of the faces. Does not throw.
  [[nodiscard]] bool is_divided() const { return window != whole_window(grid); }

  StaggeredGrid grid;
  FaceWindow window;  ///< faces of this rank, those of `sums`
  DeltaFunction delta;
  int points;
  Kokkos::View<double* [3], Kokkos::LayoutLeft, Memory> positions;  ///< frozen, m
  FaceViews<Sums> sums;                                             ///< all zero between calls
  /// Bits of the largest magnitude to be spread and of the one in use. The first is zero between calls.
  Kokkos::View<FixedPoint[2], Memory> largest;
  Kokkos::View<TransferCounts, Memory> counts;
  bool has_stencils = true;  ///< false: points need none, and are complete up to the sides of the domain
};

/// Throws std::invalid_argument unless the number of rows of a View, in any unit, is at least that of points
/// of the transfer.
template <class ExecutionSpace, class View>
void require_points(const GridTransfer<ExecutionSpace>& transfer, const View& view) {
  if (view.extent(0) < static_cast<std::size_t>(transfer.points))
    throw std::invalid_argument("grid transfer: View '" + view.label() + "' has fewer rows than points");
}

/// Base of kernels with one thread per point and component. `divided`: other ranks hold some of the faces.
template <class ExecutionSpace, DeltaFunction delta, bool divided>
struct TransferKernel {
  static constexpr DeltaFunction delta_function = delta;

  GridTransfer<ExecutionSpace> transfer;
  GridAxes axes;
  FaceArrays<FixedPoint> sums;
  double summands;  ///< bound on the number of points, a power of two

  struct Item {
    int component, point;
    spatial::Point x;  ///< frozen, m
  };

  /// Point and component of thread n, with the position in m. Does not throw.
  KOKKOS_FUNCTION Item item(int n) const {
    const int component = n / transfer.points, point = n - component * transfer.points;
    return {component, point, spatial::load_vector(transfer.positions, point)};
  }
  /// Faces around a point, with dimensionless weights. Does not throw.
  KOKKOS_FUNCTION FaceStencil<delta> stencil(const Item& at) const { return {axes, at.x, at.component}; }
  /// Scale of the sums in use.
  KOKKOS_FUNCTION FixedPointScale scale() const {
    return fixed_point_scale(Kokkos::bit_cast<double>(transfer.largest(1)), summands);
  }
  /// Changes the indices of a face in the whole grid to those in the arrays of this rank. False if it belongs
  /// to another rank.
  KOKKOS_FUNCTION bool to_own(int component, FaceIndex& face) const {
    if constexpr (divided) {
      const auto enter = [&](int& index, int k) {
        index -= transfer.window.begin[component][k];
        return index >= 0 && index < transfer.window.count[component][k];
      };
      return enter(face.along, 0) && enter(face.across, 1) && enter(face.last, 2);
    } else {
      return true;
    }
  }
  /// Calls `visit(face, weight)` for each face of this rank around a point, in a fixed order.
  template <class Visit>
  KOKKOS_FUNCTION void for_each_own_face(const Item& at, const Visit& visit) const {
    stencil(at).for_each_face([&](FaceIndex face, double weight, bool) {
      if (to_own(at.component, face)) visit(face, weight);
    });
  }
  /// Weighted sum of `value(component, face)` over the faces of this rank around a point, in the unit of the
  /// values.
  template <class Value>
  KOKKOS_FUNCTION double weighted_sum(const Item& at, const Value& value) const {
    double sum = 0.0;
    for_each_own_face(
        at, [&](const FaceIndex& face, double weight) { sum += weight * value(at.component, face); });
    return sum;
  }
};

/// Calls `make.operator()<Kernel>(base)` with the TransferKernel of a transfer, and runs the functor that it
/// returns once for each point and component. Asynchronous. Throws std::runtime_error if the launch fails.
template <class ExecutionSpace, class Make>
void for_each_point_and_component(const ExecutionSpace& space, const char* label,
                                  const GridTransfer<ExecutionSpace>& transfer, const Make& make) {
  const auto launch = [&]<bool divided>(std::bool_constant<divided>) {
    dispatch_delta(transfer.delta, [&]<DeltaFunction delta>() {
      const TransferKernel<ExecutionSpace, delta, divided> base{transfer, grid_axes(transfer.grid),
                                                                face_arrays(transfer.window, transfer.sums),
                                                                summand_bound(transfer.points)};
      device::launch_each(space, label, 3 * transfer.points, make(base));
    });
  };
  if (transfer.is_divided())
    launch(std::true_type());
  else
    launch(std::false_type());
}

template <class ExecutionSpace, DeltaFunction delta, class Positions, class Velocities>
struct FreezePositionsFunctor {
  GridTransfer<ExecutionSpace> transfer;
  GridAxes axes;
  Positions x;
  Velocities v;
  double time;

  KOKKOS_FUNCTION void operator()(const int i) const {
    const spatial::Point frozen = spatial::load_vector(x, i) + time * spatial::load_vector(v, i);
    spatial::store_vector(transfer.positions, i, frozen);
    if (!is_complete(frozen)) Kokkos::atomic_add(&transfer.counts().incomplete_points, 1LL);
  }

  /// True if the point, m, is within reach of the faces that it needs. Does not throw.
  KOKKOS_FUNCTION bool is_complete(const spatial::Point& point) const {
    if (transfer.has_stencils) {
      for (int component = 0; component < 3; ++component)
        if (!FaceStencil<delta>(axes, point, component).is_complete()) return false;
      return true;
    }
    constexpr double rounding = 1e-6;  // of a cell
    const double place[3] = {point.x, point.y, point.z};
    for (int d = 0; d < 3; ++d) {
      const GridAxis& axis = axes.axis[d];
      const double cell = (place[d] - axis.origin) * axis.inverse_spacing;
      if (axis.periodic ? !Kokkos::isfinite(cell) : !(cell >= -rounding && cell <= axis.cells + rounding))
        return false;
    }
    return true;
  }
};

/// Freezes the positions x + time v (m, m/s, s) of all points. They determine the weights of `interpolate`,
/// `spread` and `spread_row_sums` until the next call. Asynchronous; may be captured into a CUDA graph.
/// Throws std::invalid_argument for too few rows.
template <class ExecutionSpace, class Positions, class Velocities>
void freeze_positions(const ExecutionSpace& space, const GridTransfer<ExecutionSpace>& transfer,
                      const Positions& x, const Velocities& v, double time) {
  static_assert(spatial::accessible_from<ExecutionSpace, Positions, Velocities>);
  require_points(transfer, x);
  require_points(transfer, v);
  dispatch_delta(transfer.delta, [&]<DeltaFunction delta>() {
    device::launch_each(
        space, "drogue::coupling::freeze_positions", transfer.points,
        FreezePositionsFunctor<ExecutionSpace, delta, Positions, Velocities>{
            .transfer = transfer, .axes = grid_axes(transfer.grid), .x = x, .v = v, .time = time});
  });
}

/// Copies the counts of a transfer to the host. Blocks; not for captured graphs. Throws std::runtime_error
/// after a failed kernel.
template <class ExecutionSpace>
[[nodiscard]] TransferCounts transfer_counts(const ExecutionSpace& space,
                                             const GridTransfer<ExecutionSpace>& transfer) {
  TransferCounts counts;
  Kokkos::deep_copy(space, counts, transfer.counts);
  space.fence("drogue::coupling::transfer_counts");
  return counts;
}

}  // namespace drogue::coupling
