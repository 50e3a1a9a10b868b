#include "miniapps/parachute/flags/flag.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernels/fabric/elastic/lumped_mass.hpp"
#include "kernels/mesh/mesh.hpp"

namespace drogue::parachute_app {
namespace {

constexpr std::uint8_t pin_z = 4, pin_all = 7;

/// Strip of one row of squares, each cut along the same diagonal, along x from the leading edge.
mesh::Mesh strip_of(const Flag& flag) {
  mesh::Mesh strip;
  const int n = static_cast<int>(flag.divisions());
  for (int i = 0; i <= n; ++i)
    for (const double z : flag.span)
      strip.rest.push_back({flag.leading_edge[0] + flag.length * i / n, flag.leading_edge[1], z});
  for (int i = 0; i < n; ++i) {
    const int a = 2 * i;
    strip.triangles.push_back({a, a + 3, a + 2});
    strip.triangles.push_back({a, a + 1, a + 3});
  }
  return strip;
}

}  // namespace

double Flag::divisions() const { return std::max(1.0, std::ceil(length / edge_length * (1.0 - 1e-9))); }

std::vector<FlagRows> append_flags(const std::vector<Flag>& flags, fabric::Parameters& sheets,
                                   std::vector<fabric::Vector>& positions) {
  std::vector<FlagRows> rows;
  for (const Flag& flag : flags) {
    const mesh::Mesh strip = strip_of(flag);
    const std::vector<double> mass =
        fabric::lumped_masses(strip, flag.area_density, 0.0, fabric::Lumping::area);
    const std::size_t begin = sheets.mesh.rest.size();
    const int first = static_cast<int>(begin);
    const double angle = flag.angle * std::numbers::pi / 180.0;
    for (std::size_t i = 0; i < strip.rest.size(); ++i) {
      const fabric::Vector& rest = strip.rest[i];
      const double along = rest[0] - flag.leading_edge[0];
      sheets.mesh.rest.push_back(rest);
      sheets.mass.push_back(mass[i]);
      sheets.pinned.push_back(i < 2 ? pin_all : pin_z);
      positions.push_back({flag.leading_edge[0] + along * std::cos(angle),
                           flag.leading_edge[1] + along * std::sin(angle), rest[2]});
    }
    for (const auto& [a, b, c] : strip.triangles)
      sheets.mesh.triangles.push_back({first + a, first + b, first + c});
    rows.push_back({begin, sheets.mesh.rest.size()});
  }
  if (flags.empty()) return rows;
  sheets.material.bending_stiffness = flags.front().bending_stiffness;
  sheets.material.membrane_modulus = flags.front().membrane_modulus;
  sheets.material.poisson = 0.0;  // no strain along z, which does not stiffen the strip
  return rows;
}

}  // namespace drogue::parachute_app
