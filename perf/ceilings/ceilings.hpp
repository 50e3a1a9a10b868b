#pragma once

#include <memory>

#include "kernels/device/backend.hpp"

namespace drogue::perf {

/// Roofline ceiling of a backend, measured by a kernel that is bound by that resource alone.
enum class Ceiling {
  fp64,        ///< independent chains of fused multiply-adds in registers
  fp32,        ///< the same in single precision
  issue,       ///< fused multiply-adds and rotations of integers in turn, which different units execute; GPU
  memory,      ///< a = b + s c (the triad of McCalpin 1995) over arrays larger than every cache
  cache,       ///< repeated triads in the L1 cache of each core, or the L2 cache of a GPU
  l2,          ///< repeated triads in the L2 cache of each core; host
  l3,          ///< repeated triads in the L3 cache of a host, if all cores find room there
  launch,      ///< kernels without work, one launch after another
  graph_node,  ///< kernels without work in a captured graph; GPU
};

/// True if a backend has a ceiling on this machine. Does not throw.
[[nodiscard]] bool has_ceiling(device::Backend backend, Ceiling ceiling);

/// Kernel with a known number of operations and a result in closed form. Requires an initialised runtime. No
/// function throws, but std::runtime_error for a CUDA error.
class CeilingKernel {
 public:
  virtual ~CeilingKernel() = default;

  /// Restores the initial values. Blocking.
  virtual void reset() = 0;

  /// Launches the kernel `launches()` times. Blocking.
  virtual void run() = 0;

  /// Runs and returns the time on the device of all launches (`device_time`), s; 0 on a host, which does not
  /// run. Blocking.
  virtual double timed_run() = 0;

  /// Largest difference from the closed form, relative to one plus its value. Blocking.
  [[nodiscard]] virtual double error() = 0;

  /// Kernels that a run launches.
  [[nodiscard]] virtual long launches() const { return 1; }

  /// Floating-point operations per launch; a fused multiply-add counts as two.
  [[nodiscard]] virtual double flops() const = 0;

  /// Bytes read and written per launch, as the source states them.
  [[nodiscard]] virtual double bytes() const = 0;

  /// Arithmetic instructions per launch, each of one thread of a GPU; 0 if they are not counted.
  [[nodiscard]] virtual double instructions() const { return 0.0; }
};

/// Throws std::invalid_argument for a backend that is not compiled in, and for a ceiling that it lacks.
[[nodiscard]] std::unique_ptr<CeilingKernel> create_ceiling(device::Backend backend, Ceiling ceiling);

}  // namespace drogue::perf
