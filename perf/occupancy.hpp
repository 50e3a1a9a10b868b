#pragma once

#include <string>

namespace drogue::perf {

/// What a multiprocessor holds at once, and in what portions it gives it away.
struct Architecture {
  std::string name;     ///< as compilers call it: "sm_90"
  int multiprocessors;  ///< of the device
  int blocks, threads;
  int registers, register_unit;  ///< a warp gets a multiple of the unit
  int partitions;                ///< equal shares of registers; a warp has its registers in one of them
  int shared_bytes, shared_unit;
  int reserved_bytes;  ///< of shared memory, that the system keeps for each block
};

/// Compute capability 2.0 as section 4.3 of the dissertation counts: nothing is rounded. Its Quadro 6000 has
/// 14 multiprocessors.
Architecture fermi();

/// Compute capability 9.0 by the rules of CUDA's cuda_occupancy.h; an H200, like an H100 SXM, has 132
/// multiprocessors.
Architecture hopper();

/// What a block of a kernel needs.
struct Block {
  int threads;
  int registers;  ///< a thread
  int shared_bytes;
};

/// Blocks that a multiprocessor holds, and what follows.
struct Occupancy {
  int by_registers, by_shared_memory, by_threads, by_limit;  ///< blocks, if nothing else limited them
  int blocks;                                                ///< the least of them
  int threads, device_threads;
  double occupancy;  ///< threads over those that the multiprocessor has room for
};

Occupancy occupancy(const Architecture& on, const Block& block);

}  // namespace drogue::perf
