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

// Reciprocals and roots by hardware approximations and one cubic Newton step, as in kernels/device/pack.hpp.

/// 1/x within 1 ulp for normal x.
__device__ inline double reciprocal(double x) {
  double y;
  asm("rcp.approx.ftz.f64 %0, %1;" : "=d"(y) : "d"(x));
  const double e = fma(-x, y, 1.0);
  return fma(y, fma(e, e, e), y);
}

/// sqrt(x), 1/sqrt(x) and 1/x of a positive normal number.
struct Root {
  double value, inverse, reciprocal;
};

/// Roots of x within 2 ulp.
__device__ inline Root root(double x) {
  double y;
  asm("rsqrt.approx.ftz.f64 %0, %1;" : "=d"(y) : "d"(x));
  const double e = fma(-x, y * y, 1.0);
  y = fma(y * e, fma(e, 0.375, 0.5), y);
  return {x * y, y, y * y};
}

}  // namespace drogue::perf::raw
