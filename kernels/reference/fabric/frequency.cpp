#include "kernels/reference/fabric/frequency.hpp"

#include <cmath>
#include <random>

namespace drogue::reference {

double largest_frequency(const fabric::Material& material, const Mesh& mesh, const std::vector<double>& mass,
                         const std::vector<std::uint8_t>& pinned, const std::vector<Vector>& now) {
  constexpr int iterations = 400;
  const std::size_t n = now.size();
  const auto is_free = [&](std::size_t i, std::size_t axis) {
    return pinned.empty() || (pinned[i] >> axis & 1U) == 0U;
  };
  std::mt19937 engine(1);
  std::vector<Vector> u(n);  // eigenvector estimate of the symmetric matrix M^-1/2 K M^-1/2
  for (Vector& x : u)
    for (double& value : x) value = static_cast<double>(engine()) / 4294967296.0 - 0.5;
  double squared = 0.0;
  for (int k = 0; k < iterations; ++k) {
    double norm = 0.0;
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!is_free(i, axis)) u[i][axis] = 0.0;
        norm += u[i][axis] * u[i][axis];
      }
    norm = std::sqrt(norm);
    const double step = 1e-5;
    std::vector<Vector> ahead = now, behind = now;
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        u[i][axis] /= norm;
        const double moved = step * u[i][axis] * std::sqrt(mass[0] / mass[i]);
        ahead[i][axis] += moved, behind[i][axis] -= moved;
      }
    const std::vector<Vector> f = forces(material, mesh, ahead), g = forces(material, mesh, behind);
    double rayleigh = 0.0;
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double product =
            is_free(i, axis) ? (g[i][axis] - f[i][axis]) / (2.0 * step) / std::sqrt(mass[0] * mass[i]) : 0.0;
        rayleigh += product * u[i][axis];
        u[i][axis] = product;
      }
    squared = rayleigh;
  }
  return std::sqrt(squared);
}

}  // namespace drogue::reference
