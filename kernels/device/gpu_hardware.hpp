#pragma once

#include <cstdint>

namespace drogue::device {

/// Hardware of a GPU, with 0 for what is unknown.
struct GpuHardware {
  int multiprocessors = 0;
  int clock_khz = 0;          ///< highest clock of the multiprocessors
  int registers = 0;          ///< of 32 bits, per multiprocessor
  std::int64_t memory = 0;    ///< global memory, bytes
  std::int64_t constant = 0;  ///< constant memory, bytes
  std::int64_t shared = 0;    ///< shared memory per multiprocessor, bytes
  std::int64_t l2 = 0;        ///< L2 cache, bytes
};

/// Hardware of the present GPU; all 0 without one. Requires an initialised runtime. Does not throw.
[[nodiscard]] GpuHardware gpu_hardware();

}  // namespace drogue::device
