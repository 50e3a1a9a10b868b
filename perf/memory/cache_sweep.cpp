#include "perf/memory/cache_sweep.hpp"

#include <Kokkos_Core.hpp>
#include <stdexcept>

namespace drogue::perf {

namespace {

/// Least part of a cache line that any processor loads, bytes.
constexpr std::int64_t sector = 32;

/// Sum over the first number of each sector.
template <class ExecutionSpace>
struct ReadSectorsFunctor {
  using View = Kokkos::View<std::int32_t*, typename ExecutionSpace::memory_space>;

  typename View::const_type buffer;

  KOKKOS_FUNCTION void operator()(std::int64_t i, std::int64_t& sum) const {
    sum += buffer(i * (sector / static_cast<std::int64_t>(sizeof(std::int32_t))));
  }
};

template <class ExecutionSpace>
std::function<std::int64_t()> create_sweep(std::int64_t bytes) {
  using Functor = ReadSectorsFunctor<ExecutionSpace>;
  using Policy = Kokkos::RangePolicy<ExecutionSpace, Kokkos::IndexType<std::int64_t>>;
  const typename Functor::View buffer("drogue::perf::swept_buffer",
                                      static_cast<std::size_t>(bytes) / sizeof(std::int32_t));
  Kokkos::deep_copy(buffer, 1);
  return [functor = Functor{buffer}, sectors = bytes / sector] {
    std::int64_t sum = 0;
    Kokkos::parallel_reduce("drogue::perf::cache_sweep", Policy(0, sectors), functor, sum);
    return sum;
  };
}

}  // namespace

std::function<std::int64_t()> create_cache_sweep(bool on_device, std::int64_t bytes) {
  if (!on_device) return create_sweep<Kokkos::DefaultHostExecutionSpace>(bytes);
#if defined(KOKKOS_ENABLE_CUDA)
  return create_sweep<Kokkos::Cuda>(bytes);
#else
  throw std::invalid_argument("this build has no device whose caches could be emptied");
#endif
}

}  // namespace drogue::perf
