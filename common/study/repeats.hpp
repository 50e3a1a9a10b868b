#pragma once

#include <numeric>
#include <vector>

namespace drogue::study {

/// Stopping rule of repeated timings: after `most` runs, or once their total time reaches `seconds`.
struct Repeats {
  int most;
  double seconds;

  /// True if the samples, s, suffice.
  [[nodiscard]] bool reached(const std::vector<double>& samples) const {
    return static_cast<int>(samples.size()) >= most ||
           (!samples.empty() && std::accumulate(samples.begin(), samples.end(), 0.0) >= seconds);
  }
};

}  // namespace drogue::study
