#include "kernels/fabric/elastic/lumped_mass.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>

#include "kernels/mesh/edges.hpp"

namespace drogue::fabric {

namespace {

Vector vector_between(const Vector& from, const Vector& to) {
  return {to[0] - from[0], to[1] - from[1], to[2] - from[2]};
}

double spanned_area(const Vector& u, const Vector& v) {
  return 0.5 * std::hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]);
}

}  // namespace

std::vector<double> lumped_masses(const Mesh& mesh, double area_density, double line_density,
                                  Lumping lumping) {
  const auto require = [](bool holds, const char* what) {
    if (!holds) throw std::invalid_argument(std::string("fabric masses: ") + what);
  };
  const auto is_density = [](double density) { return density >= 0.0 && std::isfinite(density); };
  require(is_density(area_density) && is_density(line_density) &&
              std::ranges::all_of(mesh.line_density, is_density),
          "a density must be finite and not negative");
  require(mesh.line_density.empty() || mesh.line_density.size() == mesh.lines.size(),
          "there must be a density for every line, or for none");
  std::vector<double> mass(mesh.rest.size(), 0.0);
  const auto position = [&](int i) { return mesh.rest[static_cast<std::size_t>(i)]; };
  const auto share = [&](const auto& vertices, double whole) {
    for (const int i : vertices)
      mass[static_cast<std::size_t>(i)] += whole / static_cast<double>(vertices.size());
  };
  for (const auto& t : mesh.triangles)
    share(t, area_density * spanned_area(vector_between(position(t[0]), position(t[1])),
                                         vector_between(position(t[0]), position(t[2]))));
  for (std::size_t k = 0; k < mesh.lines.size(); ++k) {
    const auto& line = mesh.lines[k];
    share(line, (mesh.line_density.empty() ? line_density : mesh.line_density[k]) * rest_length(mesh, k));
  }
  if (lumping == Lumping::equal) {
    const double whole = std::accumulate(mass.begin(), mass.end(), 0.0);
    mass.assign(mass.size(), whole / static_cast<double>(mass.size()));
  }
  return mass;
}

}  // namespace drogue::fabric
