#pragma once

#include <cstdint>

namespace drogue::fabric {

/// Where a solver's steps are in time. A restart that brings back all four has the same times to the bit.
struct Clock {
  std::int64_t step = 0;   ///< steps taken
  double dt = 0.0;         ///< s, of the steps to come
  std::int64_t since = 0;  ///< the step from which dt holds
  double start = 0.0;      ///< s, the time of that step

  [[nodiscard]] double time() const { return start + static_cast<double>(step - since) * dt; }
};

/// Where a state ceased to be one.
struct Failure {
  std::int64_t vertex = -1;  ///< the first in the numbering that was lost in that step
  std::int64_t step = 0;     ///< the first step, counted from 1, whose end is not finite
  double time = 0.0;         ///< s, at its end
};

}  // namespace drogue::fabric
