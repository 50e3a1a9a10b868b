#pragma once

#include <functional>
#include <vector>

#include "common/run/statistics.hpp"

namespace drogue::perf {

/// Median of the seconds that some calls of `work` return. Passes on exceptions of `work`.
inline double median_of_works(const std::function<double()>& work) {
  constexpr int works = 7;
  std::vector<double> seconds;
  for (int i = 0; i < works; ++i) seconds.push_back(work());
  return run::median(seconds);
}

}  // namespace drogue::perf
