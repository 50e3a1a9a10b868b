#include "perf/models/occupancy.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace drogue::perf {
namespace {

constexpr int warp = 32, kib = 1024;

// By member: name; multiprocessors, unknown; blocks, threads; registers, those of a block, their unit, those
// of a thread; partitions, those of a launch; shared memory, its unit, that of a block, what the system
// reserves from 8.0 on, which a block cannot request. Systems on a chip (3.2, 5.3, 6.2) hold half of the
// registers in a block, as 3.7, which has twice as many. 6.0 has two partitions, but launches what the rest
// of its family can.
constexpr Architecture known[] = {
    {"sm_20", 0, 8, 1536, 32 * kib, 32 * kib, 64, 63, 2, 2, 48 * kib, 128, 48 * kib, 0},
    {"sm_21", 0, 8, 1536, 32 * kib, 32 * kib, 64, 63, 2, 2, 48 * kib, 128, 48 * kib, 0},
    {"sm_30", 0, 16, 2048, 64 * kib, 64 * kib, 256, 63, 4, 4, 48 * kib, 256, 48 * kib, 0},
    {"sm_32", 0, 16, 2048, 64 * kib, 32 * kib, 256, 255, 4, 4, 48 * kib, 256, 48 * kib, 0},
    {"sm_35", 0, 16, 2048, 64 * kib, 64 * kib, 256, 255, 4, 4, 48 * kib, 256, 48 * kib, 0},
    {"sm_37", 0, 16, 2048, 128 * kib, 64 * kib, 256, 255, 4, 4, 112 * kib, 256, 48 * kib, 0},
    {"sm_50", 0, 32, 2048, 64 * kib, 64 * kib, 256, 255, 4, 4, 64 * kib, 256, 48 * kib, 0},
    {"sm_52", 0, 32, 2048, 64 * kib, 64 * kib, 256, 255, 4, 4, 96 * kib, 256, 48 * kib, 0},
    {"sm_53", 0, 32, 2048, 64 * kib, 32 * kib, 256, 255, 4, 4, 64 * kib, 256, 48 * kib, 0},
    {"sm_60", 0, 32, 2048, 64 * kib, 64 * kib, 256, 255, 2, 4, 64 * kib, 256, 48 * kib, 0},
    {"sm_61", 0, 32, 2048, 64 * kib, 64 * kib, 256, 255, 4, 4, 96 * kib, 256, 48 * kib, 0},
    {"sm_62", 0, 32, 2048, 64 * kib, 32 * kib, 256, 255, 4, 4, 64 * kib, 256, 48 * kib, 0},
    {"sm_70", 0, 32, 2048, 64 * kib, 64 * kib, 256, 255, 4, 4, 96 * kib, 256, 96 * kib, 0},
    {"sm_72", 0, 32, 2048, 64 * kib, 64 * kib, 256, 255, 4, 4, 96 * kib, 256, 96 * kib, 0},
    {"sm_75", 0, 16, 1024, 64 * kib, 64 * kib, 256, 255, 4, 4, 64 * kib, 256, 64 * kib, 0},
    {"sm_80", 0, 32, 2048, 64 * kib, 64 * kib, 256, 255, 4, 4, 164 * kib, 128, 163 * kib, 1024},
    {"sm_86", 0, 16, 1536, 64 * kib, 64 * kib, 256, 255, 4, 4, 100 * kib, 128, 99 * kib, 1024},
    {"sm_87", 0, 16, 1536, 64 * kib, 64 * kib, 256, 255, 4, 4, 164 * kib, 128, 163 * kib, 1024},
    {"sm_88", 0, 16, 1536, 64 * kib, 64 * kib, 256, 255, 4, 4, 100 * kib, 128, 99 * kib, 1024},
    {"sm_89", 0, 24, 1536, 64 * kib, 64 * kib, 256, 255, 4, 4, 100 * kib, 128, 99 * kib, 1024},
    {"sm_90", 0, 32, 2048, 64 * kib, 64 * kib, 256, 255, 4, 4, 228 * kib, 128, 227 * kib, 1024},
    {"sm_100", 0, 32, 2048, 64 * kib, 64 * kib, 256, 255, 4, 4, 228 * kib, 128, 227 * kib, 1024},
    {"sm_103", 0, 32, 2048, 64 * kib, 64 * kib, 256, 255, 4, 4, 228 * kib, 128, 227 * kib, 1024},
    {"sm_110", 0, 24, 1536, 64 * kib, 64 * kib, 256, 255, 4, 4, 228 * kib, 128, 227 * kib, 1024},
    {"sm_120", 0, 24, 1536, 64 * kib, 64 * kib, 256, 255, 4, 4, 100 * kib, 128, 99 * kib, 1024},
    {"sm_121", 0, 24, 1536, 64 * kib, 64 * kib, 256, 255, 4, 4, 100 * kib, 128, 99 * kib, 1024}};

constexpr int rounded_up(int value, int unit) { return (value + unit - 1) / unit * unit; }

int blocks_by_registers(const Architecture& on, int warps, int registers) {
  const int per_warp = rounded_up(std::max(registers, 1) * warp, on.register_unit);
  // The launch check assumes that the warps are spread evenly over all partitions.
  if (registers > on.thread_registers ||
      per_warp * rounded_up(warps, on.launch_partitions) > on.block_registers)
    return 0;
  return on.registers / on.partitions / per_warp * on.partitions / warps;
}

int blocks_by_shared_memory(const Architecture& on, int bytes, int carve_out) {
  if (bytes > on.block_shared_bytes) return 0;
  const int allocated = std::max(rounded_up(bytes + on.reserved_bytes, on.shared_unit), 1);
  return (carve_out > 0 ? std::min(carve_out, on.shared_bytes) : on.shared_bytes) / allocated;
}

}  // namespace

