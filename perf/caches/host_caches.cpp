#include "perf/caches/host_caches.hpp"

#include <charconv>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace drogue::perf {
namespace {

std::string first_line(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  return line;
}

/// Bytes of "480K", the only unit of Linux; 0 for another text.
std::int64_t bytes_of(const std::string& size) {
  std::int64_t kib = 0;
  const char* const end = size.data() + size.size();
  const auto [rest, error] = std::from_chars(size.data(), end, kib);
  return error == std::errc() && std::string_view(rest, end) == "K" ? 1024 * kib : 0;
}

/// True for "cpu7".
bool is_core(const std::string& name) {
  return name.starts_with("cpu") && name.size() > 3 &&
         name.find_first_not_of("0123456789", 3) == std::string::npos;
}

/// Paths in a folder, none where it cannot be read. A core that is offline has no folder of caches.
std::vector<std::filesystem::path> entries(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> paths;
  std::error_code error;
  // Not by a range: `++` of the iterator throws.
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error))
    paths.push_back(entry->path());
  return paths;
}

}  // namespace

std::map<std::int64_t, int> host_caches(int level, const std::filesystem::path& cpus) {
  std::map<std::string, std::int64_t> by_cores;  // bytes by the list of cores that share a cache
  for (const std::filesystem::path& core : entries(cpus)) {
    if (!is_core(core.filename().string())) continue;
    for (const std::filesystem::path& folder : entries(core / "cache")) {
      if (first_line(folder / "level") != std::to_string(level) ||
          first_line(folder / "type") == "Instruction")
        continue;
      const std::string cores = first_line(folder / "shared_cpu_list");
      const std::int64_t bytes = bytes_of(first_line(folder / "size"));
      if (cores.empty() || bytes <= 0) return {};
      by_cores[cores] = bytes;
    }
  }
  std::map<std::int64_t, int> caches;
  for (const auto& [cores, bytes] : by_cores) ++caches[bytes];
  return caches;
}

std::int64_t host_cache_bytes(int level, const std::filesystem::path& cpus) {
  std::int64_t sum = 0;
  for (const auto& [bytes, count] : host_caches(level, cpus)) sum += count * bytes;
  return sum;
}

}  // namespace drogue::perf
