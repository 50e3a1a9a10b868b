#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "kernels/device/copy.hpp"
#include "kernels/flow/halo/decomposition.hpp"
#include "kernels/flow/halo/exchange.hpp"
#include "kernels/flow/observables/extremes.hpp"
#include "kernels/flow/views.hpp"

namespace drogue::flow {

/// Everything that a solver on one of several ranks needs from the others. Functions are collective, except
/// those that only return values, and block until their messages are complete, except `begin_velocity`. That
/// of a process alone does nothing, at no cost: it neither allocates nor launches nor fences.
template <class ExecutionSpace>
class Halo {
 public:
  /// `grid`: cells of this rank. Throws std::runtime_error if memory runs out.
  Halo(const linear::RankGroup& group, const linear::PencilRanks& ranks, const Parameters& parameters,
       const MacGrid& grid)
      : _group(group.size() > 1 ? group : linear::RankGroup()), _ranks(ranks), _grid(grid) {
    for (std::size_t side = 0; side < 6; ++side) _borders[side] = borders_rank(parameters, ranks, side);
    for (const int y : {-1, 0, 1})
      for (const int z : {-1, 0, 1}) add_direction({0, y, z});
    for (const std::size_t axis : {1U, 2U}) add_axis(axis);
    _parts = divided();
  }

  [[nodiscard]] const linear::RankGroup& group() const { return _group; }
  /// True without other ranks.
  [[nodiscard]] bool is_alone() const { return _group.size() == 1; }

  /// Begins the exchange of the ghost cells of a velocity field towards other ranks, and returns whether
  /// there are any. Blocks until the kernels before are complete.
  bool begin_velocity(const ExecutionSpace& space, const List<ExecutionSpace>& velocity) {
    _transfers = _velocity.begin(space, _group, velocity.data());
    return static_cast<bool>(_transfers);
  }

  /// Fills the ghost cells of the velocity field of the last `begin_velocity`, if that exchange is under way,
  /// and returns whether it was. Ghost cells at the sides of the domain must be filled afterwards.
  bool finish_velocity(const ExecutionSpace& space, const List<ExecutionSpace>& velocity) {
    if (!_transfers) return false;
    _velocity.finish(space, _transfers, velocity.data());
    return true;
  }

  /// Parts of the cells: first those whose momentum needs no ghost cells towards other ranks, then the
  /// others. All cells in one part if these are too few to be divided, or no other rank needs any.
  [[nodiscard]] const std::vector<MacGrid>& parts() const { return _parts; }

  /// Fills the normal components on the high faces that belong to other ranks.
  void exchange_high_faces(const ExecutionSpace& space, const List<ExecutionSpace>& velocity) const {
    _faces.run(space, _group, velocity.data());
  }

  /// Fills `pressure_below`.
  void exchange_pressure(const ExecutionSpace& space, const List<ExecutionSpace>& pressure) const {
    _pressure.run(space, _group, pressure.data());
  }

  /// Pressure in the layer of cells below the low side along each axis, in the order of the cells of the
  /// side; null where there is no other rank.
  [[nodiscard]] const Kokkos::Array<const double*, 3>& pressure_below() const { return _below; }

  /// Gives all ranks the least failed cell, the largest `StepMaxima`, and the failures of a pressure solver
  /// and a side. `checks_inflow`: whether to fail for the net inflow of all ranks.
  void agree(const ExecutionSpace& space, const ControlView<ExecutionSpace>& view, bool checks_inflow) const {
    if (is_alone()) return;
    Control control;
    device::copy_out(space, &control, view, 1);
    space.fence("drogue::flow::halo: read control");
    // The maximum of a complement is that of the least value.
    constexpr std::size_t maxima = sizeof(StepMaxima) / sizeof(std::uint64_t);
    std::array<std::uint64_t, maxima + 3> values = {};
    StepMaxima& largest = control;
    std::memcpy(values.data(), &largest, sizeof(StepMaxima));
    values[maxima] = ~control.first_failure;
    values[maxima + 1] = static_cast<std::uint64_t>(control.pressure_failed);
    values[maxima + 2] = static_cast<std::uint64_t>(control.failed_side);
    _group.maximize(values);
    std::memcpy(&largest, values.data(), sizeof(StepMaxima));
    control.first_failure = ~values[maxima];
    control.pressure_failed = static_cast<int>(values[maxima + 1]);
    control.failed_side = static_cast<int>(values[maxima + 2]);
    if (checks_inflow && control.is_unbalanced == 0) {
      std::array<double, 2> inflow = {control.net_inflow, control.inflow_magnitude};
      _group.sum(inflow);
      control.is_unbalanced = is_unbalanced(inflow[0], inflow[1]);
      if (control.is_unbalanced != 0) control.net_inflow = inflow[0];
    }
    device::copy_in(space, view, &control, 1);
    space.fence("drogue::flow::halo: write control");
  }

  /// Gives all ranks the energies of all, in the order of the ranks. Blocks.
  void combine(const ExecutionSpace& space, const EnergyView<ExecutionSpace>& whole) const {
    if (is_alone()) return;
    std::array<double, 2> mine{};
    device::copy_out(space, mine.data(), whole, 2);
    space.fence("drogue::flow::halo: read energies");
    const std::vector<double> all = _group.gather(mine);
    mine = {};
    for (std::size_t at = 0; at < all.size(); at += 2) {
      mine[0] += all[at];
      mine[1] = larger_or_nan(mine[1], all[at + 1]);
    }
    device::copy_in(space, whole, mine.data(), 2);
    space.fence("drogue::flow::halo: write energies");
  }

