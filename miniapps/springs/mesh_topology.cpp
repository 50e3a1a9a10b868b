#include "miniapps/springs/mesh_topology.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "kernels/fabric/edges.hpp"

namespace drogue::springs_app {
namespace {

using fabric::Mesh;
using fabric::Vector;

const Vector& at(const std::vector<Vector>& points, int i) { return points[static_cast<std::size_t>(i)]; }

Vector difference(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

double length(const Vector& a) { return std::hypot(a[0], a[1], a[2]); }

/// Neighbours of every vertex, ascending: those of vertex i lie between first[i] and first[i + 1].
struct Adjacency {
  std::vector<std::size_t> first;
  std::vector<int> neighbour;

  [[nodiscard]] int degree(int i) const {
    const auto k = static_cast<std::size_t>(i);
    return static_cast<int>(first[k + 1] - first[k]);
  }
};

Adjacency adjacency_of(const Mesh& mesh) {
  const auto edges = edges_of(mesh);
  Adjacency result;
  result.first.assign(mesh.rest.size() + 1, 0);
  for (const auto& edge : edges)
    for (const int i : edge) ++result.first[static_cast<std::size_t>(i) + 1];
  for (std::size_t i = 0; i < mesh.rest.size(); ++i) result.first[i + 1] += result.first[i];
  result.neighbour.resize(result.first.back());
  std::vector<std::size_t> next(result.first.begin(), result.first.end() - 1);
  for (const auto& [i, j] : edges) {
    result.neighbour[next[static_cast<std::size_t>(i)]++] = j;
    result.neighbour[next[static_cast<std::size_t>(j)]++] = i;
  }
  return result;
}

/// Smallest, largest and mean of what it has seen.
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

}  // namespace

Vector double_area(const std::vector<Vector>& points, const std::array<int, 3>& triangle) {
  const Vector u = difference(at(points, triangle[1]), at(points, triangle[0])),
               v = difference(at(points, triangle[2]), at(points, triangle[0]));
  return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
}

bool is_flat(const Mesh& mesh) {
  const auto unit_normal = [&](const std::array<int, 3>& triangle) {
    Vector normal = double_area(mesh.rest, triangle);
    const double size = length(normal);
    for (double& value : normal) value /= size;
    return normal;
  };
  if (mesh.triangles.empty()) return true;
  const Vector first = unit_normal(mesh.triangles.front());
  return std::ranges::all_of(mesh.triangles, [&](const std::array<int, 3>& triangle) {
    const Vector normal = unit_normal(triangle);
    const double cosine = first[0] * normal[0] + first[1] * normal[1] + first[2] * normal[2];
    return std::abs(cosine) > 1.0 - 1e-13;
  });
}

std::optional<std::array<int, 2>> opposed_triangles(const Mesh& mesh) {
  // Triangles that agree run through their edge in opposite directions.
  std::vector<std::array<int, 3>> directed;
  for (std::size_t k = 0; k < mesh.triangles.size(); ++k)
    for (std::size_t e = 0; e < 3; ++e)
      directed.push_back({mesh.triangles[k][e], mesh.triangles[k][(e + 1) % 3], static_cast<int>(k)});
  std::ranges::sort(directed);
  for (std::size_t k = 1; k < directed.size(); ++k)
    if (directed[k][0] == directed[k - 1][0] && directed[k][1] == directed[k - 1][1])
      return std::array{directed[k - 1][2], directed[k][2]};
  return std::nullopt;
}

std::vector<int> local_order(const Mesh& mesh) {
  const Adjacency adjacency = adjacency_of(mesh);
  const auto fewer = [&](int i, int j) {
    return std::pair(adjacency.degree(i), i) < std::pair(adjacency.degree(j), j);
  };
  std::vector<int> starts(mesh.rest.size());
  for (std::size_t i = 0; i < starts.size(); ++i) starts[i] = static_cast<int>(i);
  std::ranges::sort(starts, fewer);
  std::vector<char> seen(starts.size(), 0);
  std::vector<int> order, found;
  for (const int start : starts) {
    if (seen[static_cast<std::size_t>(start)] != 0) continue;
    seen[static_cast<std::size_t>(start)] = 1;
    order.push_back(start);
    for (std::size_t next = order.size() - 1; next < order.size(); ++next) {
      const auto i = static_cast<std::size_t>(order[next]);
      found.clear();
      for (std::size_t k = adjacency.first[i]; k < adjacency.first[i + 1]; ++k) {
        const int j = adjacency.neighbour[k];
        if (seen[static_cast<std::size_t>(j)] != 0) continue;
        seen[static_cast<std::size_t>(j)] = 1;
        found.push_back(j);
      }
      std::ranges::sort(found, fewer);
      order.insert(order.end(), found.begin(), found.end());
    }
  }
  std::ranges::reverse(order);
  return order;
}

Mesh renumbered(const Mesh& mesh, const std::vector<int>& order) {
  std::vector<int> place(order.size());
  Mesh result;
  for (std::size_t k = 0; k < order.size(); ++k) {
    place[static_cast<std::size_t>(order[k])] = static_cast<int>(k);
    result.rest.push_back(at(mesh.rest, order[k]));
  }
  result.triangles = mesh.triangles;
  result.lines = mesh.lines;
  result.line_stiffness = mesh.line_stiffness;
  result.line_density = mesh.line_density;
  for (auto& triangle : result.triangles)
    for (int& i : triangle) i = place[static_cast<std::size_t>(i)];
  for (auto& line : result.lines)
    for (int& i : line) i = place[static_cast<std::size_t>(i)];
  return result;
}

std::string quality_report(const Mesh& mesh) {
  std::string text = "mesh: " + std::to_string(mesh.rest.size()) + " vertices, " +
                     std::to_string(mesh.triangles.size()) + " triangles, " +
                     std::to_string(mesh.lines.size()) + " lines\n";
  Range lengths, areas, angles;
  for (const auto& [i, j] : edges_of(mesh))
    lengths.add(length(difference(at(mesh.rest, i), at(mesh.rest, j))));
  if (lengths.count > 0) text += lengths.text("edge length", "m");
  for (const auto& t : mesh.triangles) {
    const double twice = length(double_area(mesh.rest, t));
    areas.add(0.5 * twice);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector u = difference(at(mesh.rest, t[(k + 1) % 3]), at(mesh.rest, t[k])),
                   v = difference(at(mesh.rest, t[(k + 2) % 3]), at(mesh.rest, t[k]));
      const double along = u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
      angles.add(std::atan2(twice, along) * 180.0 / std::numbers::pi);
    }
  }
  if (areas.count > 0) text += areas.text("area", "m^2") + angles.text("angle", "degrees");
  return text;
}

}  // namespace drogue::springs_app
