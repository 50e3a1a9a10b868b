#include <algorithm>
#include <limits>
#include <memory_resource>
#include <vector>

#include "kernels/device/copy.hpp"
#include "kernels/device/instance.hpp"
#include "kernels/device/launch.hpp"
#include "kernels/device/pack.hpp"
#include "kernels/device/pinned_memory.hpp"
#include "kernels/device/stopwatch.hpp"
#include "perf/ceilings/ceilings.hpp"
#include "perf/ladders/ladder.hpp"

namespace drogue::perf::ladder {

/// Kernel without work.
struct EmptyFunctor {
  KOKKOS_FUNCTION void operator()(int) const {}
};

/// x <- 1 / (x + b) in independent chains of `R`: one division and one addition per step.
template <class ExecutionSpace, class R>
struct DivisionFunctor {
  /// Read anew for every number on a host, or the compiler makes packs of the chains.
  using Shift = std::conditional_t<device::is_host<ExecutionSpace> && device::Access<R>::lanes == 1,
                                   volatile double, double>;
  static constexpr int lanes = device::Access<R>::lanes, chains = 8, steps = 1 << 14;

  Kokkos::View<double*, typename ExecutionSpace::memory_space> sum;  ///< `lanes` values per item
  double b = 0.5;

  KOKKOS_FUNCTION void operator()(int item) const {
    R x[chains];
    for (int c = 0; c < chains; ++c) x[c] = R(1.0 + c);
    Shift shift = b;
    for (int step = 0; step < steps; ++step)
      for (int c = 0; c < chains; ++c) x[c] = R(1.0) / (x[c] + R(shift));
    R total = x[0];
    for (int c = 1; c < chains; ++c) total += x[c];
    device::Access<R>::store(sum.data() + item * lanes, total);
  }
};

/// Seconds of the fastest of `samples` calls of `work`, after one that does not count: a ceiling.
template <class Call>
double fastest_seconds(int samples, const Call& work) {
  double fastest = std::numeric_limits<double>::infinity();
  work();
  for (int sample = 0; sample < samples; ++sample) {
    const device::Stopwatch stopwatch;
    work();
    fastest = std::min(fastest, stopwatch.seconds());
  }
  return fastest;
}

/// Seconds of the fastest launch of a kernel of `perf/ceilings/`.
inline double ceiling_seconds(CeilingKernel& kernel) {
  kernel.reset();
  return fastest_seconds(5, [&] { kernel.run(); });
}

/// Divisions of all items of a backend per s.
template <class R, class ExecutionSpace>
double division_rate(const ExecutionSpace& space) {
  using Divisions = DivisionFunctor<ExecutionSpace, R>;
  const int items = space.concurrency();
  const Divisions divisions{decltype(Divisions::sum)("drogue::perf::ladder::divisions",
                                                     static_cast<std::size_t>(items * Divisions::lanes))};
  const double seconds = fastest_seconds(5, [&] {
    device::launch_each(space, "drogue::perf::ladder::divisions", items, divisions);
    space.fence("drogue::perf::ladder: divisions are done");
  });
  return static_cast<double>(items) * Divisions::lanes * Divisions::chains * Divisions::steps / seconds;
}

template <class ExecutionSpace>
Ceilings make_ceilings() {
  constexpr device::Backend backend = device::backend_of<ExecutionSpace>;
  Ceilings c;
  const auto fp64 = create_ceiling(backend, Ceiling::fp64);
  c.flops = fp64->flops() / ceiling_seconds(*fp64);
  const auto memory = create_ceiling(backend, Ceiling::memory);
  c.bandwidth = memory->bytes() / ceiling_seconds(*memory);

  const device::Instance<ExecutionSpace> instance(std::numeric_limits<int>::max());
  const ExecutionSpace& space = instance.space();
  const int items = space.concurrency();
  using Pack = std::conditional_t<device::is_host<ExecutionSpace>, device::HostPack<double>, double>;
  c.lanes = device::Access<Pack>::lanes;
  c.divisions = division_rate<Pack>(space);
  c.scalar_divisions = c.lanes == 1 ? c.divisions : division_rate<double>(space);

  constexpr int launches = 100;
  c.launch =
      fastest_seconds(7,
                      [&] {
                        for (int k = 0; k < launches; ++k)
                          device::launch_each(space, "drogue::perf::ladder::empty", items, EmptyFunctor{});
                        space.fence("drogue::perf::ladder: launches are done");
                      }) /
      launches;

  constexpr std::size_t values = std::size_t{1} << 21;  // 16 MB
  const Kokkos::View<double*, typename ExecutionSpace::memory_space> target("drogue::perf::ladder::copied",
                                                                            values);
  const auto copy_seconds = [&](const double* from, std::size_t count) {
    return fastest_seconds(5, [&] {
      device::copy_in(space, target, from, count);
      space.fence("drogue::perf::ladder: copied");
    });
  };
  const std::vector<double> pageable(values, 1.0);
  device::PinnedMemory<ExecutionSpace> memory_of_pinned;
  const std::pmr::vector<double> pinned(values, 1.0, &memory_of_pinned);
  constexpr double bytes = 8.0 * values;
  c.copy = copy_seconds(pageable.data(), 8);
  c.pageable = bytes / copy_seconds(pageable.data(), values);
  c.pinned = bytes / copy_seconds(pinned.data(), values);
  return c;
}

Ceilings measure_ceilings(device::Backend backend) {
  return device::dispatch(backend, [&]<class ExecutionSpace>() { return make_ceilings<ExecutionSpace>(); });
}

}  // namespace drogue::perf::ladder
