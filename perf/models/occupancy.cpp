#include "perf/models/occupancy.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace drogue::perf {
namespace {

constexpr int warp = 32, kib = 1024;

/// Common values; the tables below state what differs.
constexpr Architecture kepler(std::string_view name, int thread_registers) {
  return {.name = name,
          .multiprocessors = 0,
          .blocks = 16,
          .threads = 2048,
          .registers = 64 * kib,
          .block_registers = 64 * kib,
          .register_unit = 256,
          .thread_registers = thread_registers,
          .partitions = 4,
          .launch_partitions = 4,
          .shared_bytes = 48 * kib,
          .shared_unit = 256,
          .block_shared_bytes = 48 * kib,
          .reserved_bytes = 0};
}

/// Twice the registers of its family, of which a block holds half at most.
constexpr Architecture kepler_37() {
  Architecture a = kepler("sm_37", 255);
  a.registers = 128 * kib;
  a.shared_bytes = 112 * kib;
  return a;
}

/// The system on a chip of a family, in which a block holds half of the registers.
constexpr Architecture tegra(Architecture a) {
  a.block_registers = 32 * kib;
  return a;
}

/// From Maxwell to Turing.
constexpr Architecture maxwell(std::string_view name, int shared, int block_shared) {
  Architecture a = kepler(name, 255);
  a.blocks = 32;
  a.shared_bytes = shared * kib;
  a.block_shared_bytes = block_shared * kib;
  return a;
}

/// Pascal of 6.0 has two partitions, but launches what the rest of its family can, which has four.
constexpr Architecture pascal_60() {
  Architecture a = maxwell("sm_60", 64, 48);
  a.partitions = 2;
  return a;
}

constexpr Architecture turing() {
  Architecture a = maxwell("sm_75", 64, 64);
  a.blocks = 16;
  a.threads = 1024;
  return a;
}

/// From Ampere on, the system reserves shared memory in each block, which a block cannot request.
constexpr Architecture ampere(std::string_view name, int threads, int blocks, int shared) {
  Architecture a = maxwell(name, shared, shared - 1);
  a.threads = threads;
  a.blocks = blocks;
  a.shared_unit = 128;
  a.reserved_bytes = kib;
  return a;
}

constexpr Architecture fermi_2x(std::string_view name) {
  Architecture a = kepler(name, 63);
  a.blocks = 8;
  a.threads = 1536;
  a.registers = a.block_registers = 32 * kib;
  a.register_unit = 64;
  a.partitions = a.launch_partitions = 2;
  a.shared_unit = 128;
  return a;
}

constexpr std::array known = {fermi_2x("sm_20"),
                              fermi_2x("sm_21"),
                              kepler("sm_30", 63),
                              tegra(kepler("sm_32", 255)),
                              kepler("sm_35", 255),
                              kepler_37(),
                              maxwell("sm_50", 64, 48),
                              maxwell("sm_52", 96, 48),
                              tegra(maxwell("sm_53", 64, 48)),
                              pascal_60(),
                              maxwell("sm_61", 96, 48),
                              tegra(maxwell("sm_62", 64, 48)),
                              maxwell("sm_70", 96, 96),
                              maxwell("sm_72", 96, 96),
                              turing(),
                              ampere("sm_80", 2048, 32, 164),
                              ampere("sm_86", 1536, 16, 100),
                              ampere("sm_87", 1536, 16, 164),
                              ampere("sm_88", 1536, 16, 100),
                              ampere("sm_89", 1536, 24, 100),
                              ampere("sm_90", 2048, 32, 228),
                              ampere("sm_100", 2048, 32, 228),
                              ampere("sm_103", 2048, 32, 228),
                              ampere("sm_110", 1536, 24, 228),
                              ampere("sm_120", 1536, 24, 100),
                              ampere("sm_121", 1536, 24, 100)};

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
  Architecture a = fermi_2x("sm_20");
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
  return found == known.end() ? nullptr : &*found;
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
