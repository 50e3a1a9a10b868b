#include "common/run/uncertainty.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string_view>

namespace drogue::run {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// Least number of independent batches from which an error is stated.
constexpr double least_independent = 3.0;

constexpr double round_off = 1e-26;  // of squares

double mean_over(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Sum of the products of the deviations from the mean of values and of those `lag` places later.
double covariance_sum(std::span<const double> values, std::size_t lag) {
  const double mean = mean_over(values);
  double sum = 0.0;
  for (std::size_t i = lag; i < values.size(); ++i) sum += (values[i] - mean) * (values[i - lag] - mean);
  return sum;
}

/// Quantile by linear interpolation between sorted values.
double quantile(std::span<const double> sorted, double probability) {
  const double place = probability * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return std::lerp(sorted[below], sorted[above], place - static_cast<double>(below));
}

/// Half width of the 95 % confidence interval of the mean of independent results.
double half_width_by_scatter(std::span<const double> results, double deviation) {
  const auto count = static_cast<double>(results.size());
  const double standard_error = deviation / std::sqrt(count), factor = student_factor(count - 1.0);
  if (count < 3.0 || deviation == 0.0) return factor * standard_error;
  const double mean = mean_over(results);
  double cubes = 0.0;
  for (const double result : results) cubes += std::pow((result - mean) / deviation, 3);
  const double skewness = cubes * count / ((count - 1.0) * (count - 2.0));
  return factor * standard_error * (1.0 + std::abs(skewness) * factor / (6.0 * std::sqrt(count)));
}

}  // namespace

double student_factor(double freedom) {
  struct Row {
    double freedom, factor;
  };
  constexpr std::array<Row, 13> table = {{{1, 12.706},
                                          {1.5, 6.017},
                                          {2, 4.303},
                                          {2.5, 3.575},
                                          {3, 3.182},
                                          {4, 2.776},
                                          {5, 2.571},
                                          {6, 2.447},
                                          {8, 2.306},
                                          {10, 2.228},
                                          {20, 2.086},
                                          {40, 2.021},
                                          {std::numeric_limits<double>::infinity(), 1.960}}};
  const auto above = std::ranges::find_if(table, [&](const Row& row) { return row.freedom > freedom; });
  if (above == table.begin()) return table.front().factor;
  if (above == table.end()) return table.back().factor;
  const auto below = std::prev(above);
  const double part = (1.0 / freedom - 1.0 / below->freedom) / (1.0 / above->freedom - 1.0 / below->freedom);
  return std::lerp(below->factor, above->factor, part);
}

double batch_half_width(std::span<const double> means) {
  if (means.size() != batches || !std::ranges::all_of(means, [](double mean) { return std::isfinite(mean); }))
    return unknown;
  constexpr auto count = static_cast<double>(batches);
  const double squares = covariance_sum(means, 0);
  if (squares <= round_off * std::pow(mean_over(means), 2)) return 0.0;
  // The estimate of the correlation of few values is too low by about (1 + 3 r) / n.
  const double estimate = covariance_sum(means, 1) / squares,
               correlation = std::clamp((count * estimate + 1.0) / (count - 3.0), 0.0, 0.9),
               variance_ratio = (1.0 + correlation) / (1.0 - correlation),
               independent = count / variance_ratio;
  if (independent < least_independent) return unknown;
  return student_factor(independent - 1.0) * std::sqrt(squares / (count - 1.0) * variance_ratio / count);
}

double batch_half_width(const std::function<double(double from, double to)>& statistic, double from,
                        double to) {
  std::array<double, batches> means{};
  const auto end_of = [&](std::size_t batch) {
    return std::lerp(from, to, static_cast<double>(batch) / static_cast<double>(batches));
  };
  for (std::size_t i = 0; i < batches; ++i) means[i] = statistic(end_of(i), end_of(i + 1));
  return batch_half_width(means);
}

Distribution distribution_of(std::vector<double> results, std::span<const double> half_widths) {
  if (results.empty()) throw std::invalid_argument("a distribution needs at least one result");
  std::ranges::sort(results);
  const auto count = static_cast<double>(results.size());
  Distribution all;
  all.runs = results.size();
  all.mean = mean_over(results);
  all.lowest = quantile(results, 0.05);
  all.highest = quantile(results, 0.95);
  const bool scatters = results.size() > 1;
  all.deviation = scatters ? std::sqrt(covariance_sum(results, 0) / (count - 1.0)) : unknown;
  const double by_scatter = scatters ? half_width_by_scatter(results, all.deviation) : unknown;
  const double by_time =
      half_widths.empty()
          ? unknown
          : std::sqrt(std::inner_product(half_widths.begin(), half_widths.end(), half_widths.begin(), 0.0)) /
                static_cast<double>(half_widths.size());
  all.half_width = std::fmax(by_scatter, by_time);
  return all;
}

ErrorBar error_bar(const Distribution& only) { return {only.mean, only.half_width, only.half_width, 0.0}; }

ErrorBar error_bar(const Distribution& coarse, const Distribution& fine, double ratio) {
  const double difference = std::hypot(fine.mean - coarse.mean, fine.half_width, coarse.half_width),
               grid = grid_safety * difference / (std::pow(ratio, assumed_order) - 1.0);
  return {fine.mean, std::hypot(fine.half_width, grid), fine.half_width, grid};
}

std::string number_text(double value, int digits) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  if (std::abs(value) < 1e9 && std::string_view(text).find("e+") != std::string_view::npos)
    std::snprintf(text, sizeof text, "%.0f", std::strtod(text, nullptr));
  return text;
}

std::string bar_text(double value, double half_width) {
  if (half_width == 0.0) return number_text(value, 4) + " +- 0";
  if (!std::isfinite(half_width) || half_width < 0.0) return number_text(value, 4);
  char text[64];
  const int behind_point = 1 - static_cast<int>(std::floor(std::log10(half_width)));
  if (behind_point < 0) {
    const double unit = std::pow(10.0, -behind_point);
    std::snprintf(text, sizeof text, "%.0f +- %.0f", std::round(value / unit) * unit,
                  std::round(half_width / unit) * unit);
    return text;
  }
  std::snprintf(text, sizeof text, "%.*f +- %.*f", behind_point, value, behind_point, half_width);
  return text;
}

}  // namespace drogue::run
