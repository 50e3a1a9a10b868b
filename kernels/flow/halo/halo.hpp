#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "kernels/device/launch.hpp"
#include "kernels/device/memory.hpp"
#include "kernels/device/relaxed_access.hpp"
#include "kernels/flow/halo/agreement.hpp"
#include "kernels/flow/halo/decomposition.hpp"
#include "kernels/flow/halo/exchange.hpp"
#include "kernels/flow/observables/totals.hpp"
#include "kernels/flow/views.hpp"

namespace drogue::flow {

/// Everything that a solver on one of several ranks needs from the others. Functions are collective, except
/// those that only return values, and asynchronous as `linear::DeviceCommunicator` is, unless stated
/// otherwise. That of a process alone does nothing, at no cost: it neither allocates nor launches nor fences.
template <class ExecutionSpace>
class Halo {
 public:
  using Communicator = linear::DeviceCommunicator<ExecutionSpace>;

  /// `grid`: cells of this rank. Blocks. Throws std::runtime_error if memory runs out, and as the constructor
  /// of the communicator does.
  Halo(const ExecutionSpace& space, const linear::RankGroup& group, const linear::PencilRanks& ranks,
       const Parameters& parameters, const MacGrid& grid)
      : _communicator(space, group), _ranks(ranks), _grid(grid) {
    for (std::size_t side = 0; side < 6; ++side) _borders[side] = borders_rank(parameters, ranks, side);
    for (const int y : {-1, 0, 1})
      for (const int z : {-1, 0, 1}) add_direction({0, y, z});
    for (const std::size_t axis : {1U, 2U}) add_axis(axis);
    _parts = divided();
    if (is_alone()) return;
    _agreement = decltype(_agreement)("drogue::flow::agreement");
    _of_ranks = List<ExecutionSpace>("drogue::flow::of_ranks", 2 * static_cast<std::size_t>(group.size()));
    _interrupt = decltype(_interrupt)("drogue::flow::interrupt");
  }

  [[nodiscard]] const Communicator& communicator() const { return _communicator; }
  [[nodiscard]] const linear::RankGroup& group() const { return _communicator.group(); }
  /// True without other ranks.
  [[nodiscard]] bool is_alone() const { return group().size() == 1; }

  /// Declares that the ghost cells towards other ranks are not those of the velocity field in use, and
  /// returns whether there are any. Does not throw.
  bool outdate_velocity() {
    _is_outdated = _velocity.has_messages();
    return _is_outdated;
  }

  /// Begins the exchange of the ghost cells of a velocity field towards other ranks if they are outdated.
  void begin_velocity(const ExecutionSpace& space, const List<ExecutionSpace>& velocity) {
    if (!_is_outdated || _is_under_way) return;
    _velocity.begin(space, _communicator, velocity.data());
    _is_under_way = true;
  }

  /// Fills the ghost cells of that velocity field towards other ranks if they are outdated, and returns
  /// whether they were. Ghost cells at the sides of the domain must be filled afterwards.
  bool finish_velocity(const ExecutionSpace& space, const List<ExecutionSpace>& velocity) {
    if (!_is_outdated) return false;
    begin_velocity(space, velocity);
    _velocity.finish(space, _communicator, velocity.data());
    _is_outdated = _is_under_way = false;
    return true;
  }

  /// Parts of the cells: first those whose momentum needs no ghost cells towards other ranks, then the
  /// others. All cells in one part if these are too few to be divided, or no other rank needs any.
  [[nodiscard]] const std::vector<MacGrid>& parts() const { return _parts; }

  /// First axis that has ghost cells towards other ranks; 3 if none has. Does not throw.
  [[nodiscard]] int first_divided_axis() const {
    int axis = 0;
    while (axis < 3 && !_borders[static_cast<std::size_t>(2 * axis)] &&
           !_borders[static_cast<std::size_t>(2 * axis + 1)])
      ++axis;
    return axis;
  }

  /// Fills the normal components on the high faces that belong to other ranks.
  void exchange_high_faces(const ExecutionSpace& space, const List<ExecutionSpace>& velocity) const {
    _faces.run(space, _communicator, velocity.data());
  }

  /// Fills `pressure_below`.
  void exchange_pressure(const ExecutionSpace& space, const List<ExecutionSpace>& pressure) const {
    _pressure.run(space, _communicator, pressure.data());
  }

  /// Pressure in the layer of cells below the low side along each axis, in the order of the cells of the
  /// side; null where there is no other rank.
  [[nodiscard]] const Kokkos::Array<const double*, 3>& pressure_below() const { return _below; }

