#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

namespace drogue::stepping {

/// Number of steps that a host takes between two polls. It doubles after batches that were short, and halves
/// after one that took longer than a wall-clock time, s. It changes no result.
class BatchLength {
 public:
  /// `most`: largest number of steps.
  explicit BatchLength(double longest_s = 0.1,
                       std::int64_t most = std::numeric_limits<std::int64_t>::max() / 2)
      : _longest_s(longest_s), _most(most) {}

  [[nodiscard]] std::int64_t steps() const { return _steps; }

  /// Adapts the number to a batch of so many steps, which took so many seconds.
  void adapt(std::int64_t steps, double seconds) {
    if (seconds > _longest_s) _steps = std::max<std::int64_t>(1, _steps / 2);
    if (seconds < share_of_longest * _longest_s && steps == _steps) _steps = std::min(2 * _steps, _most);
  }

 private:
  /// Less than a half, so that twice as many steps remain below the longest time.
  static constexpr double share_of_longest = 0.4;

  double _longest_s;
  std::int64_t _most, _steps = 1;
};

}  // namespace drogue::stepping
