#pragma once

#include <numeric>
#include <vector>

namespace drogue::study {

/// When a run that is timed has been repeated often enough: after `most` runs, or once all of them together
/// took `seconds`.
struct Repeats {
  int most;
  double seconds;

  /// Whether runs of these times, s, are enough.
  [[nodiscard]] bool reached(const std::vector<double>& samples) const {
    return static_cast<int>(samples.size()) >= most ||
           (!samples.empty() && std::accumulate(samples.begin(), samples.end(), 0.0) >= seconds);
  }
};

}  // namespace drogue::study
