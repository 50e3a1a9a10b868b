#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "common/program/stopwatch.hpp"
#include "common/run/statistics.hpp"

namespace drogue::perf {

/// Median of the seconds that some calls of `work` return. Passes on exceptions of `work`.
inline double median_of_works(const std::function<double()>& work) {
  constexpr int works = 7;
  std::vector<double> seconds;
  for (int i = 0; i < works; ++i) seconds.push_back(work());
  return run::median(seconds);
}

/// Wall times of the parts h2d, compute and d2h of a sample, s, which are done in this order. Passes on
/// exceptions.
inline std::map<std::string, double> timed_parts(const std::function<void()>& h2d,
                                                 const std::function<void()>& compute,
                                                 const std::function<void()>& d2h) {
  const auto seconds_of = [](const std::function<void()>& work) {
    const Stopwatch stopwatch;
    work();
    return stopwatch.seconds();
  };
  const double up = seconds_of(h2d), work = seconds_of(compute), down = seconds_of(d2h);
  return {{"h2d", up}, {"compute", work}, {"d2h", down}};
}

}  // namespace drogue::perf
