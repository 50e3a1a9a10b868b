#pragma once

#include <Kokkos_Core.hpp>
#include <cstddef>
#include <initializer_list>

#include "kernels/device/copy.hpp"
#include "kernels/device/memory.hpp"
#include "kernels/linear/parallel/rank_group.hpp"

namespace drogue::coupling {

/// Sum over ranks of what the faces of each contribute to values at points (`GridTransfer`), with a message
/// buffer that is allocated once. MPI without support of devices suffices.
template <class ExecutionSpace>
class RankSum {
 public:
  using Vectors = Kokkos::View<double* [3], Kokkos::LayoutLeft, typename ExecutionSpace::memory_space>;

  /// Sums of at most `arrays` arrays of (points, 3). Throws std::runtime_error if memory runs out.
  RankSum(const linear::RankGroup& group, std::size_t points, std::size_t arrays)
      : _group(group), _buffer("drogue::coupling::rank_sum", group.size() > 1 ? 3 * points * arrays : 0) {}

  /// Replaces arrays of (points, 3), of any unit, by their sums, which have the same bits on all ranks.
  /// Collective; blocks until the sums are known. Does nothing on one rank. Throws std::runtime_error after a
  /// failed kernel.
  void operator()(const ExecutionSpace& space, std::initializer_list<Vectors> values) const {
    if (_group.size() == 1) return;
    using enum device::CopyKind;
    const auto for_each_part = [&](const auto& visit) {
      double* part = _buffer.data();
      for (const Vectors& array : values) {
        visit(array.data(), part, array.size() * sizeof *part);
        part += array.size();
      }
      return static_cast<std::size_t>(part - _buffer.data());
    };
    const std::size_t numbers = for_each_part([&](const double* array, double* part, std::size_t bytes) {
      device::copy_bytes(space, to_host_pinned, part, array, bytes);
    });
    space.fence("drogue::coupling::rank_sum");
    _group.sum({_buffer.data(), numbers});
    // The next sum waits for these copies before it overwrites the buffer.
    for_each_part([&](double* array, const double* part, std::size_t bytes) {
      device::copy_bytes(space, to_device, array, part, bytes);
    });
  }

 private:
  linear::RankGroup _group;
  Kokkos::View<double*, device::HostPinnedSpace<ExecutionSpace>> _buffer;
};

}  // namespace drogue::coupling
