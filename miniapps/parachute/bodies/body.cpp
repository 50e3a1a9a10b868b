#include "miniapps/parachute/bodies/body.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kernels/mesh/generators.hpp"

namespace drogue::parachute_app {

std::array<std::size_t, 2> Body::axes() const {
  if (normal == 0) return {1, 2};
  return normal == 1 ? std::array<std::size_t, 2>{0, 2} : std::array<std::size_t, 2>{0, 1};
}

std::array<int, 2> Body::edges() const {
  std::array<int, 2> count{};
  for (std::size_t k = 0; k < 2; ++k)
    count[k] = std::max(1, static_cast<int>(std::ceil(lengths[k] / edge_length * (1.0 - 1e-9))));
  return count;
}

std::size_t vertices_of(const std::vector<Body>& bodies) {
  std::size_t sum = 0;
  for (const Body& body : bodies) sum += body.vertices();
  return sum;
}

fabric::Parameters make_sheets(const std::vector<Body>& bodies) {
  fabric::Parameters sheets;
  for (const Body& body : bodies) {
    const auto [first, second] = body.axes();
    const auto [columns, rows] = body.edges();
    const int start = static_cast<int>(sheets.mesh.rest.size());
    const mesh::Mesh plate = mesh::rectangle(body.lengths[0], body.lengths[1], columns, rows);
    for (const fabric::Vector& in_plane : plate.rest) {
      fabric::Vector x = body.centre;
      x[first] += in_plane[0] - 0.5 * body.lengths[0];
      x[second] += in_plane[1] - 0.5 * body.lengths[1];
      sheets.mesh.rest.push_back(x);
    }
    for (std::array<int, 3> corners : plate.triangles) {
      // The axes x, z are in the order of a left-handed system with y.
      if (body.normal == 1) std::swap(corners[1], corners[2]);
      for (int& corner : corners) corner += start;
      sheets.mesh.triangles.push_back(corners);
    }
  }
  sheets.mass.assign(sheets.mesh.rest.size(), 1.0);  // without effect on pinned vertices
  sheets.pinned.assign(sheets.mesh.rest.size(), 7);
  return sheets;
}

coupling::PorousLaw law_of(const Porosity& porosity) {
  return {porosity.alpha, porosity.beta, porosity.law == PorosityLaw::none};
}

}  // namespace drogue::parachute_app
