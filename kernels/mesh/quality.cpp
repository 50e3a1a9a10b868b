#include "kernels/mesh/quality.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "kernels/mesh/edges.hpp"
#include "kernels/mesh/orientation.hpp"
#include "kernels/mesh/topology.hpp"

namespace drogue::mesh {
namespace {

const Vector& vertex(const std::vector<Vector>& points, int i) { return points[static_cast<std::size_t>(i)]; }

Vector between(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

double euclidean(const Vector& a) { return std::hypot(a[0], a[1], a[2]); }

/// Smallest value, largest value and mean of a sample.
struct Range {
  double low = INFINITY, high = -INFINITY, sum = 0.0;
  std::size_t count = 0;

  void add(double value) {
    low = std::min(low, value), high = std::max(high, value);
    sum += value;
    ++count;
  }
  [[nodiscard]] std::string text(const std::string& name, const std::string& unit) const {
    char line[160];
    std::snprintf(line, sizeof line, "%-12s %.6g .. %.6g, mean %.6g %s\n", name.c_str(), low, high,
                  sum / static_cast<double>(count), unit.c_str());
    return line;
  }
};

/// Parts of the surface and their sides.
std::string surface_text(const Mesh& mesh) {
  const Orientation sides = orientation_of(mesh);
  std::size_t closed = 0, inwards = 0, free_edges = 0;
  for (const SurfacePart& part : sides.parts) {
    free_edges += part.free_edges;
    if (part.free_edges == 0) ++closed;
    if (part.volume < 0.0) ++inwards;
  }
  const auto count = [](std::size_t n, const std::string& what) {
    return std::to_string(n) + " " + what + (n == 1 ? "" : "s");
  };
  std::string text = "surface      " + count(sides.parts.size(), "part") + ", " + std::to_string(closed) +
                     " closed, " + count(free_edges, "free edge");
  if (inwards > 0) text += ", normals of " + std::to_string(inwards) + " closed inwards";
  if (sides.one_sided) return text + ", with one side\n";
  if (const std::size_t turns = sides.turns(); turns > 0)
    text += ", " + count(turns, "triangle") + " turned against the others";
  return text + "\n";
}

}  // namespace

std::string quality_report(const Mesh& mesh) {
  std::string text = "mesh: " + std::to_string(mesh.rest.size()) + " vertices, " +
                     std::to_string(mesh.triangles.size()) + " triangles, " +
                     std::to_string(mesh.lines.size()) + " lines\n";
  Range lengths, areas, angles;
  for (const auto& [i, j] : edges_of(mesh))
    lengths.add(euclidean(between(vertex(mesh.rest, i), vertex(mesh.rest, j))));
  if (lengths.count > 0) text += lengths.text("edge length", "m");
  for (const auto& t : mesh.triangles) {
    const double twice = euclidean(doubled_area(mesh.rest, t));
    areas.add(0.5 * twice);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector u = between(vertex(mesh.rest, t[(k + 1) % 3]), vertex(mesh.rest, t[k])),
                   v = between(vertex(mesh.rest, t[(k + 2) % 3]), vertex(mesh.rest, t[k]));
      const double along = u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
      angles.add(std::atan2(twice, along) * 180.0 / std::numbers::pi);
    }
  }
  if (areas.count > 0)
    text += surface_text(mesh) + areas.text("area", "m^2") + angles.text("angle", "degrees");
  return text;
}

}  // namespace drogue::mesh
