#include "kernels/mesh/round_surfaces.hpp"

#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "kernels/mesh/vectors.hpp"

namespace drogue::mesh {
namespace {

using Corners = std::array<int, 3>;

/// Icosahedron with edges of length 2.
Mesh icosahedron() {
  Mesh mesh;
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const double first : {-1.0, 1.0})
      for (const double second : {-std::numbers::phi, std::numbers::phi}) {
        Vector corner{};
        corner[(axis + 1) % 3] = first, corner[(axis + 2) % 3] = second;
        mesh.rest.push_back(corner);
      }
  const auto corner = [&](int i) -> const Vector& { return mesh.rest[static_cast<std::size_t>(i)]; };
  const auto is_edge = [&](int i, int j) {
    double square = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis) square += std::pow(corner(i)[axis] - corner(j)[axis], 2);
    return square < 5.0;
  };
  for (int a = 0; a < 12; ++a)
    for (int b = a + 1; b < 12; ++b)
      for (int c = b + 1; c < 12; ++c)
        if (is_edge(a, b) && is_edge(b, c) && is_edge(c, a)) {
          const bool is_outward = dot(cross(corner(a), corner(b)), corner(c)) > 0.0;
          mesh.triangles.push_back(is_outward ? Corners{a, b, c} : Corners{a, c, b});
        }
  return mesh;
}

/// Vertices on a sphere, found again by the corners of the icosahedron and their weights.
class SphereVertices {
 public:
  SphereVertices(const Mesh& corners, double radius, Mesh& mesh)
      : _corners(corners), _radius(radius), _mesh(mesh) {}

  /// Vertex with the sum of weighted corners as its direction. Weights of zero do not count.
  int at(const Corners& corners, const Corners& weights) {
    std::map<int, int> key;
    for (std::size_t k = 0; k < 3; ++k)
      if (weights[k] > 0) key[corners[k]] = weights[k];
    const auto [entry, is_new] = _numbers.try_emplace(key, static_cast<int>(_mesh.rest.size()));
    if (is_new) {
      Vector sum{};
      for (const auto& [corner, weight] : key)
        for (std::size_t axis = 0; axis < 3; ++axis)
          sum[axis] += weight * _corners.rest[static_cast<std::size_t>(corner)][axis];
      const double scale = _radius / std::sqrt(dot(sum, sum));
      for (double& x : sum) x *= scale;
      _mesh.rest.push_back(sum);
    }
    return entry->second;
  }

 private:
  const Mesh& _corners;
  double _radius;
  Mesh& _mesh;
  std::map<std::map<int, int>, int> _numbers;
};

/// Adds a disk at height z whose last ring is given, with normals along +z or -z.
void add_end(Mesh& mesh, double radius, int rings, double z, int rim, bool is_upper) {
  const Mesh end = disk(radius, rings);
  const int inner = static_cast<int>(end.rest.size()) - 6 * rings, first = static_cast<int>(mesh.rest.size());
  for (int i = 0; i < inner; ++i) {
    const Vector& x = end.rest[static_cast<std::size_t>(i)];
    mesh.rest.push_back({x[0], x[1], z});
  }
  for (Corners corners : end.triangles) {
    if (!is_upper) std::swap(corners[1], corners[2]);
    for (int& corner : corners) corner += corner < inner ? first : rim - inner;
    mesh.triangles.push_back(corners);
  }
}

}  // namespace

Mesh disk(double radius, int rings) {
  Mesh mesh;
  mesh.rest.push_back({0.0, 0.0, 0.0});
  for (int k = 1; k <= rings; ++k)
    for (int j = 0; j < 6 * k; ++j) {
      const double distance = radius * k / rings, angle = std::numbers::pi * j / (3.0 * k);
      mesh.rest.push_back({distance * std::cos(angle), distance * std::sin(angle), 0.0});
    }
  const auto vertex = [](int ring, int j) {
    return ring == 0 ? 0 : 1 + 3 * ring * (ring - 1) + j % (6 * ring);
  };
  for (int k = 1; k <= rings; ++k)
    for (int sector = 0; sector < 6; ++sector)
      for (int j = 0; j < k; ++j) {
        const int outer = sector * k + j, inner = sector * (k - 1) + j;
        mesh.triangles.push_back({vertex(k - 1, inner), vertex(k, outer), vertex(k, outer + 1)});
        if (j + 1 < k)
          mesh.triangles.push_back({vertex(k - 1, inner), vertex(k, outer + 1), vertex(k - 1, inner + 1)});
      }
  return mesh;
}

Mesh sphere(double radius, int divisions) {
  const Mesh solid = icosahedron();
  Mesh mesh;
  SphereVertices vertices(solid, radius, mesh);
  for (const Corners& face : solid.triangles)
    for (int i = 0; i < divisions; ++i)
      for (int j = 0; i + j < divisions; ++j) {
        // Weights of the second and the third corner.
        const auto at = [&](int second, int third) {
          return vertices.at(face, {divisions - second - third, second, third});
        };
        mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
        if (i + j + 1 < divisions) mesh.triangles.push_back({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
      }
  return mesh;
}

Mesh hemisphere(double radius, int rings) {
  Mesh mesh = disk(1.0, rings);
  for (Vector& x : mesh.rest) {
    const double distance = std::hypot(x[0], x[1]), angle = 0.5 * std::numbers::pi * distance;
    const double scale = distance > 0.0 ? radius * std::sin(angle) / distance : 0.0;
    x = {scale * x[0], scale * x[1], radius * std::cos(angle)};
  }
  return mesh;
}

Mesh tube(double radius, double length, int columns, int rows) {
  Mesh mesh;
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / columns;
      mesh.rest.push_back({radius * std::cos(angle), radius * std::sin(angle),
                           length * (static_cast<double>(j) / rows - 0.5)});
    }
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const int next = (i + 1) % columns, a = j * columns + i, b = j * columns + next;
      mesh.triangles.push_back({a, b, b + columns});
      mesh.triangles.push_back({a, b + columns, a + columns});
    }
  return mesh;
}

Mesh closed_cylinder(double radius, double length, int rings, int rows) {
  const int columns = 6 * rings;
  Mesh mesh = tube(radius, length, columns, rows);
  add_end(mesh, radius, rings, -0.5 * length, 0, false);
  add_end(mesh, radius, rings, 0.5 * length, rows * columns, true);
  return mesh;
}

}  // namespace drogue::mesh
