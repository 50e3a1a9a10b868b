#pragma once

#include <Kokkos_Core.hpp>
#include <cstddef>
#include <initializer_list>

#include "kernels/device/copy.hpp"
#include "kernels/device/launch.hpp"
#include "kernels/linear/device_communicator.hpp"

namespace drogue::coupling {

/// Sums the numbers of all ranks, `distance` apart, in the order of the ranks.
struct SumOfRanksFunctor {
  const double* of_ranks;
  std::size_t distance;
  int ranks;
  double* sum;

  KOKKOS_FUNCTION void operator()(const int i) const {
    double value = 0.0;
    for (int rank = 0; rank < ranks; ++rank) value += of_ranks[static_cast<std::size_t>(rank) * distance + i];
    sum[i] = value;
  }
};

/// Sum over ranks of what the faces of each contribute to values at points (`GridTransfer`), with memory for
/// the contributions of all ranks that is allocated once.
template <class ExecutionSpace>
class RankSum {
 public:
  using Vectors = Kokkos::View<double* [3], Kokkos::LayoutLeft, typename ExecutionSpace::memory_space>;
  using Communicator = linear::DeviceCommunicator<ExecutionSpace>;

  /// Sums of at most `arrays` arrays of (points, 3). Throws std::runtime_error if memory runs out.
  RankSum(const Communicator& communicator, std::size_t points, std::size_t arrays)
      : _communicator(communicator),
        _of_ranks("drogue::coupling::of_ranks",
                  communicator.size() > 1
                      ? 3 * points * arrays * static_cast<std::size_t>(communicator.size())
                      : 0) {}

  /// Replaces arrays of (points, 3), of any unit, by their sums, which have the same bits on all ranks.
  /// Collective, and asynchronous if the communicator is. Does nothing on one rank. Throws std::runtime_error
  /// after a failed kernel.
  void operator()(const ExecutionSpace& space, std::initializer_list<Vectors> values) const {
    if (_communicator.size() == 1) return;
    std::size_t numbers = 0;
    for (const Vectors& array : values) numbers += array.size();
    double* const mine = _of_ranks.data() + numbers * static_cast<std::size_t>(_communicator.rank());
    std::size_t at = 0;
    for (const Vectors& array : values) {
      device::copy_bytes(space, device::CopyKind::within, mine + at, array.data(),
                         array.size() * sizeof *mine);
      at += array.size();
    }
    _communicator.gather(space, mine, _of_ranks.data(), numbers);
    at = 0;
    for (const Vectors& array : values) {
      device::launch_each(
          space, "drogue::coupling::sum_of_ranks", static_cast<int>(array.size()),
          SumOfRanksFunctor{_of_ranks.data() + at, numbers, _communicator.size(), array.data()});
      at += array.size();
    }
  }

 private:
  Communicator _communicator;
  Kokkos::View<double*, typename ExecutionSpace::memory_space> _of_ranks;
};

}  // namespace drogue::coupling
