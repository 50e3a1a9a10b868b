#include "miniapps/parachute/flags/flag.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernels/fabric/elastic/lumped_mass.hpp"
#include "kernels/mesh/mesh.hpp"

namespace drogue::parachute_app {
namespace {

constexpr std::uint8_t pin_z = 4, pin_all = 7;

/// Rectangle of rows of cells along x from the leading edge. The diagonals are mirror images about the
/// middle.
mesh::Mesh rectangle_of(const Flag& flag) {
  mesh::Mesh rectangle;
  const int n = static_cast<int>(flag.divisions()), across = static_cast<int>(flag.divisions_across());
  const auto [low, high] = flag.has_width() ? std::array<double, 2>{flag.middle - 0.5 * *flag.width,
                                                                    flag.middle + 0.5 * *flag.width}
                                            : flag.span;
  for (int i = 0; i <= n; ++i)
    for (int k = 0; k <= across; ++k)
      rectangle.rest.push_back({flag.leading_edge[0] + flag.length * i / n, flag.leading_edge[1],
                                k == across ? high : low + (high - low) * k / across});
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < across; ++k) {
      const int a = (across + 1) * i + k, b = a + 1, c = a + across + 1, d = c + 1;
      if (2 * k < across) {
        rectangle.triangles.push_back({a, d, c});
        rectangle.triangles.push_back({a, b, d});
      } else {
        rectangle.triangles.push_back({a, b, c});
        rectangle.triangles.push_back({b, d, c});
      }
    }
  return rectangle;
}

/// Least number of equal parts of `length` that are at most `longest` but for rounding.
double parts_of(double length, double longest) {
  return std::max(1.0, std::ceil(length / longest * (1.0 - 1e-9)));
}

}  // namespace

double Flag::divisions() const { return parts_of(length, edge_length); }

double Flag::divisions_across() const {
  return has_width() ? 2.0 * parts_of(0.5 * *width, edge_length) : 1.0;
}

std::vector<FlagRows> append_flags(const std::vector<Flag>& flags, fabric::Parameters& sheets,
                                   std::vector<fabric::Vector>& positions) {
  std::vector<FlagRows> rows;
  for (const Flag& flag : flags) {
    const mesh::Mesh rectangle = rectangle_of(flag);
    const auto across = static_cast<std::size_t>(flag.divisions_across());
    const std::vector<double> mass =
        fabric::lumped_masses(rectangle, flag.area_density, 0.0, fabric::Lumping::area);
    const std::size_t begin = sheets.mesh.rest.size();
    const int first = static_cast<int>(begin);
    const double angle = flag.angle * std::numbers::pi / 180.0;
    for (std::size_t i = 0; i < rectangle.rest.size(); ++i) {
      const fabric::Vector& rest = rectangle.rest[i];
      const double along = rest[0] - flag.leading_edge[0];
      sheets.mesh.rest.push_back(rest);
      sheets.mass.push_back(mass[i]);
      sheets.pinned.push_back(i <= across ? pin_all : flag.has_width() ? std::uint8_t{0} : pin_z);
      positions.push_back({flag.leading_edge[0] + along * std::cos(angle),
                           flag.leading_edge[1] + along * std::sin(angle), rest[2]});
    }
    for (const auto& [a, b, c] : rectangle.triangles)
      sheets.mesh.triangles.push_back({first + a, first + b, first + c});
    const std::size_t end = sheets.mesh.rest.size();
    rows.push_back({begin, end, {end - 1 - (across + 1) / 2, end - 1 - across / 2}});
  }
  if (flags.empty()) return rows;
  sheets.material.bending_stiffness = flags.front().bending_stiffness;
  sheets.material.membrane_modulus = flags.front().membrane_modulus;
  sheets.material.poisson = 0.0;  // no strain along z, which does not stiffen the strip
  return rows;
}

}  // namespace drogue::parachute_app
