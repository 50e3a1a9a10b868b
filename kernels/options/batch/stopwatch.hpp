#pragma once

#include <chrono>

namespace drogue::options {

/// Wall time since it was made.
class Stopwatch {
 public:
  [[nodiscard]] double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - _begin).count();
  }

 private:
  std::chrono::steady_clock::time_point _begin = std::chrono::steady_clock::now();
};

}  // namespace drogue::options
