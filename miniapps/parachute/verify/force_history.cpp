#include "miniapps/parachute/verify/force_history.hpp"

#include <algorithm>
#include <limits>

namespace drogue::parachute_app {
namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

std::size_t first_from(const std::vector<double>& time, double from) {
  return static_cast<std::size_t>(std::ranges::lower_bound(time, from) - time.begin());
}

}  // namespace

double mean_from(const std::vector<double>& time, const std::vector<double>& value, double from) {
  const std::size_t first = first_from(time, from);
  if (first + 1 >= time.size()) return not_a_number;
  double integral = 0.0;
  for (std::size_t k = first + 1; k < time.size(); ++k)
    integral += 0.5 * (value[k - 1] + value[k]) * (time[k] - time[k - 1]);
  return integral / (time.back() - time[first]);
}

double frequency_from(const std::vector<double>& time, const std::vector<double>& value, double from) {
  const double mean = mean_from(time, value, from);
  double first = 0.0, last = 0.0;
  int crossings = 0;
  for (std::size_t k = first_from(time, from) + 1; k < time.size(); ++k) {
    const double before = value[k - 1] - mean, after = value[k] - mean;
    if (!(before < 0.0 && after >= 0.0)) continue;
    last = time[k - 1] + (time[k] - time[k - 1]) * before / (before - after);
    if (crossings++ == 0) first = last;
  }
  return crossings >= 3 ? (crossings - 1) / (last - first) : not_a_number;
}

double amplitude_from(const std::vector<double>& time, const std::vector<double>& value, double from) {
  const auto first = value.begin() + static_cast<std::ptrdiff_t>(first_from(time, from));
  if (first == value.end()) return not_a_number;
  const auto [least, largest] = std::minmax_element(first, value.end());
  return 0.5 * (*largest - *least);
}

}  // namespace drogue::parachute_app