  /// Combines the contributions of all ranks to the totals, in the order of the ranks, and adds those to the
  /// flow through each side.
  void combine(PartTotals& part) const {
    if (is_alone()) return;
    constexpr std::size_t count = total_count;
    std::array<double, count + 6> mine;
    std::copy_n(part.sum, count, mine.begin());
    std::copy_n(part.outflow, 6, mine.begin() + count);
    const std::vector<double> all = _group.gather(mine);
    part = {};
    for (std::size_t at = 0; at < all.size(); at += mine.size()) {
      combine_totals(part.sum, all.data() + at);
      for (std::size_t side = 0; side < 6; ++side) part.outflow[side] += all[at + count + side];
    }
  }

 private:
  /// The grid as `parts`.
  [[nodiscard]] std::vector<MacGrid> divided() const {
    std::vector<MacGrid> parts;
    MacGrid rest = _grid;
    for (int side = 5; side >= 2; --side) {
      if (!_borders[static_cast<std::size_t>(side)]) continue;
      const int axis = side / 2, n = rest.n[axis];
      if (n < ghost_width + 2) return {_grid};
      const bool high = side % 2 == 1;
      parts.push_back(rest);
      cut(parts.back(), axis, high ? n - ghost_width : 0, ghost_width);
      cut(rest, axis, high ? 0 : ghost_width, n - ghost_width);
    }
    parts.insert(parts.begin(), rest);
    return parts;
  }

  /// Restricts a grid to cells `begin` to `begin + count - 1` along an axis.
  static void cut(MacGrid& grid, int axis, int begin, int count) {
    grid.first += begin * grid.stride[axis];
    grid.origin[axis] += begin;
    if (grid.is_stretched(axis)) grid.table[axis] += begin;
    grid.n[axis] = count;
  }

  /// Velocity components `first` to `first + components - 1` in a box of cells.
  [[nodiscard]] ArrayBox velocity_box(const std::array<int, 3>& begin, const std::array<int, 3>& extent,
                                      int first, int components) const {
    const MacGrid& g = _grid;
    return {.first = first * g.component + g.offset(begin[0], begin[1], begin[2]),
            .stride = {g.stride[0], g.stride[1], g.stride[2]},
            .component = g.component,
            .extent = {extent[0], extent[1], extent[2]},
            .components = components};
  }

  [[nodiscard]] ArrayBox pressure_box(std::size_t axis, int layer) const {
    const MacGrid& g = _grid;
    const std::int64_t stride[3] = {1, g.n[0], static_cast<std::int64_t>(g.n[0]) * g.n[1]};
    ArrayBox box{.first = layer * stride[axis],
                 .stride = {1, stride[1], stride[2]},
                 .component = 0,
                 .extent = {g.n[0], g.n[1], g.n[2]},
                 .components = 1};
    box.extent[axis] = 1;
    return box;
  }

  /// Messages of the velocity to and from the rank beyond a side, or beyond the edge between two sides.
  void add_direction(const std::array<int, 3>& direction) {
    std::array<int, 3> inner{}, outer{}, extent{}, opposite{};
    linear::PencilRanks beyond = _ranks;
    bool is_self = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const int n = _grid.n[axis], towards = direction[axis];
      const std::size_t low = 2 * axis, high = low + 1;
      opposite[axis] = -towards;
      if (towards == 0) {
        // With the faces on a high side of the domain.
        extent[axis] = n + (_grid.ghost[axis] > 0 && !_borders[high] ? 1 : 0);
        continue;
      }
      const std::size_t side = towards > 0 ? high : low;
      if (!_borders[side]) return;
      is_self = false;
      beyond.place = place_beyond(beyond, side);
      inner[axis] = towards > 0 ? n - ghost_width : 0;
      outer[axis] = towards > 0 ? n : -ghost_width;
      extent[axis] = ghost_width;
    }
    if (is_self) return;
    const auto tag = [](const std::array<int, 3>& to) { return 3 * to[1] + to[2] + 4; };
    const int peer = _ranks.rank_at(beyond.place);
    _velocity.add_send(peer, tag(direction), velocity_box(inner, extent, 0, 3));
    _velocity.add_receive(peer, tag(opposite), velocity_box(outer, extent, 0, 3));
  }

  /// Messages of single layers along an axis.
  void add_axis(std::size_t axis) {
    const std::size_t low = 2 * axis, high = low + 1;
    const int n = _grid.n[axis], component = static_cast<int>(axis), tag = static_cast<int>(axis);
    std::array<int, 3> begin{}, extent{_grid.n[0], _grid.n[1], _grid.n[2]};
    extent[axis] = 1;
    if (_borders[low]) {
      const int peer = _ranks.rank_at(place_beyond(_ranks, low));
      _faces.add_send(peer, tag, velocity_box(begin, extent, component, 1));
      _below[axis] = _pressure.add_receive(peer, tag, pressure_box(axis, 0).size());
    }
    if (_borders[high]) {
      const int peer = _ranks.rank_at(place_beyond(_ranks, high));
      begin[axis] = n;
      _faces.add_receive(peer, tag, velocity_box(begin, extent, component, 1));
      _pressure.add_send(peer, tag, pressure_box(axis, n - 1));
    }
  }

  linear::RankGroup _group;
  linear::PencilRanks _ranks;
  MacGrid _grid;
  std::array<bool, 6> _borders{};  ///< sides towards other ranks
  std::vector<MacGrid> _parts;
  Exchange<ExecutionSpace> _velocity, _faces, _pressure;
  linear::Transfers _transfers;  ///< of the velocity
  Kokkos::Array<const double*, 3> _below{};
};

}  // namespace drogue::flow
