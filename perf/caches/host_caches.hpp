#pragma once

#include <cstdint>
#include <filesystem>
#include <map>

namespace drogue::perf {

/// Data and unified caches of a level (1 to 3) of the online cores: their number by size in bytes. A cache
/// that cores share counts once; a core without a folder of caches has none. Empty if Linux does not state a
/// size or the cores of each; `cpus` is its folder of cores. Throws only std::bad_alloc.
std::map<std::int64_t, int> host_caches(int level,
                                        const std::filesystem::path& cpus = "/sys/devices/system/cpu");

/// Bytes of all caches of a level together, 0 if unknown. Throws only std::bad_alloc.
std::int64_t host_cache_bytes(int level, const std::filesystem::path& cpus = "/sys/devices/system/cpu");

}  // namespace drogue::perf
