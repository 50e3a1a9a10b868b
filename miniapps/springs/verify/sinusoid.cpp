#include "miniapps/springs/verify/sinusoid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace drogue::springs_app {
namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// Solves a symmetric positive definite system of three equations by Gaussian elimination; rows are [A | b].
std::array<double, 3> solved(std::array<std::array<double, 4>, 3> rows) {
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t i = k + 1; i < 3; ++i) {
      const double factor = rows[i][k] / rows[k][k];
      for (std::size_t j = k; j < 4; ++j) rows[i][j] -= factor * rows[k][j];
    }
  std::array<double, 3> x{};
  for (std::size_t k = 3; k-- > 0;) {
    double sum = rows[k][3];
    for (std::size_t j = k + 1; j < 3; ++j) sum -= rows[k][j] * x[j];
    x[k] = sum / rows[k][k];
  }
  return x;
}

/// Residual sum of squares of the samples after a fit of 1, cos(omega t) and sin(omega t).
double residual(const std::vector<double>& time, const std::vector<double>& value, double omega) {
  std::array<std::array<double, 4>, 3> normal{};
  const auto basis = [omega](double t) { return std::array{1.0, std::cos(omega * t), std::sin(omega * t)}; };
  for (std::size_t k = 0; k < time.size(); ++k) {
    const auto b = basis(time[k]);
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) normal[i][j] += b[i] * b[j];
      normal[i][3] += b[i] * value[k];
    }
  }
  const std::array<double, 3> x = solved(normal);
  double sum = 0.0;
  for (std::size_t k = 0; k < time.size(); ++k) {
    const auto b = basis(time[k]);
    const double left = value[k] - x[0] * b[0] - x[1] * b[1] - x[2] * b[2];
    sum += left * left;
  }
  return sum;
}

/// Minimum of a unimodal function between `low` and `high` by golden-section search.
template <class Function>
double least(const Function& f, double low, double high) {
  const double share = 1.0 / std::numbers::phi;
  double a = high - share * (high - low), b = low + share * (high - low);
  double at_a = f(a), at_b = f(b);
  for (int k = 0; k < 60; ++k) {
    if (at_a < at_b) {
      high = b, b = a, at_b = at_a;
      a = high - share * (high - low), at_a = f(a);
    } else {
      low = a, a = b, at_a = at_b;
      b = low + share * (high - low), at_b = f(b);
    }
  }
  return 0.5 * (low + high);
}

}  // namespace

double fitted_frequency(const std::vector<double>& time, const std::vector<double>& value) {
  const double mean = std::accumulate(value.begin(), value.end(), 0.0) /
                      static_cast<double>(std::max<std::size_t>(1, value.size()));
  std::vector<double> crossings;
  for (std::size_t k = 1; k < value.size(); ++k) {
    const double before = value[k - 1] - mean, after = value[k] - mean;
    if ((before < 0.0) == (after < 0.0)) continue;
    crossings.push_back(time[k - 1] + (time[k] - time[k - 1]) * before / (before - after));
  }
  if (crossings.size() < 3) return not_a_number;
  const double periods = 0.5 * static_cast<double>(crossings.size() - 1);
  const double guess = 2.0 * std::numbers::pi * periods / (crossings.back() - crossings.front());
  // The residual has one minimum within half a period of the whole record.
  const double width = std::min(0.5 * guess, 0.5 * std::numbers::pi / (time.back() - time.front()));
  const double omega =
      least([&](double w) { return residual(time, value, w); }, guess - width, guess + width);
  return omega / (2.0 * std::numbers::pi);
}

double half_rise_time(const std::vector<double>& time, const std::vector<double>& value) {
  double largest = 0.0;
  for (const double v : value) largest = std::max(largest, std::abs(v - value.front()));
  const double half = 0.5 * largest;
  for (std::size_t k = 1; k < value.size() && largest > 0.0; ++k) {
    const double before = std::abs(value[k - 1] - value.front()), after = std::abs(value[k] - value.front());
    if (after >= half) return time[k - 1] + (time[k] - time[k - 1]) * (half - before) / (after - before);
  }
  return not_a_number;
}

}  // namespace drogue::springs_app
