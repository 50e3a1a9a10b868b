#pragma once

#include <memory>

#include "kernels/device/backend.hpp"

namespace drogue::perf {

/// Roofline ceiling of a backend, measured by a kernel that is bound by that resource alone.
enum class Ceiling {
  fp64,    ///< independent chains of fused multiply-adds in registers
  memory,  ///< a = b + s c (the triad of McCalpin 1995) over arrays larger than every cache
  cache,   ///< repeated triads in the L1 cache of each core, or the L2 cache of a GPU
};

/// Kernel with a known number of operations and a result in closed form. Requires an initialised runtime. No
/// function throws.
class CeilingKernel {
 public:
  virtual ~CeilingKernel() = default;

  /// Restores the initial values. Blocking.
  virtual void reset() = 0;

  /// Launches the kernel once. Blocking.
  virtual void run() = 0;

  /// Largest difference from the closed form, relative to one plus its value. Blocking.
  [[nodiscard]] virtual double error() = 0;

  /// Floating-point operations per launch; a fused multiply-add counts as two.
  [[nodiscard]] virtual double flops() const = 0;

  /// Bytes read and written per launch, as the source states them.
  [[nodiscard]] virtual double bytes() const = 0;
};

/// Throws std::invalid_argument for a backend that is not compiled in.
[[nodiscard]] std::unique_ptr<CeilingKernel> create_ceiling(device::Backend backend, Ceiling ceiling);

}  // namespace drogue::perf
