#pragma once

#include <Kokkos_Core.hpp>
#include <type_traits>

namespace drogue::perf {

/// Time of work on a device between two CUDA events around it, s: without the latency of its first launch and
/// without the wait of the host for its end. `enqueue` enqueues on `space` alone. Blocking. 0 on a host,
/// where `enqueue` is not called. Throws what `enqueue` throws, and std::runtime_error for a CUDA error.
template <class ExecutionSpace, class Enqueue>
double device_time(const ExecutionSpace& space, const Enqueue& enqueue) {
#if defined(KOKKOS_ENABLE_CUDA)
  if constexpr (std::is_same_v<ExecutionSpace, Kokkos::Cuda>) {
    struct Event {
      cudaEvent_t event = nullptr;
      Event() { KOKKOS_IMPL_CUDA_SAFE_CALL(cudaEventCreate(&event)); }
      ~Event() { cudaEventDestroy(event); }
      Event(const Event&) = delete;
      Event& operator=(const Event&) = delete;
    };
    const Event begin, end;
    KOKKOS_IMPL_CUDA_SAFE_CALL(cudaEventRecord(begin.event, space.cuda_stream()));
    enqueue();
    KOKKOS_IMPL_CUDA_SAFE_CALL(cudaEventRecord(end.event, space.cuda_stream()));
    KOKKOS_IMPL_CUDA_SAFE_CALL(cudaEventSynchronize(end.event));
    float milliseconds = 0.0F;
    KOKKOS_IMPL_CUDA_SAFE_CALL(cudaEventElapsedTime(&milliseconds, begin.event, end.event));
    return 1e-3 * static_cast<double>(milliseconds);
  }
#endif
  static_cast<void>(space), static_cast<void>(enqueue);
  return 0.0;
}

}  // namespace drogue::perf
