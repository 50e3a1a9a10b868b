#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <string>

namespace drogue::perf {

/// Wall times of the parts h2d, compute and d2h of a sample, s, which are done in this order. Passes on
/// exceptions.
inline std::map<std::string, double> timed_parts(const std::function<void()>& h2d,
                                                 const std::function<void()>& compute,
                                                 const std::function<void()>& d2h) {
  const auto seconds_of = [](const std::function<void()>& work) {
    const auto begin = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  const double up = seconds_of(h2d), work = seconds_of(compute), down = seconds_of(d2h);
  return {{"h2d", up}, {"compute", work}, {"d2h", down}};
}

}  // namespace drogue::perf
