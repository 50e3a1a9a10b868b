#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include <Kokkos_Core.hpp>

#include "kernels/device/launch.hpp"
#include "kernels/device/memory.hpp"
#include "kernels/linear/parallel/cell_box.hpp"
#include "kernels/linear/parallel/rank_group.hpp"

namespace drogue::linear {

/// Copies an array, x fastest, to consecutive blocks of its parts along an axis, or back. Each block is x
/// fastest. The parts are nearly equal once `missing` entries are put before the first.
struct BlockCopyFunctor {
  int cells[3];
  int axis, parts, missing;
  bool to_blocks;
  double *array, *blocks;

  KOKKOS_FUNCTION void operator()(const int at) const {
    const int nx = cells[0], ny = cells[1], n = cells[axis] + missing;
    int index[3] = {at % nx, at / nx % ny, at / nx / ny};
    const int along = index[axis] + missing + 1;
    const int part = static_cast<int>((static_cast<std::int64_t>(parts) * along - 1) / n);
    const auto begin_of = [&](int of) {
      return of == 0 ? 0 : static_cast<int>(static_cast<std::int64_t>(n) * of / parts) - missing;
    };
    const int begin = begin_of(part);
    int extent[3] = {cells[0], cells[1], cells[2]};
    extent[axis] = begin_of(part + 1) - begin;
    index[axis] -= begin;
    const std::int64_t others = static_cast<std::int64_t>(cells[(axis + 1) % 3]) * cells[(axis + 2) % 3];
    const std::int64_t place =
        others * begin + index[0] + extent[0] * (index[1] + static_cast<std::int64_t>(extent[1]) * index[2]);
    if (to_blocks)
      blocks[place] = array[at];
    else
      array[at] = blocks[place];
  }
};

/// Message buffer on the host, which kernels of a device access directly.
template <class ExecutionSpace>
using HostBuffer = Kokkos::View<double*, device::HostPinnedSpace<ExecutionSpace>>;

/// Redistribution of a box of cells among the ranks of a group: before, each rank has a part of the cells
/// along the axis `gathered` and all along the axis `split`; after, the reverse. Arrays are x fastest.
template <class ExecutionSpace>
class PencilTranspose {
 public:
  using List = Kokkos::View<double*, typename ExecutionSpace::memory_space>;
  using Buffer = HostBuffer<ExecutionSpace>;

  /// `before`: cells of this rank; `whole`: number along the axis `gathered`, without the `missing` ones with
  /// which the first part of that axis would be as large as the others. Not collective. Does not throw but
  /// std::bad_alloc.
  PencilTranspose(const RankGroup& group, const CellBox& before, std::size_t gathered, int whole,
                  std::size_t split, int missing = 0)
      : _group(group),
        _gathered(gathered),
        _split(split),
        _missing(missing),
        _before(before),
        _after(before) {
    const int ranks = group.size(), n = before.cells[split];
    _after.begin[gathered] = 0;
    _after.cells[gathered] = whole;
    _after.begin[split] = before.begin[split] + part_begin(n, ranks, group.rank());
    _after.cells[split] = part_size(n, ranks, group.rank());
    const int third = before.cells[3 - gathered - split];
    for (int rank = 0; rank < ranks; ++rank) {
      _sent.push_back(third * before.cells[gathered] * part_size(n, ranks, rank));
      const int own = part_size(whole + missing, ranks, rank) - (rank == 0 ? missing : 0);
      _received.push_back(third * own * _after.cells[split]);
    }
  }

  /// Cells of this rank after the transposition. Does not throw.
  [[nodiscard]] const CellBox& after() const { return _after; }

  /// Transposes `from`, the cells before, to `to`, the cells after. Both buffers have at least as many
  /// entries as either. Collective; blocks until the messages are complete, but not for the kernel that fills
  /// `to`.
  void forward(const ExecutionSpace& space, const List& from, const List& to, const Buffer& send,
               const Buffer& receive) const {
    move(space, from, to, send, receive, true);
  }

  /// Inverse of `forward`.
  void backward(const ExecutionSpace& space, const List& from, const List& to, const Buffer& send,
                const Buffer& receive) const {
    move(space, from, to, send, receive, false);
  }

 private:
  void move(const ExecutionSpace& space, const List& from, const List& to, const Buffer& send,
            const Buffer& receive, bool is_forward) const {
    copy_blocks(space, is_forward, from, send, true);
    space.fence("drogue::linear::pencil_transpose: packed");
    _group.redistribute(send.data(), is_forward ? _sent : _received, receive.data(),
                        is_forward ? _received : _sent);
    copy_blocks(space, !is_forward, to, receive, false);
  }

  void copy_blocks(const ExecutionSpace& space, bool before, const List& array, const Buffer& blocks,
                   bool to_blocks) const {
    const std::array<int, 3>& n = before ? _before.cells : _after.cells;
    const int count = n[0] * n[1] * n[2];
    if (count == 0) return;
    device::launch_each(space, "drogue::linear::pencil_transpose", count,
                        BlockCopyFunctor{.cells = {n[0], n[1], n[2]},
                                         .axis = static_cast<int>(before ? _split : _gathered),
                                         .parts = _group.size(),
                                         .missing = before ? 0 : _missing,
                                         .to_blocks = to_blocks,
                                         .array = array.data(),
                                         .blocks = blocks.data()});
  }

  RankGroup _group;
  std::size_t _gathered, _split;
  int _missing;
  CellBox _before, _after;
  std::vector<int> _sent, _received;  ///< numbers to and from each rank, forward
};

}  // namespace drogue::linear
