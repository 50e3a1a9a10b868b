#include "miniapps/springs/verify/probe.hpp"

#include <cmath>

namespace drogue::springs_app {

int nearest_vertex(const fabric::Mesh& mesh, const std::vector<double>& point) {
  int nearest = 0;
  double least = INFINITY;
  for (std::size_t i = 0; i < mesh.rest.size(); ++i) {
    const fabric::Vector& x = mesh.rest[i];
    const double distance = std::hypot(x[0] - point[0], x[1] - point[1], x[2] - point[2]);
    if (distance >= least) continue;
    least = distance;
    nearest = static_cast<int>(i);
  }
  return nearest;
}

}  // namespace drogue::springs_app
