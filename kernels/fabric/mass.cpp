#include "kernels/fabric/mass.hpp"

#include <cmath>
#include <numeric>
#include <stdexcept>

namespace drogue::fabric {

namespace {

Vector leads(const Vector& from, const Vector& to) {
  return {to[0] - from[0], to[1] - from[1], to[2] - from[2]};
}

double spanned_area(const Vector& u, const Vector& v) {
  return 0.5 * std::hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]);
}

}  // namespace

std::vector<double> lumped_masses(const Mesh& mesh, double area_density, double line_density,
                                  Lumping lumping) {
  for (const double density : {area_density, line_density})
    if (!(density >= 0.0 && std::isfinite(density)))
      throw std::invalid_argument("fabric masses: a density must be finite and not negative");
  std::vector<double> mass(mesh.rest.size(), 0.0);
  const auto place = [&](int i) { return mesh.rest[static_cast<std::size_t>(i)]; };
  const auto share = [&](const auto& vertices, double whole) {
    for (const int i : vertices)
      mass[static_cast<std::size_t>(i)] += whole / static_cast<double>(vertices.size());
  };
  for (const auto& t : mesh.triangles)
    share(t, area_density * spanned_area(leads(place(t[0]), place(t[1])), leads(place(t[0]), place(t[2]))));
  for (const auto& line : mesh.lines) {
    const Vector along = leads(place(line[0]), place(line[1]));
    share(line, line_density * std::hypot(along[0], along[1], along[2]));
  }
  if (lumping == Lumping::equal) {
    const double whole = std::accumulate(mass.begin(), mass.end(), 0.0);
    mass.assign(mass.size(), whole / static_cast<double>(mass.size()));
  }
  return mass;
}

}  // namespace drogue::fabric
