#include "kernels/options/hankel_table.hpp"

#include <array>
#include <numbers>

namespace drogue::options {

namespace {

constexpr double pi = std::numbers::pi;
constexpr double least = 1e-300;  // stands for what is smaller, so that its logarithm is finite

/// J^2 + Y^2 times pi z / 2 by Hankel's expansion (Abramowitz and Stegun 9.2.28), for z well above the order.
double far_modulus(double order, double z) {
  const double mu = 4.0 * order * order, w = 1.0 / (4.0 * z * z);
  double term = 1.0, sum = 1.0;
  for (int k = 1; k <= 8; ++k) {
    const double odd = 2.0 * k - 1.0;
    term *= w * (odd / (2.0 * k)) * (mu - odd * odd);
    sum += term;
  }
  return sum;
}

double spectral_density(double order, double z) {
  if (z > 40.0 + 4.0 * order) return z / far_modulus(order, z);
  const double j = std::cyl_bessel_j(order, z), y = std::cyl_neumann(order, z);
  return 2.0 / (pi * (j * j + y * y));
}

/// (1/pi) of the integral of m over ln z up to z: the phase of the Hankel function.
double phase(double order, double z) {
  return std::atan2(std::cyl_bessel_j(order, z), -std::cyl_neumann(order, z)) / pi;
}

}  // namespace

std::vector<double> hankel_panel(int panel) {
  using Grid = HankelGrid;
  constexpr int n = Grid::terms;
  const double begin = panel_begin(panel), end = panel_end(panel);
  std::array<std::array<double, n>, 2 * Grid::count> values{};  // at Chebyshev's points
  for (std::size_t p = 0; p < n; ++p) {
    const double t = std::cos(pi * (static_cast<double>(p) + 0.5) / n);
    const double order = 0.5 * (begin + end) + 0.5 * (end - begin) * t;
    double below = phase(order, std::exp((Grid::first - 0.5) * Grid::step));
    for (std::size_t q = 0; q < Grid::count; ++q) {
      const double z = std::exp((Grid::first + static_cast<int>(q)) * Grid::step);
      const double density = spectral_density(order, z);
      values[q][p] = std::log(std::fmax(density, least));
      values[Grid::count + q][p] = std::log(std::fmax(below, least));
      below += Grid::step / pi * density;
    }
  }
  std::vector<double> series;
  series.reserve(Grid::panel_size);
  for (const auto& row : values)
    for (int k = 0; k < n; ++k) {
      double sum = 0.0;
      for (std::size_t p = 0; p < n; ++p)
        sum += row[p] * std::cos(pi * k * (static_cast<double>(p) + 0.5) / n);
      series.push_back(sum * (k == 0 ? 1.0 : 2.0) / n);
    }
  return series;
}

}  // namespace drogue::options
