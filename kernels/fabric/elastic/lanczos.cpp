#include "kernels/fabric/elastic/lanczos.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace drogue::fabric {

namespace {

double product(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += a[k] * b[k];
  return sum;
}

/// Largest eigenvalue of a symmetric tridiagonal matrix with `beside[k]` between rows k and k + 1, by
/// bisection: the pivots of the matrix less x are all negative exactly if x is above every eigenvalue
/// (Sylvester's law of inertia).
double largest_eigenvalue(const std::vector<double>& diagonal, const std::vector<double>& beside) {
  const std::size_t n = diagonal.size();
  double low = diagonal[0], high = diagonal[0];
  for (std::size_t k = 0; k < n; ++k) {
    const double radius = (k > 0 ? beside[k - 1] : 0.0) + (k + 1 < n ? beside[k] : 0.0);
    low = std::max(low, diagonal[k]);
    high = std::max(high, diagonal[k] + radius);
  }
  const auto is_above = [&](double x) {
    double pivot = diagonal[0] - x;
    for (std::size_t k = 1; k < n && pivot < 0.0; ++k)
      pivot = diagonal[k] - x - beside[k - 1] * beside[k - 1] / pivot;
    return pivot < 0.0;
  };
  for (int halving = 0; halving < 60; ++halving) {
    const double middle = 0.5 * (low + high);
    (is_above(middle) ? high : low) = middle;
  }
  return low;
}

}  // namespace

double largest_ritz_value(std::size_t size, int steps, const LinearOperator& apply) {
  std::mt19937 engine(1);
  std::vector<double> now(size), before(size, 0.0), next(size);
  for (double& value : now) value = static_cast<double>(engine()) / 4294967296.0 - 0.5;
  std::vector<double> diagonal, beside;
  double norm = std::sqrt(product(now, now));
  for (int step = 0; step < steps && norm > 0.0 && std::isfinite(norm); ++step) {
    if (step > 0) beside.push_back(norm);
    for (double& value : now) value /= norm;
    apply(now, next);
    const double back = step > 0 ? norm : 0.0, own = product(now, next);
    for (std::size_t k = 0; k < size; ++k) next[k] -= own * now[k] + back * before[k];
    diagonal.push_back(own);
    before.swap(now);
    now.swap(next);
    norm = std::sqrt(product(now, now));
    // The rest of an exhausted Krylov space is round-off.
    if (norm <= 1e-12 * std::abs(own)) break;
  }
  return diagonal.empty() ? 0.0 : largest_eigenvalue(diagonal, beside);
}

double lanczos_frequency(std::span<const double> root, const std::vector<mesh::Vector>& positions,
                         double displacement, const ForceField& force_at) {
  // M^-1/2 K M^-1/2 is symmetric; fixed degrees of freedom have no row in it.
  std::vector<mesh::Vector> moved(positions.size()), ahead(positions.size()), behind(positions.size());
  const auto force_after = [&](double factor, std::span<const double> move,
                               std::vector<mesh::Vector>& force) {
    for (std::size_t k = 0; k < root.size(); ++k)
      moved[k / 3][k % 3] = positions[k / 3][k % 3] + factor * root[k] * move[k];
    force_at(moved, force);
  };
  const auto apply = [&](std::span<const double> in, std::span<double> out) {
    double most = 0.0;
    for (std::size_t k = 0; k < root.size(); ++k) most = std::max(most, std::abs(root[k] * in[k]));
    const double factor = most > 0.0 ? displacement / most : 0.0;
    force_after(factor, in, ahead);
    force_after(-factor, in, behind);
    for (std::size_t k = 0; k < root.size(); ++k)
      out[k] = most > 0.0 ? root[k] * (behind[k / 3][k % 3] - ahead[k / 3][k % 3]) / (2.0 * factor) : 0.0;
  };
  return std::sqrt(std::max(0.0, largest_ritz_value(root.size(), 64, apply)));
}

}  // namespace drogue::fabric
