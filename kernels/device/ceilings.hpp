#pragma once

#include <memory>

#include "kernels/device/backend.hpp"

namespace drogue::device {

/// What a backend can do at most, by kernels that do nothing else.
enum class Ceiling {
  fp64,    ///< independent chains of fused multiply-adds in registers
  memory,  ///< a = b + s c (the triad of McCalpin 1995) over arrays that no cache holds
  cache,   ///< the same to and fro in what the L1 cache of each core holds, or the L2 cache of a GPU
};

/// A kernel with a known number of operations and a result in closed form. Needs an initialised runtime.
class CeilingKernel {
 public:
  virtual ~CeilingKernel() = default;

  /// Brings back the values that `run` begins with, and waits.
  virtual void reset() = 0;

  /// One launch; waits for its end.
  virtual void run() = 0;

  /// Largest relative difference from the closed form.
  [[nodiscard]] virtual double error() = 0;

  [[nodiscard]] virtual double flops() const = 0;  ///< of a launch; a fused multiply-add is two
  [[nodiscard]] virtual double bytes() const = 0;  ///< of a launch, read and written as the program says
};

/// Throws std::invalid_argument for a backend that is not compiled in.
[[nodiscard]] std::unique_ptr<CeilingKernel> create_ceiling(Backend backend, Ceiling ceiling);

}  // namespace drogue::device
