#pragma once

// Kokkos 4.5 calls three CUDA runtime functions by signatures that CUDA 13 dropped. These overloads bring
// them back; the header is force-included into every CUDA source, because the calls are in headers of Kokkos.
// With CUDA 12 or older, or in a source of another language, it is empty.

#if defined(__CUDACC__)
#include <cuda_runtime.h>

#if CUDART_VERSION >= 13000

namespace drogue_cuda13 {

/// CUDA 12 named a place by a device number, the host by cudaCpuDeviceId.
inline cudaMemLocation location(int device) {
  cudaMemLocation place{};
  place.type = device == cudaCpuDeviceId ? cudaMemLocationTypeHost : cudaMemLocationTypeDevice;
  place.id = device == cudaCpuDeviceId ? 0 : device;
  return place;
}

}  // namespace drogue_cuda13

inline cudaError_t cudaMemPrefetchAsync(const void* pointer, size_t bytes, int device,
                                        cudaStream_t stream = nullptr) {
  return cudaMemPrefetchAsync(pointer, bytes, drogue_cuda13::location(device), 0U, stream);
}

inline cudaError_t cudaMemAdvise(const void* pointer, size_t bytes, cudaMemoryAdvise advice, int device) {
  return cudaMemAdvise(pointer, bytes, advice, drogue_cuda13::location(device));
}

/// CUDA 13 gave this name's signature to cudaMemAdvise.
inline cudaError_t cudaMemAdvise_v2(const void* pointer, size_t bytes, cudaMemoryAdvise advice,
                                    cudaMemLocation place) {
  return cudaMemAdvise(pointer, bytes, advice, place);
}

inline cudaError_t cudaGraphAddDependencies(cudaGraph_t graph, const cudaGraphNode_t* from,
                                            const cudaGraphNode_t* to, size_t count) {
  return cudaGraphAddDependencies(graph, from, to, nullptr, count);
}

#endif
#endif
