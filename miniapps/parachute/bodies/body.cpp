#include "miniapps/parachute/bodies/body.hpp"

#include <algorithm>
#include <cmath>

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
    const auto [nx, ny] = body.edges();
    const int start = static_cast<int>(sheets.mesh.rest.size());
    for (int j = 0; j <= ny; ++j)
      for (int i = 0; i <= nx; ++i) {
        fabric::Vector x = body.centre;
        x[first] += (static_cast<double>(i) / nx - 0.5) * body.lengths[0];
        x[second] += (static_cast<double>(j) / ny - 0.5) * body.lengths[1];
        sheets.mesh.rest.push_back(x);
      }
    const bool turns = body.normal == 1;  // z, x, y and x, y, z are right-handed, x, z, y is not
    const auto add = [&](int a, int b, int c) {
      sheets.mesh.triangles.push_back(turns ? std::array{a, c, b} : std::array{a, b, c});
    };
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) {
        const int a = start + j * (nx + 1) + i, b = a + 1, c = a + nx + 1, d = c + 1;
        // Alternating diagonals: the areas of vertices vary within one cell alone.
        if ((i + j) % 2 == 0) {
          add(a, b, d), add(a, d, c);
        } else {
          add(a, b, c), add(b, d, c);
        }
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
