#pragma once

#include <chrono>

namespace drogue::device {

/// Wall time since construction.
class Stopwatch {
 public:
  /// Elapsed wall time, s. Does not throw; it waits for no enqueued work.
  [[nodiscard]] double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - _begin).count();
  }

 private:
  std::chrono::steady_clock::time_point _begin = std::chrono::steady_clock::now();
};

}  // namespace drogue::device
