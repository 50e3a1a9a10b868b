#pragma once

#include <chrono>

namespace drogue {

/// Wall-clock time since construction. Does not throw.
class Stopwatch {
 public:
  /// Elapsed time, s.
  [[nodiscard]] double seconds() const {
    return std::chrono::duration<double>(SteadyClock::now() - _begin).count();
  }

 private:
  using SteadyClock = std::chrono::steady_clock;
  SteadyClock::time_point _begin = SteadyClock::now();
};

/// Adds the wall-clock time of its lifetime, s, to a sum.
class ScopedStopwatch {
 public:
  explicit ScopedStopwatch(double& sum) : _sum(sum) {}
  ~ScopedStopwatch() { _sum += _stopwatch.seconds(); }
  ScopedStopwatch(const ScopedStopwatch&) = delete;
  ScopedStopwatch& operator=(const ScopedStopwatch&) = delete;

 private:
  double& _sum;
  Stopwatch _stopwatch;
};

}  // namespace drogue
