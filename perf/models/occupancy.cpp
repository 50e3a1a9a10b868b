#include "perf/models/occupancy.hpp"

#include <algorithm>

namespace drogue::perf {
namespace {

constexpr int warp = 32;

constexpr int rounded_up(int value, int unit) { return (value + unit - 1) / unit * unit; }

int blocks_by_registers(const Architecture& on, int warps, int registers) {
  const int per_warp = rounded_up(registers * warp, on.register_unit);
  // The launch check assumes that the warps are spread evenly over all partitions.
  if (per_warp * rounded_up(warps, on.partitions) > on.registers) return 0;
  return on.registers / on.partitions / per_warp * on.partitions / warps;
}

}  // namespace

Architecture fermi() {
  return {.name = "sm_20",
          .multiprocessors = 14,
          .blocks = 8,
          .threads = 1536,
          .registers = 32'768,
          .register_unit = 1,
          .partitions = 1,
          .shared_bytes = 48 * 1024,
          .shared_unit = 1,
          .reserved_bytes = 0};
}

Architecture hopper() {
  return {.name = "sm_90",
          .multiprocessors = 132,
          .blocks = 32,
          .threads = 2048,
          .registers = 65'536,
          .register_unit = 256,
          .partitions = 4,
          .shared_bytes = 228 * 1024,
          .shared_unit = 128,
          .reserved_bytes = 1024};
}

Occupancy occupancy(const Architecture& on, const Block& block) {
  const int warps = (block.threads + warp - 1) / warp;
  const int shared = rounded_up(block.shared_bytes + on.reserved_bytes, on.shared_unit);
  Occupancy o{};
  o.by_registers = blocks_by_registers(on, warps, block.registers);
  o.by_shared_memory = on.shared_bytes / shared;
  o.by_threads = on.threads / (warps * warp);
  o.by_limit = on.blocks;
  o.blocks = std::min({o.by_registers, o.by_shared_memory, o.by_threads, o.by_limit});
  o.threads = o.blocks * block.threads;
  o.device_threads = o.threads * on.multiprocessors;
  o.occupancy = static_cast<double>(o.threads) / on.threads;
  return o;
}

}  // namespace drogue::perf
