#pragma once

#include <cuda_runtime.h>

#include <stdexcept>
#include <string>

namespace drogue::perf::raw {

/// Throws std::runtime_error with the name of the kernel and CUDA's reason if the last launch was rejected.
inline void check_launch(const char* kernel) {
  const cudaError_t status = cudaGetLastError();
  if (status != cudaSuccess)
    throw std::runtime_error(std::string("hand-written kernel '") + kernel +
                             "': " + cudaGetErrorString(status));
}

}  // namespace drogue::perf::raw
