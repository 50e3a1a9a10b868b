#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <stdexcept>

#include "kernels/coupling/sheet/parameters.hpp"
#include "kernels/coupling/sheet/solver.hpp"
#include "kernels/device/copy.hpp"
#include "kernels/device/launch.hpp"
#include "kernels/fabric/state.hpp"
#include "kernels/spatial/points.hpp"

namespace drogue::coupling {

/// Subtracts a uniform velocity from all vertices.
template <class ExecutionSpace>
struct ShiftFrameFunctor {
  fabric::PointsView<ExecutionSpace> velocities;
  spatial::Point shift;  ///< m/s

  KOKKOS_FUNCTION void operator()(const int i) const {
    spatial::store_vector(velocities, i, spatial::load_vector(velocities, i) - shift);
  }
};

/// Writes the weighted means of the positions and velocities of vertices to the places of a list, in the
/// order of the vertices.
template <class ExecutionSpace>
struct GuideStateFunctor {
  fabric::State<ExecutionSpace> cloth;
  Kokkos::View<double*, typename ExecutionSpace::memory_space> list;
  Kokkos::View<WeightedVertex*, typename ExecutionSpace::memory_space> vertices;

  KOKKOS_FUNCTION void operator()(const int axis) const {
    const auto a = static_cast<std::size_t>(axis);
    double position = 0.0, velocity = 0.0;
    for (std::size_t k = 0; k < vertices.extent(0); ++k) {
      const auto row = static_cast<std::size_t>(vertices(k).vertex);
      position += vertices(k).weight * cloth.positions(row, a);
      velocity += vertices(k).weight * cloth.velocities(row, a);
    }
    list(a) = position;
    list(3 + a) = velocity;
  }
};

/// Motion of a frame of reference that follows a point of the cloth.
template <class ExecutionSpace>
class MovingFrame {
 public:
  /// Blocks. Throws std::invalid_argument for parameters out of range and a cloth with pinned or moving axes
  /// along which the frame moves.
  MovingFrame(const ExecutionSpace& space, const FollowParameters& parameters,
              const fabric::Parameters& cloth)
      : _parameters(parameters),
        _list("drogue::coupling::guide_state", 6),
        _vertices("drogue::coupling::guide_vertices", parameters.vertices.size()) {
    if (!follows()) return;
    double weight = 0.0;
    for (const WeightedVertex& each : parameters.vertices) {
      weight += each.weight;
      if (each.vertex < 0 || each.vertex >= static_cast<int>(cloth.mass.size()))
        throw std::invalid_argument("moving frame: a vertex that it follows does not exist");
    }
    if (!(std::abs(weight - 1.0) <= 1e-9))
      throw std::invalid_argument("moving frame: the weights of its vertices must add up to 1");
    if (!(parameters.relaxation > 0.0 && parameters.relaxation <= 1e100))
      throw std::invalid_argument("moving frame: the relaxation time must be positive");
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!std::isfinite(parameters.place[axis]))
        throw std::invalid_argument("moving frame: the place of the point must be finite");
      if (!parameters.axes[axis]) continue;
      bool is_fixed = false;
      for (const std::uint8_t axes : cloth.pinned) is_fixed = is_fixed || (axes >> axis & 1U) != 0U;
      for (const fabric::Motion& motion : cloth.motions)
        is_fixed = is_fixed || motion.axis == static_cast<int>(axis);
      if (is_fixed) throw std::invalid_argument("moving frame: all vertices must move freely along its axes");
    }
    const auto host = Kokkos::create_mirror_view(_vertices);
    for (std::size_t k = 0; k < parameters.vertices.size(); ++k) host(k) = parameters.vertices[k];
    Kokkos::deep_copy(space, _vertices, host);
    space.fence("drogue::coupling::moving_frame");
  }

  /// True if there is a point to follow. Does not throw.
  [[nodiscard]] bool follows() const { return !_parameters.vertices.empty(); }
  [[nodiscard]] const FrameMotion& motion() const { return _motion; }

  /// Sets the motion. Throws std::invalid_argument for a velocity along an axis that the frame does not
  /// follow.
  void set(const FrameMotion& motion) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (motion.velocity[axis] != 0.0 && !(follows() && _parameters.axes[axis]))
        throw std::invalid_argument("moving frame: it does not move along this axis");
    _motion = motion;
  }

  /// Chooses the velocity for a block of a given duration that begins at a time, both in s, and enqueues the
  /// change of the velocities of the cloth. Blocks. Throws only after a failed kernel.
  const FrameMotion& begin_block(const ExecutionSpace& space, const fabric::State<ExecutionSpace>& cloth,
                                 double time, double duration) {
    device::launch_each(space, "drogue::coupling::guide_state", 3,
                        GuideStateFunctor<ExecutionSpace>{cloth, _list, _vertices});
    std::array<double, 6> guide{};
    device::copy_out(space, guide.data(), _list, guide.size());
    space.fence("drogue::coupling::moving_frame: read the point");
    _motion.start = _motion.position(time);
    _motion.since = time;
    const double period = std::max(_parameters.relaxation, duration);
    double shift[3] = {};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!_parameters.axes[axis]) continue;
      const double velocity =
          _motion.velocity[axis] + guide[3 + axis] + (guide[axis] - _parameters.place[axis]) / period;
      // As the flow computes it, so that both shift by the same number.
      shift[axis] = velocity - _motion.velocity[axis];
      _motion.velocity[axis] = velocity;
    }
    device::launch_each(space, "drogue::coupling::shift_frame", static_cast<int>(cloth.velocities.extent(0)),
                        ShiftFrameFunctor<ExecutionSpace>{cloth.velocities, {shift[0], shift[1], shift[2]}});
    return _motion;
  }

 private:
  FollowParameters _parameters;
  FrameMotion _motion;
  Kokkos::View<double*, typename ExecutionSpace::memory_space> _list;
  Kokkos::View<WeightedVertex*, typename ExecutionSpace::memory_space> _vertices;
};

}  // namespace drogue::coupling
