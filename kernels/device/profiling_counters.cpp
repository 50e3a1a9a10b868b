#include "kernels/device/profiling_counters.hpp"

#include <Kokkos_Core.hpp>
#include <algorithm>
#include <atomic>
#include <cstring>

namespace drogue::device {

namespace {

struct Counters {
  std::atomic<std::int64_t> launches{0}, fences{0}, allocations{0}, h2d{0}, d2h{0}, copies{0};
  std::atomic<std::int64_t> bytes{0}, peak{0}, warm_allocations{0};
  std::atomic<bool> warm{false}, installed{false};
};

Counters counters;                           // NOLINT: callbacks are plain functions
Kokkos::Tools::Experimental::EventSet tool;  // NOLINT: what a loaded tool had installed

bool is_host_memory(const char* space) {
  return std::strncmp(space, "Host", 4) == 0 || std::strstr(space, "HostPinned") != nullptr;
}

template <auto next>
void count_kernel(const char* label, const std::uint32_t device, std::uint64_t* id) {
  ++counters.launches;
  if (tool.*next != nullptr) (tool.*next)(label, device, id);
}

void count_fence(const char* label, const std::uint32_t device, std::uint64_t* id) {
  ++counters.fences;
  if (tool.begin_fence != nullptr) tool.begin_fence(label, device, id);
}

void count_allocation(Kokkos_Profiling_SpaceHandle space, const char* label, const void* pointer,
                      const std::uint64_t size) {
  // Kokkos 4.5 requests zero bytes of team scratch at every launch of a team policy, which allocates nothing.
  if (size > 0) {
    ++counters.allocations;
    if (counters.warm) ++counters.warm_allocations;
  }
  if (!is_host_memory(space.name) || std::strstr(space.name, "Pinned") == nullptr) {
    const std::int64_t now = counters.bytes += static_cast<std::int64_t>(size);
    std::int64_t peak = counters.peak;
    while (now > peak && !counters.peak.compare_exchange_weak(peak, now)) {
    }
  }
  if (tool.allocate_data != nullptr) tool.allocate_data(space, label, pointer, size);
}

void count_deallocation(Kokkos_Profiling_SpaceHandle space, const char* label, const void* pointer,
                        const std::uint64_t size) {
  if (!is_host_memory(space.name) || std::strstr(space.name, "Pinned") == nullptr)
    counters.bytes -= static_cast<std::int64_t>(size);
  if (tool.deallocate_data != nullptr) tool.deallocate_data(space, label, pointer, size);
}

void count_copy(Kokkos_Profiling_SpaceHandle to, const char* to_label, const void* to_pointer,
                Kokkos_Profiling_SpaceHandle from, const char* from_label, const void* from_pointer,
                std::uint64_t size) {
  ++counters.copies;
  if (is_host_memory(from.name) && !is_host_memory(to.name)) counters.h2d += static_cast<std::int64_t>(size);
  if (!is_host_memory(from.name) && is_host_memory(to.name)) counters.d2h += static_cast<std::int64_t>(size);
  if (tool.begin_deep_copy != nullptr)
    tool.begin_deep_copy(to, to_label, to_pointer, from, from_label, from_pointer, size);
}

}  // namespace

void start_profiling() {
  using Kokkos::Tools::Experimental::EventSet;
  namespace tools = Kokkos::Tools::Experimental;
  // A second installation would call itself as the tool that was there before.
  if (counters.installed.exchange(true)) return;
  tool = tools::get_callbacks();
  tools::set_begin_parallel_for_callback(count_kernel<&EventSet::begin_parallel_for>);
  tools::set_begin_parallel_reduce_callback(count_kernel<&EventSet::begin_parallel_reduce>);
  tools::set_begin_parallel_scan_callback(count_kernel<&EventSet::begin_parallel_scan>);
  tools::set_begin_fence_callback(count_fence);
  tools::set_allocate_data_callback(count_allocation);
  tools::set_deallocate_data_callback(count_deallocation);
  tools::set_begin_deep_copy_callback(count_copy);
}

void end_warmup() { counters.warm = true; }

void count_launch() { ++counters.launches; }

ProfilingCounters profiling_counters() {
  return {.kernel_launches = counters.launches,
          .fences = counters.fences,
          .allocations = counters.allocations,
          .h2d_bytes = counters.h2d,
          .d2h_bytes = counters.d2h,
          .copies = counters.copies,
          .device_bytes = counters.bytes,
          .peak_device_bytes = counters.peak,
          .allocations_after_warmup = counters.warm_allocations};
}

}  // namespace drogue::device
