// Connector of Kokkos Tools: NVTX ranges named as kernels and regions, for Nsight Systems and Nsight Compute.
// KOKKOS_TOOLS_LIBS names the library (docs/perf-reference.md). The interface is that of
// Kokkos_Profiling_C_Interface.h.

#include <nvtx3/nvToolsExt.h>

#include <cstdint>

namespace {

void push(const char* name, std::uint64_t* kernel) {
  *kernel = 0;
  nvtxRangePushA(name);
}

}  // namespace

// Functions that Kokkos looks up by name; `kernel` comes back when the kernel ends.
extern "C" {

void kokkosp_begin_parallel_for(const char* name, std::uint32_t /*device*/, std::uint64_t* kernel) {
  push(name, kernel);
}
void kokkosp_end_parallel_for(std::uint64_t /*kernel*/) { nvtxRangePop(); }

void kokkosp_begin_parallel_scan(const char* name, std::uint32_t /*device*/, std::uint64_t* kernel) {
  push(name, kernel);
}
void kokkosp_end_parallel_scan(std::uint64_t /*kernel*/) { nvtxRangePop(); }

void kokkosp_begin_parallel_reduce(const char* name, std::uint32_t /*device*/, std::uint64_t* kernel) {
  push(name, kernel);
}
void kokkosp_end_parallel_reduce(std::uint64_t /*kernel*/) { nvtxRangePop(); }

void kokkosp_push_profile_region(const char* name) { nvtxRangePushA(name); }
void kokkosp_pop_profile_region() { nvtxRangePop(); }
}
