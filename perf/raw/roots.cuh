#pragma once

// Reciprocals and roots by hardware approximations and one cubic Newton step, as in kernels/device/pack.hpp.

namespace drogue::perf::raw {

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
