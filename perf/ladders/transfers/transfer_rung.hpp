#pragma once

#include <cmath>
#include <limits>
#include <memory_resource>
#include <utility>

#include "kernels/device/copy.hpp"
#include "kernels/device/instance.hpp"
#include "kernels/device/launch.hpp"
#include "kernels/device/pinned_memory.hpp"
#include "perf/ladders/make_rung.hpp"
#include "perf/ladders/transfers/problem.hpp"

namespace drogue::perf::ladder {

/// x <- 1 / (1 + x).
template <class ExecutionSpace>
struct FractionFunctor {
  Kokkos::View<double*, typename ExecutionSpace::memory_space> x;

  KOKKOS_FUNCTION void operator()(int i) const { x(i) = 1.0 / (1.0 + x(i)); }
};

/// Where the host keeps its values.
enum class ValueMemory { pageable, pinned };

/// Run with values on the host, in one kind of memory, and room for them on the device. It copies all of them
/// to the device and back at every step; derived rungs do so otherwise.
template <class ExecutionSpace>
class TransferRung : public RungRun {
 public:
  explicit TransferRung(const TransferProblem& problem, ValueMemory memory = ValueMemory::pinned)
      : _problem(problem),
        _instance(std::numeric_limits<int>::max()),
        _host(problem.start.size(),
              memory == ValueMemory::pinned ? &_pinned : std::pmr::new_delete_resource()),
        _device("drogue::perf::ladder::values", problem.start.size()) {}

  void reset() override { std::copy(_problem.start.begin(), _problem.start.end(), _host.begin()); }

  void run() override {
    for (long step = 0; step < _problem.steps; ++step) this->step();
  }

  [[nodiscard]] double error() override {
    double worst = 0.0;
    for (std::size_t i = 0; i < _host.size(); ++i)
      worst = std::max(worst, std::abs(_host[i] - _problem.expected[i]));
    return worst;
  }

 protected:
  /// Does one step of the values on the host.
  virtual void step() {
    enqueue(_instance.space(), 0, _host.size());
    _instance.space().fence("drogue::perf::ladder: values are on the host");
  }

  /// Enqueues copy, step and copy back of `count` values from `first` on.
  void enqueue(const ExecutionSpace& space, std::size_t first, std::size_t count) {
    const auto part = Kokkos::subview(_device, std::pair(first, first + count));
    device::copy_in(space, part, _host.data() + first, count);
    device::launch_each(space, "drogue::perf::ladder::fractions", static_cast<int>(count),
                        FractionFunctor<ExecutionSpace>{part});
    device::copy_out(space, _host.data() + first, part, count);
  }

  const TransferProblem& _problem;
  device::Instance<ExecutionSpace> _instance;
  device::PinnedMemory<ExecutionSpace> _pinned;  ///< outlives the values
  std::pmr::vector<double> _host;
  Kokkos::View<double*, typename ExecutionSpace::memory_space> _device;
};

}  // namespace drogue::perf::ladder
