#include "miniapps/parachute/verify/force_history.hpp"

#include <algorithm>
#include <limits>

namespace drogue::parachute_app {
namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

std::size_t first_from(const std::vector<double>& time, double from) {
  return static_cast<std::size_t>(std::ranges::lower_bound(time, from) - time.begin());
}

/// Extremum of the parabola through three values, of which the middle one is the largest or the least.
double vertex(const double* time, const double* value) {
  const double slope = (value[1] - value[0]) / (time[1] - time[0]);
  const double curvature = ((value[2] - value[1]) / (time[2] - time[1]) - slope) / (time[2] - time[0]);
  if (curvature == 0.0) return value[1];
  const double at = 0.5 * (time[0] + time[1] - slope / curvature);
  return value[0] + (at - time[0]) * (slope + curvature * (at - time[1]));
}

}  // namespace

std::size_t rows_from(const std::vector<double>& time, double from) {
  return time.size() - first_from(time, from);
}

double rows_in_period(const std::vector<double>& time, double from, double frequency) {
  const std::size_t rows = rows_from(time, from);
  return rows < 2 ? 0.0
                  : static_cast<double>(rows - 1) / ((time.back() - time[time.size() - rows]) * frequency);
}

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
  const std::size_t first = first_from(time, from);
  const auto begin = value.begin() + static_cast<std::ptrdiff_t>(first);
  if (begin == value.end()) return not_a_number;
  const auto [least, largest] = std::minmax_element(begin, value.end());
  const auto extremum = [&](auto row) {
    const auto k = static_cast<std::size_t>(row - value.begin());
    return k > first && k + 1 < value.size() ? vertex(&time[k - 1], &value[k - 1]) : *row;
  };
  return 0.5 * (extremum(largest) - extremum(least));
}

}  // namespace drogue::parachute_app
