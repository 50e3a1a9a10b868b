#pragma once

#include <algorithm>
#include <cstddef>
#include <thread>
#include <vector>

namespace drogue {

/// Parts into which `count` entries are divided for threads of the host: one per core at most, and each of
/// `least` (> 0) entries or more unless one part has all. At least one. Does not throw.
[[nodiscard]] inline std::size_t thread_parts(std::size_t count, std::size_t least) {
  const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
  return std::clamp<std::size_t>(count / least, 1, cores);
}

/// Calls `work(part, begin, end)` for each of `parts` equal ranges of [0, count), each in a thread of its own
/// and the first in the calling one. `work` must not throw. Blocking. Throws std::system_error if a thread
/// cannot start.
template <class Work>
void for_thread_parts(std::size_t parts, std::size_t count, const Work& work) {
  std::vector<std::jthread> threads;
  for (std::size_t part = 1; part < parts; ++part)
    threads.emplace_back([=, &work] { work(part, count * part / parts, count * (part + 1) / parts); });
  work(std::size_t{0}, std::size_t{0}, count / parts);
}

}  // namespace drogue
