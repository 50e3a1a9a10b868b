#pragma once

#include <span>
#include <string>
#include <string_view>

namespace drogue::perf {

/// Resources of a multiprocessor and their allocation units.
struct Architecture {
  std::string_view name;  ///< name in compiler options: "sm_90"
  int multiprocessors;    ///< of the device; 0: of none in particular
  int blocks, threads;    ///< largest numbers of resident blocks and threads
  int registers;          ///< of all resident blocks
  int block_registers;    ///< largest number of a block
  int register_unit;      ///< registers are allocated to a warp in multiples of it
  int thread_registers;   ///< largest number of a thread
  int partitions;         ///< equal parts of the register file; the registers of a warp lie in one of them
  int launch_partitions;  ///< partitions over which the launch check spreads the warps of a block
  int shared_bytes, shared_unit;  ///< shared memory and its allocation unit, bytes
  int block_shared_bytes;         ///< largest shared memory that a block can request
  int reserved_bytes;             ///< shared memory that the system reserves for each block
};

/// Compute capability 2.0 as in [Shi], section 4.3, without allocation units. The Quadro 6000 used there has
/// 14 multiprocessors. Does not throw.
Architecture fermi();

/// All compute capabilities from 2.0 to 12.1 by the tables of the CUDA C++ Programming Guide and, from 3.0,
/// the rules of CUDA's cuda_occupancy.h; in ascending order, without a number of multiprocessors. Does not
/// throw.
std::span<const Architecture> architectures();

/// The one of that name, "sm_90", or of that compute capability, "9.0"; null if there is none. Does not
/// throw.
const Architecture* find_architecture(std::string_view name);

/// An H100 SXM or an H200: compute capability 9.0 with 132 multiprocessors. Does not throw.
Architecture hopper();

/// Resources of a block of a kernel.
struct Block {
  int threads;
  int registers;     ///< per thread
  int shared_bytes;  ///< static and dynamic, without those of the system
};

/// Largest number of threads of a block on all architectures.
inline constexpr int largest_block = 1024;

/// Resident blocks of a multiprocessor and the resulting occupancy.
struct Occupancy {
  int by_registers, by_shared_memory, by_threads, by_limit;  ///< blocks under each limit alone
  int blocks;                                                ///< the least of these
  int threads;
  int device_threads;  ///< 0 if the number of multiprocessors is unknown
  double occupancy;    ///< fraction of the largest number of resident threads
};

/// Occupancy of `on` by blocks of one kernel. `carve_out`: bytes of the memory of a multiprocessor that a
/// launch uses as shared memory and not as cache; 0: all that it can. Does not throw.
Occupancy occupancy(const Architecture& on, const Block& block, int carve_out = 0);

/// The limits that decide `o`, as "registers" or "threads and blocks". Does not throw.
std::string limits_of(const Occupancy& o);

}  // namespace drogue::perf