  /// Asks for the end of the advance after the step under way, on all ranks, or withdraws that. Not
  /// collective. Does not throw.
  void ask_for_interrupt(bool wish) const { device::relaxed_store(_interrupt.data(), wish ? 1 : 0); }

  /// Gives all ranks the least failed cell, the largest `StepMaxima`, the failures of a pressure solver and a
  /// side, and whether a rank has asked for an interrupt. `checks_inflow`: whether to fail for the net inflow
  /// of all ranks.
  void agree(const ExecutionSpace& space, const ControlView<ExecutionSpace>& view, bool checks_inflow) const {
    if (is_alone()) return;
    contribute(space, view, _interrupt.data());
    _communicator.maximize(space, agreed_values());
    adopt(space, view, checks_inflow);
  }

  /// Fills `pressure_below`, and lets the ranks agree as `agree` does, but on no interrupt.
  void exchange_pressure_and_agree(const ExecutionSpace& space, const List<ExecutionSpace>& pressure,
                                   const ControlView<ExecutionSpace>& view, bool checks_inflow) const {
    if (is_alone()) return;
    contribute(space, view, nullptr);
    _pressure.run(space, _communicator, pressure.data(), agreed_values());
    adopt(space, view, checks_inflow);
  }

  /// Gives all ranks the energies of all, in the order of the ranks.
  void combine(const ExecutionSpace& space, const EnergyView<ExecutionSpace>& whole) const {
    if (is_alone()) return;
    _communicator.gather(space, whole.data(), _of_ranks.data(), 2);
    device::launch_each(
        space, "drogue::flow::combine_energies_of_ranks", 1,
        CombineEnergiesOfRanksFunctor<ExecutionSpace>{whole, _of_ranks.data(), group().size()});
  }

  /// Combines the contributions of all ranks to the totals, in the order of the ranks, and adds those to the
  /// flow through each side. Blocks.
  void combine(PartTotals& part) const {
    if (is_alone()) return;
    constexpr std::size_t count = total_count;
    std::array<double, count + 6> mine;
    std::copy_n(part.sum, count, mine.begin());
    std::copy_n(part.outflow, 6, mine.begin() + count);
    const std::vector<double> all = group().gather(mine);
    part = {};
    for (std::size_t at = 0; at < all.size(); at += mine.size()) {
      combine_totals(part.sum, all.data() + at);
      for (std::size_t side = 0; side < 6; ++side) part.outflow[side] += all[at + count + side];
    }
  }

 private:
  /// What the ranks agree on, as numbers of which each becomes the largest.
  [[nodiscard]] std::span<std::uint64_t> agreed_values() const {
    constexpr std::size_t values = sizeof(Agreement) / sizeof(std::uint64_t);
    static_assert(values * sizeof(std::uint64_t) == sizeof(Agreement));
    return {&_agreement.data()->next_rate_bits, values};
  }
  /// Writes what this rank contributes. `interrupt`: its wish; null: none.
  void contribute(const ExecutionSpace& space, const ControlView<ExecutionSpace>& view,
                  const int* interrupt) const {
    device::launch_each(space, "drogue::flow::contribute", 1,
                        ContributeFunctor<ExecutionSpace>{view, _agreement.data(), interrupt});
  }
  /// Takes over what the ranks agreed on.
  void adopt(const ExecutionSpace& space, const ControlView<ExecutionSpace>& view, bool checks_inflow) const {
    device::launch_each(space, "drogue::flow::adopt", 1,
                        AdoptFunctor<ExecutionSpace>{view, _agreement.data()});
    if (!checks_inflow) return;
    // The net inflow and its magnitude.
    _communicator.gather(space, &view.data()->net_inflow, _of_ranks.data(), 2);
    device::launch_each(space, "drogue::flow::check_inflow_of_ranks", 1,
                        CheckInflowOfRanksFunctor<ExecutionSpace>{view, _of_ranks.data(), group().size()});
  }

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

  Communicator _communicator;
  linear::PencilRanks _ranks;
  MacGrid _grid;
  std::array<bool, 6> _borders{};  ///< sides towards other ranks
  std::vector<MacGrid> _parts;
  Exchange<ExecutionSpace> _velocity, _faces, _pressure;
  bool _is_outdated = false, _is_under_way = false;  ///< exchange of the velocity
  Kokkos::Array<const double*, 3> _below{};
  Kokkos::View<Agreement, typename ExecutionSpace::memory_space> _agreement;
  List<ExecutionSpace> _of_ranks;  ///< two numbers of each
  Kokkos::View<int, device::HostPinnedSpace<ExecutionSpace>> _interrupt;
};

}  // namespace drogue::flow
