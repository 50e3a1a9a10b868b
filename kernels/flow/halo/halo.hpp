#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "kernels/device/copy.hpp"
#include "kernels/flow/halo/decomposition.hpp"
#include "kernels/flow/halo/exchange.hpp"
#include "kernels/flow/observables/totals.hpp"
#include "kernels/flow/views.hpp"

namespace drogue::flow {

/// Everything that a solver on one of several ranks needs from the others. All functions are collective and
/// block until the messages are complete.
template <class ExecutionSpace>
class Halo {
 public:
  /// `grid`: cells of this rank. Throws std::runtime_error if memory runs out.
  Halo(const linear::RankGroup& group, const linear::PencilRanks& ranks, const Parameters& parameters,
       const MacGrid& grid)
      : _group(group), _ranks(ranks), _grid(grid) {
    for (std::size_t side = 2; side < 6; ++side)
      if (borders_rank(parameters, ranks, side)) add_side(side);
  }

  [[nodiscard]] const linear::RankGroup& group() const { return _group; }
  [[nodiscard]] const linear::PencilRanks& ranks() const { return _ranks; }

  /// Fills the ghost cells of a velocity field at the sides towards other ranks. Ghost cells at the sides of
  /// the domain must be filled afterwards.
  void exchange_velocity(const ExecutionSpace& space, const List<ExecutionSpace>& velocity) const {
    // The second exchange passes on what the first one received, and so fills the corners.
    for (const Exchange<ExecutionSpace>& exchange : _velocity) exchange.run(space, _group, velocity.data());
  }

  /// Fills the normal components on the high faces that belong to other ranks.
  void exchange_high_faces(const ExecutionSpace& space, const List<ExecutionSpace>& velocity) const {
    _faces.run(space, _group, velocity.data());
  }

  /// Fills `pressure_below`.
  void exchange_pressure(const ExecutionSpace& space, const List<ExecutionSpace>& pressure) const {
    _pressure.run(space, _group, pressure.data());
  }

  /// Pressure in the layer of cells below the low side along an axis, in the order of the cells of the side;
  /// null where there is no other rank.
  [[nodiscard]] const double* pressure_below(std::size_t axis) const { return _below[axis]; }

  /// Gives all ranks the least failed cell, the largest rate, and the failure of a pressure solver.
  void agree(const ExecutionSpace& space, const ControlView<ExecutionSpace>& view) const {
    Control control;
    device::copy_out(space, &control, view, 1);
    space.fence("drogue::flow::halo: read control");
    // The maximum of a complement is that of the least value.
    std::array<std::uint64_t, 3> values = {~control.first_failure, control.next_rate,
                                           static_cast<std::uint64_t>(control.pressure_failed)};
    _group.maximize(values);
    control.first_failure = ~values[0];
    control.next_rate = values[1];
    control.pressure_failed = static_cast<int>(values[2]);
    device::copy_in(space, view, &control, 1);
    space.fence("drogue::flow::halo: write control");
  }

  /// Combines the contributions of all ranks to the totals, in the order of the ranks, and adds those to the
  /// flow through each side.
  void combine(double sum[total_count], double outflow[6]) const {
    constexpr std::size_t count = total_count;
    std::array<double, count + 6> mine;
    std::copy_n(sum, count, mine.begin());
    std::copy_n(outflow, 6, mine.begin() + count);
    const std::vector<double> all = _group.gather(mine);
    std::fill_n(sum, count, 0.0);
    std::fill_n(outflow, 6, 0.0);
    for (std::size_t at = 0; at < all.size(); at += mine.size()) {
      combine_totals(sum, all.data() + at);
      for (std::size_t side = 0; side < 6; ++side) outflow[side] += all[at + count + side];
    }
  }

  /// True if it is true on all ranks.
  [[nodiscard]] bool all(bool mine) const {
    std::uint64_t refused = mine ? 0 : 1;
    _group.maximize({&refused, 1});
    return refused == 0;
  }

 private:
  /// Layers of cells or ghost cells along an axis.
  struct Layers {
    std::size_t axis;
    int begin, count;
  };

  /// Velocity components `first` to `first + components - 1` in layers of cells. Other axes: all cells and the
  /// high boundary faces, or with `ghosts` all ghost cells along y, too.
  [[nodiscard]] ArrayBox velocity_box(const Layers& layers, int first, int components, bool ghosts) const {
    const MacGrid& g = _grid;
    int begin[3] = {0, 0, 0}, extent[3];
    for (int axis = 0; axis < 3; ++axis) extent[axis] = g.n[axis] + (g.ghost[axis] > 0 ? 1 : 0);
    if (ghosts) {
      begin[1] = -g.ghost[1];
      extent[1] = g.n[1] + 2 * g.ghost[1];
    }
    begin[layers.axis] = layers.begin;
    extent[layers.axis] = layers.count;
    return {first * g.component + g.offset(begin[0], begin[1], begin[2]),
            {g.stride[0], g.stride[1], g.stride[2]},
            g.component,
            {extent[0], extent[1], extent[2]},
            components};
  }

  [[nodiscard]] ArrayBox pressure_box(std::size_t axis, int layer) const {
    const MacGrid& g = _grid;
    const std::int64_t stride[3] = {1, g.n[0], static_cast<std::int64_t>(g.n[0]) * g.n[1]};
    ArrayBox box{layer * stride[axis], {1, stride[1], stride[2]}, 0, {g.n[0], g.n[1], g.n[2]}, 1};
    box.extent[axis] = 1;
    return box;
  }

  void add_side(std::size_t side) {
    const std::size_t axis = side / 2;
    const int peer = rank_beyond(_ranks, side), n = _grid.n[axis];
    // Two ranks of a periodic axis share both sides.
    const int upwards = static_cast<int>(2 * axis), downwards = upwards + 1;
    const bool high = side % 2 == 1, ghosts = axis == 2;
    const Layers inner{axis, high ? n - ghost_width : 0, ghost_width};
    const Layers outer{axis, high ? n : -ghost_width, ghost_width};
    _velocity[axis - 1].add_send(peer, high ? upwards : downwards, velocity_box(inner, 0, 3, ghosts));
    _velocity[axis - 1].add_receive(peer, high ? downwards : upwards, velocity_box(outer, 0, 3, ghosts));
    if (high) {
      _faces.add_receive(peer, downwards, velocity_box({axis, n, 1}, static_cast<int>(axis), 1, false));
      _pressure.add_send(peer, upwards, pressure_box(axis, n - 1));
    } else {
      _faces.add_send(peer, downwards, velocity_box({axis, 0, 1}, static_cast<int>(axis), 1, false));
      _below[axis] = _pressure.add_receive(peer, upwards, pressure_box(axis, 0).size());
    }
  }

  linear::RankGroup _group;
  linear::PencilRanks _ranks;
  MacGrid _grid;
  std::array<Exchange<ExecutionSpace>, 2> _velocity;  ///< along y, then z
  Exchange<ExecutionSpace> _faces, _pressure;
  std::array<const double*, 3> _below{};
};

}  // namespace drogue::flow
