#include "common/run/history_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "common/run/statistics.hpp"

namespace drogue::run {
namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// Extremum of the parabola through three values, of which the middle one is the largest or the least.
double vertex(const double* time, const double* value) {
  const double slope = (value[1] - value[0]) / (time[1] - time[0]);
  const double curvature = ((value[2] - value[1]) / (time[2] - time[1]) - slope) / (time[2] - time[0]);
  if (curvature == 0.0) return value[1];
  const double at = 0.5 * (time[0] + time[1] - slope / curvature);
  return value[0] + (at - time[0]) * (slope + curvature * (at - time[1]));
}

/// Largest value times `sign`; NaN without rows and if a value is NaN.
double largest_of(std::span<const double> values, double sign) {
  if (values.empty()) return not_a_number;
  double largest = sign * values.front();
  for (const double value : values) largest = maximum_or_nan(largest, sign * value);
  return largest;
}

}  // namespace

HistoryRows rows_between(const HistoryRows& rows, double from, double to) {
  // Round-off of a time moves no row off the end of an interval.
  constexpr double earlier = 1.0 - 1e-9, later = 1.0 + 1e-9;
  const auto& time = rows.time;
  if (time.empty() || time.front() > later * from) return {};
  const auto first = static_cast<std::size_t>(std::ranges::lower_bound(time, earlier * from) - time.begin()),
             end = static_cast<std::size_t>(std::ranges::upper_bound(time, later * to) - time.begin()),
             count = end > first ? end - first : 0;
  return {rows.time.subspan(first, count), rows.value.subspan(first, count)};
}

double mean_of(const HistoryRows& rows) {
  const auto& [time, value] = rows;
  if (time.size() < 2) return not_a_number;
  double integral = 0.0;
  for (std::size_t k = 1; k < time.size(); ++k)
    integral += 0.5 * (value[k - 1] + value[k]) * (time[k] - time[k - 1]);
  return integral / (time.back() - time.front());
}

double mean_between(const HistoryRows& all, double from, double to) {
  const HistoryRows rows = rows_between(all, from, to);
  const double mean = mean_of(rows);
  if (std::isnan(mean)) return mean;
  // The parts between the ends of the interval and its rows.
  const auto part = [&](double row, double value, double end) {
    return 0.5 * (value + value_at(all, end)) * std::abs(end - row);
  };
  const double first = rows.time.front(), last = rows.time.back(), begin = std::min(from, first),
               end = std::clamp(to, last, all.time.back());
  return (mean * (last - first) + part(first, rows.value.front(), begin) +
          part(last, rows.value.back(), end)) /
         (end - begin);
}

double frequency_of(const HistoryRows& rows) {
  const auto& [time, value] = rows;
  const double mean = mean_of(rows);
  double first = 0.0, last = 0.0;
  int crossings = 0;
  for (std::size_t k = 1; k < time.size(); ++k) {
    const double before = value[k - 1] - mean, after = value[k] - mean;
    if (!(before < 0.0 && after >= 0.0)) continue;
    last = time[k - 1] + (time[k] - time[k - 1]) * before / (before - after);
    if (crossings++ == 0) first = last;
  }
  return crossings >= 3 ? (crossings - 1) / (last - first) : not_a_number;
}

double value_at(const HistoryRows& rows, double time) {
  const auto after = static_cast<std::size_t>(std::ranges::upper_bound(rows.time, time) - rows.time.begin());
  if (after == 0) return not_a_number;
  const double before = rows.value[after - 1];
  if (after == rows.time.size()) return before;
  const double weight = (time - rows.time[after - 1]) / (rows.time[after] - rows.time[after - 1]);
  return before + weight * (rows.value[after] - before);
}

double amplitude_of(const HistoryRows& rows) {
  const auto& [time, value] = rows;
  if (value.size() < 2) return not_a_number;
  const auto [least, largest] = std::ranges::minmax_element(value);
  const double most = 0.5 * (1.0 - std::cos(std::numbers::pi / 8.0)) * (*largest - *least);
  const auto extremum = [&](auto row) {
    const auto k = static_cast<std::size_t>(row - value.begin());
    if (k == 0 || k + 1 == value.size()) return *row;
    return *row + std::clamp(vertex(&time[k - 1], &value[k - 1]) - *row, -most, most);
  };
  return 0.5 * (extremum(largest) - extremum(least));
}

double statistic_of(Statistic statistic, const HistoryRows& all, double from, double to) {
  const HistoryRows rows = rows_between(all, from, to);
  switch (statistic) {
    case Statistic::mean:
      return mean_between(all, from, to);
    case Statistic::max:
      return largest_of(rows.value, 1.0);
    case Statistic::min:
      return -largest_of(rows.value, -1.0);
    case Statistic::last:
      return value_at(all, to);
    case Statistic::frequency:
      return frequency_of(rows);
    case Statistic::amplitude:
      return amplitude_of(rows);
  }
  return not_a_number;
}

double rows_in_period(const HistoryRows& rows, double frequency) {
  const std::span<const double> time = rows.time;
  return time.size() < 2 ? 0.0
                         : static_cast<double>(time.size() - 1) / ((time.back() - time.front()) * frequency);
}

}  // namespace drogue::run
