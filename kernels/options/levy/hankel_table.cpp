#include "kernels/options/levy/hankel_table.hpp"

#include <array>
#include <numbers>

namespace drogue::options {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double smallest = 1e-300;  // lower bound of arguments of the logarithm

/// (pi z / 2) (J^2 + Y^2) by Hankel's expansion (Abramowitz and Stegun, eq. (9.2.28)), for z far above the
/// order.
double asymptotic_modulus(double order, double z) {
  const double mu = 4.0 * order * order, w = 1.0 / (4.0 * z * z);
  double term = 1.0, sum = 1.0;
  for (int k = 1; k <= 8; ++k) {
    const double odd = 2.0 * k - 1.0;
    term *= w * (odd / (2.0 * k)) * (mu - odd * odd);
    sum += term;
  }
  return sum;
}

/// m(z) of an order.
double spectral_density(double order, double z) {
  if (z > 40.0 + 4.0 * order) return z / asymptotic_modulus(order, z);
  const double j = std::cyl_bessel_j(order, z), y = std::cyl_neumann(order, z);
  return 2.0 / (pi * (j * j + y * y));
}

/// (1/pi) times the integral of m over ln z up to z, which is the phase of the Hankel function over pi.
double phase(double order, double z) {
  return std::atan2(std::cyl_bessel_j(order, z), -std::cyl_neumann(order, z)) / pi;
}

/// Nodes of a panel.
struct PanelNodes {
  std::vector<double> log_z;
  std::vector<double> spacing;  ///< d ln z / d k at node k
  int shift;                    ///< as HankelGrid::shift
};

/// Equidistant nodes in ln z.
PanelNodes even_nodes() {
  PanelNodes nodes{{}, {}, 0};
  for (int k = 0; k < HankelGrid::count; ++k) {
    nodes.log_z.push_back((HankelGrid::first + k) * HankelGrid::step);
    nodes.spacing.push_back(HankelGrid::step);
  }
  return nodes;
}

/// Nodes that are denser near the zeros of the Hankel function, where m has poles.
///
/// The zeros closest to the real axis lie at ln z = ln nu - 0.928 nu^{-2/3} -+ 1.607 i nu^{-2/3}, nu the
/// order; the others lie farther away, on a curve that leaves the axis (Abramowitz and Stegun, eq. (9.5.22)
/// with the first zero of the Airy function). With v = ln z - ln nu + 0.928 nu^{-2/3} the nodes are the
/// points where
///   k = v/step + arsinh(tanh(v)/d)/0.6 + constant
/// is an integer, d slightly below 1.607 nu^{-2/3}. The map moves the zeros to |Im k| > (pi/2)/0.6, so that
/// the trapezoidal rule misses a fraction e^{-16} of the weights. Away from v = 0 the nodes are equidistant.
/// They begin where all lower nodes contribute 1e-14 of the variance of the jumps.
PanelNodes dense_nodes(double begin) {
  constexpr double step = HankelGrid::step, density_ratio = 0.6;
  const double order = begin + 0.5, scale = std::pow(order, -2.0 / 3);
  const double centre = std::log(order) - 0.928 * scale;
  const double d = 0.9 * 1.607 * std::pow(begin + 1.0, -2.0 / 3);
  const auto index_at = [=](double v) {
    return (v + centre) / step + (std::asinh(std::tanh(v) / d) - std::asinh(1.0 / d)) / density_ratio;
  };
  const auto log_z_at = [&](int k) {
    double low = -60.0, high = 60.0;
    for (int bisection = 0; bisection < 64; ++bisection) {
      const double v = 0.5 * (low + high);
      (index_at(v) < k ? low : high) = v;
    }
    return low + centre;
  };
  const auto negligible = [=](double log_z) {
    const double log_ratio = std::log(begin) - log_z;
    return log_ratio > 0.0 &&
           spectral_density(begin, std::exp(log_z)) * std::exp(2.0 * log_ratio) < 1e-14 * begin;
  };
  int k = static_cast<int>(index_at(0.0));
  while (!negligible(log_z_at(k - 1))) --k;
  PanelNodes nodes{{}, {}, k - HankelGrid::first};
  for (int n = 0; n < HankelGrid::count; ++n) {
    const double log_z = log_z_at(k + n), v = log_z - centre;
    const double slope = std::tanh(v), near = slope / d;
    const double density =
        1.0 / step + (1.0 - slope * slope) / (density_ratio * d * std::sqrt(1.0 + near * near));
    nodes.log_z.push_back(log_z);
    nodes.spacing.push_back(1.0 / density);
  }
  return nodes;
}

}  // namespace

std::vector<double> hankel_panel(int panel) {
  using Grid = HankelGrid;
  constexpr int n = Grid::terms;
  const double begin = panel_begin(panel), end = panel_end(panel);
  const bool even = begin < 2.0;
  const PanelNodes nodes = even ? even_nodes() : dense_nodes(begin);
  std::array<std::array<double, n>, 2 * Grid::count> values{};  // at the Chebyshev points
  for (std::size_t p = 0; p < n; ++p) {
    const double t = std::cos(pi * (static_cast<double>(p) + 0.5) / n);
    const double order = 0.5 * (begin + end) + 0.5 * (end - begin) * t;
    double below = even ? phase(order, std::exp(nodes.log_z[0] - 0.5 * Grid::step)) : 0.0;
    for (std::size_t q = 0; q < Grid::count; ++q) {
      const double density =
          spectral_density(order, std::exp(nodes.log_z[q])) * (nodes.spacing[q] / Grid::step);
      values[q][p] = std::log(std::fmax(density, smallest));
      values[Grid::count + q][p] = std::log(std::fmax(below, smallest));
      below += Grid::step / pi * density;
    }
  }
  std::vector<double> table;
  table.reserve(Grid::panel_size);
  for (const auto& row : values)
    for (int k = 0; k < n; ++k) {
      double sum = 0.0;
      for (std::size_t p = 0; p < n; ++p)
        sum += row[p] * std::cos(pi * k * (static_cast<double>(p) + 0.5) / n);
      table.push_back(sum * (k == 0 ? 1.0 : 2.0) / n);
    }
  table.insert(table.end(), nodes.log_z.begin(), nodes.log_z.end());
  table.push_back(nodes.shift);
  return table;
}

}  // namespace drogue::options
