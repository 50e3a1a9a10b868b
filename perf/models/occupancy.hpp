#pragma once

#include <string>

namespace drogue::perf {

/// Resources of a multiprocessor and their allocation units.
struct Architecture {
  std::string name;              ///< name in compiler options: "sm_90"
  int multiprocessors;           ///< of the device
  int blocks, threads;           ///< largest numbers of resident blocks and threads
  int registers, register_unit;  ///< registers are allocated to a warp in multiples of the unit
  int partitions;  ///< equal parts of the register file; the registers of a warp lie in one of them
  int shared_bytes, shared_unit;  ///< shared memory and its allocation unit, bytes
  int reserved_bytes;             ///< shared memory that the system reserves for each block
};

/// Compute capability 2.0 as in [Shi], section 4.3, without allocation units. The Quadro 6000 used there has
/// 14 multiprocessors. Does not throw.
Architecture fermi();

/// Compute capability 9.0 by the rules of CUDA's cuda_occupancy.h. An H100 SXM and an H200 have 132
/// multiprocessors. Does not throw.
Architecture hopper();

/// Resources of a block of a kernel.
struct Block {
  int threads;
  int registers;  ///< per thread
  int shared_bytes;
};

/// Resident blocks of a multiprocessor and the resulting occupancy.
struct Occupancy {
  int by_registers, by_shared_memory, by_threads, by_limit;  ///< blocks under each limit alone
  int blocks;                                                ///< the least of these
  int threads, device_threads;
  double occupancy;  ///< fraction of the largest number of resident threads
};

/// Occupancy of `on` by blocks of one kernel. Does not throw.
Occupancy occupancy(const Architecture& on, const Block& block);

}  // namespace drogue::perf
