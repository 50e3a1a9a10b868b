#include "miniapps/springs/verify/samples.hpp"

#include <cmath>

#include "kernels/mesh/topology.hpp"

namespace drogue::springs_app {

double total_length(const fabric::Mesh& mesh, const std::vector<fabric::Vector>& x) {
  double sum = 0.0;
  for (const auto& [i, j] : mesh.lines) {
    const fabric::Vector &a = x[static_cast<std::size_t>(i)], &b = x[static_cast<std::size_t>(j)];
    sum += std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
  }
  return sum;
}

double total_area(const fabric::Mesh& mesh, const std::vector<fabric::Vector>& x) {
  double sum = 0.0;
  for (const auto& triangle : mesh.triangles) {
    const fabric::Vector twice = mesh::doubled_area(x, triangle);
    sum += 0.5 * std::hypot(twice[0], twice[1], twice[2]);
  }
  return sum;
}

double mean_difference(const std::vector<double>& time, const std::vector<double>& a,
                       const std::vector<double>& b) {
  const auto apart = [&](std::size_t k) { return std::abs(a[k] - b[k]); };
  if (time.size() == 1) return apart(0);
  double sum = 0.0;
  for (std::size_t k = 1; k < time.size(); ++k)
    sum += 0.5 * (apart(k - 1) + apart(k)) * (time[k] - time[k - 1]);
  return sum / (time.back() - time.front());
}

}  // namespace drogue::springs_app