Architecture fermi() {
  Architecture a = *find_architecture("sm_20");
  a.multiprocessors = 14;
  a.register_unit = a.partitions = a.launch_partitions = a.shared_unit = 1;
  return a;
}

std::span<const Architecture> architectures() { return known; }

const Architecture* find_architecture(std::string_view name) {
  std::string wanted(name);
  std::erase(wanted, '.');
  if (!wanted.starts_with("sm_")) wanted = "sm_" + wanted;
  const auto found = std::ranges::find(known, wanted, &Architecture::name);
  return found == std::end(known) ? nullptr : found;
}

Architecture hopper() {
  Architecture a = *find_architecture("sm_90");
  a.multiprocessors = 132;
  return a;
}

Occupancy occupancy(const Architecture& on, const Block& block, int carve_out) {
  const int warps = (block.threads + warp - 1) / warp;
  Occupancy o{};
  o.by_registers = blocks_by_registers(on, warps, block.registers);
  o.by_shared_memory = blocks_by_shared_memory(on, block.shared_bytes, carve_out);
  o.by_threads = block.threads > largest_block ? 0 : on.threads / (warps * warp);
  o.by_limit = on.blocks;
  o.blocks = std::min({o.by_registers, o.by_shared_memory, o.by_threads, o.by_limit});
  o.threads = o.blocks * block.threads;
  o.device_threads = o.threads * on.multiprocessors;
  o.occupancy = static_cast<double>(o.threads) / on.threads;
  return o;
}

std::string limits_of(const Occupancy& o) {
  std::string text;
  for (const auto& [blocks, name] :
       {std::pair{o.by_registers, "registers"}, std::pair{o.by_shared_memory, "shared memory"},
        std::pair{o.by_threads, "threads"}, std::pair{o.by_limit, "blocks"}})
    if (blocks == o.blocks) text += (text.empty() ? "" : " and ") + std::string(name);
  return text;
}

}  // namespace drogue::perf
