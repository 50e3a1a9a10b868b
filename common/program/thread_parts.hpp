#pragma once

#include <algorithm>
#include <cstddef>
#include <exception>
#include <thread>
#include <vector>

namespace drogue {

/// Parts into which `count` entries are divided for threads of the host: one per core at most, and each of
/// `least` (> 0) entries or more unless one part has all. At least one. Does not throw.
[[nodiscard]] inline std::size_t thread_parts(std::size_t count, std::size_t least) {
  const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
  return std::clamp<std::size_t>(count / least, 1, cores);
}

/// Calls `work(part, begin, end)` for each of `parts` (> 0) equal ranges of [0, count), each in a thread of
/// its own and the first in the calling one. Blocking. Rethrows the exception of the first part that threw,
/// once all parts have ended. Throws std::system_error if a thread cannot start.
template <class Work>
void for_thread_parts(std::size_t parts, std::size_t count, const Work& work) {
  std::vector<std::exception_ptr> failures(parts);
  const auto run = [&](std::size_t part) noexcept {
    try {
      work(part, count * part / parts, count * (part + 1) / parts);
    } catch (...) {
      failures[part] = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> threads;
    for (std::size_t part = 1; part < parts; ++part) threads.emplace_back([&run, part] { run(part); });
    run(0);
  }
  for (const std::exception_ptr& failure : failures)
    if (failure) std::rethrow_exception(failure);
}

}  // namespace drogue
