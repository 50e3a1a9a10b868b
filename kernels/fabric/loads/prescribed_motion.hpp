#pragma once

#include <stdexcept>
#include <vector>

#include "kernels/fabric/parameters.hpp"
#include "kernels/fabric/stepping/divergence.hpp"
#include "kernels/fabric/views.hpp"

namespace drogue::fabric {

/// Motion of pinned vertices in device Views that kernels of the caller may write between steps. A pinned
/// axis has the position rest + displacement + velocity s + acceleration s^2 / 2, m, at the time `time` + s.
///
/// All Views of vectors have the shape (vertices, 3); entries of free axes, and of axes with an expression in
/// `Parameters::motions`, are not read.
template <class ExecutionSpace>
struct PrescribedMotion {
  PointsView<ExecutionSpace> displacement;                           ///< m, from rest
  PointsView<ExecutionSpace> velocity;                               ///< m/s
  PointsView<ExecutionSpace> acceleration;                           ///< m/s^2
  Kokkos::View<double, typename ExecutionSpace::memory_space> time;  ///< s, to which the vectors refer

  PrescribedMotion() = default;
  /// Zero vectors, m, m/s and m/s^2, for all vertices. Throws std::runtime_error if memory runs out.
  explicit PrescribedMotion(std::size_t vertices)
      : displacement("drogue::fabric::pin_displacements", vertices),
        velocity("drogue::fabric::pin_velocities", vertices),
        acceleration("drogue::fabric::pin_accelerations", vertices),
        time("drogue::fabric::pin_time") {}
};

/// Pinned axes without a motion expression, one row per axis and vertex.
template <class ExecutionSpace>
struct PinnedAxes {
  PointsView<ExecutionSpace> rest;  ///< m
  ListView<ExecutionSpace, int> vertex, axis;
};

/// Axes that `Parameters::pinned` pins and no motion expression moves; `rest` in m. Blocks. Throws
/// std::logic_error if there are none.
template <class ExecutionSpace>
[[nodiscard]] PinnedAxes<ExecutionSpace> make_pinned_axes(const ExecutionSpace& space, const Parameters& p,
                                                          const PointsView<ExecutionSpace>& rest) {
  std::vector<std::uint8_t> axes = p.pinned;
  axes.resize(p.mesh.rest.size(), 0);
  for (const Motion& motion : p.motions)
    for (const int i : motion.vertices)
      axes[static_cast<std::size_t>(i)] &=
          static_cast<std::uint8_t>(~(1U << static_cast<unsigned>(motion.axis)));
  std::vector<int> vertex, axis;
  for (std::size_t i = 0; i < axes.size(); ++i)
    for (int k = 0; k < 3; ++k)
      if ((axes[i] >> static_cast<unsigned>(k) & 1U) != 0U)
        vertex.push_back(static_cast<int>(i)), axis.push_back(k);
  if (vertex.empty()) throw std::logic_error("fabric solver: there are no pins to move");
  return {rest, list_view(space, "drogue::fabric::pinned_vertices", vertex),
          list_view(space, "drogue::fabric::pinned_axes", axis)};
}

/// Sets positions and velocities of pinned axes to a prescribed motion.
template <class ExecutionSpace>
struct PrescribedMotionFunctor {
  PinnedAxes<ExecutionSpace> pinned;
  PrescribedMotion<ExecutionSpace> motion;
  PointsView<ExecutionSpace> x, v;
  stepping::StageTime<ExecutionSpace> stage_time;
  bool checks_divergence;  ///< at the end of a step

  KOKKOS_FUNCTION void operator()(const int k) const {
    const int i = pinned.vertex(k), axis = pinned.axis(k);
    const double elapsed = stage_time.time() - motion.time(), rate = motion.velocity(i, axis),
                 acceleration = motion.acceleration(i, axis);
    const double position = pinned.rest(i, axis) + motion.displacement(i, axis) +
                            elapsed * (rate + 0.5 * elapsed * acceleration),
                 velocity = rate + elapsed * acceleration;
    x(i, axis) = position;
    v(i, axis) = velocity;
    if (checks_divergence && !(Kokkos::fabs(position) + Kokkos::fabs(velocity) < divergence_limit))
      stage_time.monitor.record_failure(stage_time.monitor.steps(stage_time.parity), i);
  }
};

/// Initialises a prescribed motion with the present state: pinned axes go on with their velocity.
template <class ExecutionSpace>
struct InitialMotionFunctor {
  PinnedAxes<ExecutionSpace> pinned;
  PrescribedMotion<ExecutionSpace> motion;
  PointsView<ExecutionSpace> x, v;
  stepping::StageTime<ExecutionSpace> stage_time;

  KOKKOS_FUNCTION void operator()(const int k) const {
    const int i = pinned.vertex(k), axis = pinned.axis(k);
    motion.displacement(i, axis) = x(i, axis) - pinned.rest(i, axis);
    motion.velocity(i, axis) = v(i, axis);
    if (k == 0) motion.time() = stage_time.time();
  }
};

}  // namespace drogue::fabric
