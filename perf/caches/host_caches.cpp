#include "perf/caches/host_caches.hpp"

#include <charconv>
#include <fstream>
#include <string>
#include <string_view>

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

}  // namespace

std::map<std::int64_t, int> host_caches(int level, const std::filesystem::path& cpus) {
  std::map<std::string, std::int64_t> by_cores;  // bytes by the list of cores that share a cache
  std::error_code ignored;
  for (const auto& core : std::filesystem::directory_iterator(cpus, ignored)) {
    if (!is_core(core.path().filename().string())) continue;
    for (const auto& cache : std::filesystem::directory_iterator(core.path() / "cache", ignored)) {
      const std::filesystem::path& folder = cache.path();
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

}  // namespace drogue::perf
